/// \file
/// How many pixels libapriltag has to be given, before its version 3.1.5 (0.10 in Debian 11).
///
/// Its gradient_clusters() (apriltag_quad_thresh.c) shares the rows of the decimated frame among up
/// to 10 tasks for each thread. Each task has a table of
///
///     2 (0.2 pixels / tasks) / 2048,   each division rounded down,
///
/// pointers to memory, and uses the first of them, whether or not there is one: with fewer than
/// 5120 pixels for each task it writes beyond its stack or heap. Version 3.1.5 made the table
/// larger by one (commit a0b37ad, "avoid memory corruption when nclustermap < mem_chunk_size").
#pragma once

#include <opencv2/core.hpp>

namespace fast_edi {

/// Pixels of the decimated frame that a thread needs.
constexpr int kPixelsPerThread = 10 * 5120;

/// The frame, if a thread finds enough pixels in it; otherwise a copy with its lowest row repeated
/// as often as needed, in which the same tags are in the same places.
/// \param image CV_8UC1, at least 16 \p decimate pixels wide
/// \param decimate factor by which libapriltag shrinks the frame, at least 1
cv::Mat withEnoughRows(const cv::Mat& image, double decimate);

/// As many of the \p wanted threads as have enough pixels, at least one.
int threadsWithEnoughPixels(cv::Size size, double decimate, int wanted);

}  // namespace fast_edi

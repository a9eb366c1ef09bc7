/// \file
/// All that `deblur_bag` writes of one recording: a bag, a film, folders of pictures, what was
/// learned.
#pragma once

#include <optional>
#include <string>

#include "fast_edi/bags/bag_deblurrer.hpp"
#include "fast_edi/bags/bag_pipeline.hpp"
#include "fast_edi/bags/bag_writer.hpp"
#include "fast_edi/config/learned_file.hpp"
#include "film/film_writer.hpp"
#include "film/frame_folder.hpp"
#include "tools/deblur_bag/deblur_bag_arguments.hpp"

namespace fast_edi::deblur_bag {

class DeblurOutputs {
 public:
  /// Makes those that were asked for; everything is looked at before the first message is read.
  /// \param arguments must outlive this object
  /// \param compression of the bag
  /// \throws std::runtime_error for one that cannot or may not be written
  DeblurOutputs(const Arguments& arguments, const std::string& compression);

  /// Null: no bag is written.
  BagWriter* bag() { return bag_ ? &*bag_ : nullptr; }
  bool showsTrust() const { return trust_.has_value(); }

  /// Film and pictures of a frame; the bag is written by BagDeblurrer.
  /// \throws std::runtime_error when they cannot be written
  void add(const BagPipeline::Output& output);
  /// Completes all of them.
  /// \throws std::runtime_error when they cannot be written
  void close(const BagDeblurReport& report);

  /// The names of what was written, on standard output.
  void print() const;
  /// What could not be written as PNG, on standard error.
  /// \return false when there is any
  bool reportLeftOut() const;

 private:
  const Arguments& arguments_;
  std::optional<FilmWriter> film_;
  std::optional<FrameFolder> folder_;
  std::optional<FrameFolder> trust_;
  std::optional<LearnedFile> learned_;
  bool is_learned_written_ = false;
  std::optional<BagWriter> bag_;
};

}  // namespace fast_edi::deblur_bag

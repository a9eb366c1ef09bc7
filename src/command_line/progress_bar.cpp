#include "progress_bar.hpp"

#include <unistd.h>

#include <cmath>
#include <iomanip>
#include <iostream>
#include <utility>

namespace fast_edi {
namespace {

constexpr std::chrono::milliseconds kPeriod(100);
constexpr int kWidth = 40;  ///< characters

}  // namespace

ProgressBar::ProgressBar(std::string label)
    : label_(std::move(label)), terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (drawn_) {
    std::cerr << std::endl;
  }
}

void ProgressBar::update(std::uint64_t done, std::uint64_t total) {
  if (!terminal_ || total == 0) {
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (now < next_draw_ && done < total) {
    return;
  }
  next_draw_ = now + kPeriod;
  draw(static_cast<double>(done) / static_cast<double>(total));
}

void ProgressBar::draw(double fraction) {
  drawn_ = true;
  const int filled = static_cast<int>(std::lround(fraction * kWidth));
  std::cerr << '\r' << label_ << " [" << std::string(static_cast<std::size_t>(filled), '#')
            << std::string(static_cast<std::size_t>(kWidth - filled), '.') << "] " << std::setw(3)
            << std::lround(fraction * 100.0) << " %" << std::flush;
}

}  // namespace fast_edi

#include <algorithm>
#include <cmath>
#include <string>

#include <opencv2/imgproc.hpp>

#include "scenes/texture_brushes.hpp"

namespace fast_edi {
namespace {

constexpr double kInk = 0.06;
constexpr double kLeadingPerHeight = 1.9;  ///< from line to line, in heights of a capital letter

std::string randomLine(RandomEngine& random, int letters) {
  static constexpr char kLetters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIKLMNOPRSTW    ";
  constexpr int kLetterCount = static_cast<int>(sizeof(kLetters)) - 1;
  std::string line;
  for (int i = 0; i < letters; ++i) {
    line += kLetters[uniformInt(random, 0, kLetterCount - 1)];
  }
  return line;
}

/// Fills a box with text. \param height of a capital letter [canvas elements]
void printParagraph(cv::Mat3f& canvas, const cv::Rect& box, double height, RandomEngine& random) {
  constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
  int baseline = 0;
  const cv::Size unit = cv::getTextSize("H", kFont, 1.0, 1, &baseline);
  const double font_scale = height / unit.height;
  const int thickness = std::max(1, static_cast<int>(std::lround(0.15 * height)));
  const int letters = static_cast<int>(box.width / (1.05 * unit.width * font_scale));
  for (double y = box.y + height; y < box.y + box.height; y += kLeadingPerHeight * height) {
    // The last line of a paragraph is shorter.
    const bool last = y + kLeadingPerHeight * height >= box.y + box.height;
    const int length = last ? uniformInt(random, letters / 4, letters) : letters;
    cv::putText(canvas(box), randomLine(random, length), {0, static_cast<int>(y) - box.y}, kFont,
                font_scale, Colour::all(kInk), thickness, cv::LINE_AA);
  }
}

}  // namespace

void drawPage(cv::Mat3f& canvas, double scale, RandomEngine& random) {
  constexpr double kColumnPx = 150.0;
  constexpr double kMarginPx = 14.0;
  constexpr double kBoxSharePercent = 20;
  canvas.setTo(Colour(0.74, 0.77, 0.78));
  for (double x = 0.0; x < canvas.cols; x += kColumnPx * scale) {
    for (double y = 0.0; y < canvas.rows;) {
      const double height_px = uniform(random, 4.0, 9.0);
      const double block_px = uniform(random, 40.0, 110.0);
      const cv::Rect box = cv::Rect(static_cast<int>(x + kMarginPx * scale), static_cast<int>(y),
                                    static_cast<int>((kColumnPx - kMarginPx) * scale),
                                    static_cast<int>(block_px * scale)) &
                           cv::Rect({}, canvas.size());
      if (uniformInt(random, 1, 100) <= kBoxSharePercent) {
        const int line = std::max(1, static_cast<int>(std::lround(1.5 * scale)));
        cv::rectangle(canvas, box, Colour::all(uniform(random, kInk, 0.5)), line);
      } else {
        printParagraph(canvas, box, height_px * scale, random);
      }
      y += (block_px + kMarginPx) * scale;
    }
  }
  shade(fractalNoise(canvas.size(), 120.0 * scale, 30.0 * scale, random), 0.03, canvas);
}

}  // namespace fast_edi

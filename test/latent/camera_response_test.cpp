#include "fast_edi/latent/camera_response.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;

constexpr int kLevels8 = 256;
constexpr int kLevels16 = 65536;

/// A response like a DAVIS346's: linear above, ln(DN + 5) in the toe, compressed near the top.
std::vector<double> sensorLikeTable() {
  std::vector<double> table;
  for (int dn = 0; dn < kLevels8; ++dn) {
    const double compressed = dn <= 240 ? dn : 240 + 2.5 * (dn - 240);
    table.push_back(std::log(compressed + 5.0) - 3.0);
  }
  return table;
}

/// One half so steep and one so flat that a bucket of any inverse table holds many levels.
std::vector<double> unevenTable() {
  std::vector<double> table;
  for (int dn = 0; dn < kLevels8; ++dn) {
    table.push_back(dn < 128 ? 0.2 * dn : 0.2 * 128 + 1e-6 * dn);
  }
  return table;
}

struct NamedResponse {
  std::string name;
  CameraResponse response;
};

std::vector<NamedResponse> responses() {
  return {{"linear", CameraResponse::linear()},
          {"linear with offset", CameraResponse::linear(4.7)},
          {"sensor-like table", CameraResponse::fromTable(sensorLikeTable())},
          {"uneven table", CameraResponse::fromTable(unevenTable())}};
}

constexpr PixelFormat kFormats[] = {PixelFormat::kMono8,        PixelFormat::kBayer8,
                                    PixelFormat::kMono16,       PixelFormat::kColour8,
                                    PixelFormat::kBayer16,      PixelFormat::kColour16,
                                    PixelFormat::kColourAlpha8, PixelFormat::kColourAlpha16};

int levelsOf(PixelFormat format) {
  return bytesPerSample(format) == 2 ? kLevels16 : kLevels8;
}

/// An image that owns its memory, with padding behind each row.
struct Image {
  static constexpr std::size_t kPadding = 5;
  static constexpr std::uint8_t kPaddingByte = 0xa5;

  Image(SensorSize image_size, PixelFormat image_format)
      : size(image_size),
        format(image_format),
        step(static_cast<std::size_t>(image_size.width * bytesPerPixel(image_format)) + kPadding),
        bytes(step * static_cast<std::size_t>(image_size.height), kPaddingByte) {}

  ImageView view() const { return {bytes.data(), size, step, format}; }
  MutableImageView mutableView() { return {bytes.data(), size, step, format}; }
  std::size_t rowBytes() const { return step - kPadding; }

  SensorSize size;
  PixelFormat format;
  std::size_t step;
  std::vector<std::uint8_t> bytes;
};

Image randomImage(SensorSize size, PixelFormat format, unsigned seed) {
  Image image(size, format);
  std::mt19937 random(seed);
  for (int y = 0; y < size.height; ++y) {
    for (std::size_t i = 0; i < image.rowBytes(); ++i) {
      image.mutableView().row(y)[i] = static_cast<std::uint8_t>(random());
    }
  }
  return image;
}

int sampleOf(const Image& image, int pixel, int sample) {
  const std::uint8_t* bytes = image.bytes.data() + pixel * bytesPerPixel(image.format) +
                              sample * bytesPerSample(image.format);
  if (bytesPerSample(image.format) == 1) {
    return bytes[0];
  }
  std::uint16_t value = 0;
  std::memcpy(&value, bytes, sizeof(value));
  return value;
}

/// All levels of one depth in a single row, through one gain. Alpha holds the same levels.
std::vector<int> applyToAllLevels(const CameraResponse& response, PixelFormat format, float gain) {
  const int levels = levelsOf(format);
  Image in({levels, 1}, format);
  for (int level = 0; level < levels; ++level) {
    for (int sample = 0; sample < samplesPerPixel(format); ++sample) {
      const auto value = static_cast<std::uint16_t>(level);
      std::memcpy(in.bytes.data() + level * bytesPerPixel(format) + sample * bytesPerSample(format),
                  &value, static_cast<std::size_t>(bytesPerSample(format)));
    }
  }
  Image out({levels, 1}, format);
  const std::vector<float> gains(static_cast<std::size_t>(levels), gain);
  response.applyGain(in.view(), gains.data(), out.mutableView());
  std::vector<int> result;
  for (int level = 0; level < levels; ++level) {
    result.push_back(sampleOf(out, level, 0));
    for (int channel = 1; channel < channels(format); ++channel) {
      EXPECT_EQ(sampleOf(out, level, channel), result.back());
    }
    if (hasAlpha(format)) {
      EXPECT_EQ(sampleOf(out, level, channels(format)), level) << "alpha";
    }
  }
  return result;
}

/// The level whose exposure, by exposure() alone, is nearest in DN: a bisection over all levels.
double slowInverse(const CameraResponse& response, double exposure) {
  double below = 0.0;
  double above = kLevels8 - 1;
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    const double middle = 0.5 * (below + above);
    (response.exposure(middle) <= exposure ? below : above) = middle;
  }
  return below;
}

TEST(CameraResponse, GainOneReturnsEveryByteOfEveryFormat) {
  const SensorSize size{301, 7};
  const std::vector<float> ones(size.pixelCount(), 1.0F);
  for (const auto& [name, response] : responses()) {
    for (const PixelFormat format : kFormats) {
      const Image in = randomImage(size, format, 1);
      Image out(size, format);
      response.applyGain(in.view(), ones.data(), out.mutableView());
      EXPECT_EQ(in.bytes, out.bytes) << name << ", format " << static_cast<int>(format);
    }
  }
}

TEST(CameraResponse, AgreesWithASlowSearch) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> log_gain(-3.0, 3.0);
  for (const auto& [name, response] : responses()) {
    for (const PixelFormat format : kFormats) {
      const double scale = dnPerDn8(format);
      for (int trial = 0; trial < 5; ++trial) {
        const auto gain = static_cast<float>(std::exp(log_gain(random)));
        const std::vector<int> result = applyToAllLevels(response, format, gain);
        const std::size_t stride = bytesPerSample(format) == 2 ? 101 : 1;
        for (std::size_t level = 0; level < result.size(); level += stride) {
          const double exposure =
              response.exposure(static_cast<double>(level) / scale) * static_cast<double>(gain);
          const double expected = scale * slowInverse(response, exposure);
          // Half a level of rounding; the rest is for floats where the table is nearly flat.
          const double tolerance = name == "uneven table" ? 0.6 * scale : 0.51;
          ASSERT_NEAR(result[level], expected, tolerance)
              << name << ", format " << static_cast<int>(format) << ", level " << level << ", gain "
              << gain;
        }
      }
    }
  }
}

TEST(CameraResponse, GrowsWithTheGainAndWithTheInput) {
  for (const auto& [name, response] : responses()) {
    for (const PixelFormat format : kFormats) {
      std::vector<int> previous;
      for (float gain = 0.2F; gain < 5.0F; gain *= 1.13F) {
        const std::vector<int> result = applyToAllLevels(response, format, gain);
        EXPECT_TRUE(std::is_sorted(result.begin(), result.end())) << name << ", gain " << gain;
        for (std::size_t level = 0; level < previous.size(); ++level) {
          ASSERT_GE(result[level], previous[level]) << name << ", gain " << gain;
        }
        previous = result;
      }
    }
  }
}

TEST(CameraResponse, AGainAndItsInverseLeadBack) {
  for (const auto& [name, response] : responses()) {
    if (name == "uneven table") {
      continue;  // rounding to 8 bits in its steep half loses what the flat half needs
    }
    // Darken by the inverse, brighten again: one level of rounding on the way, times the gain.
    const float gain = 1.25F;
    const std::vector<int> up = applyToAllLevels(response, PixelFormat::kMono8, gain);
    const std::vector<int> down = applyToAllLevels(response, PixelFormat::kMono8, 1.0F / gain);
    for (int level = 0; level < kLevels8; ++level) {
      if (up[static_cast<std::size_t>(level)] < kLevels8 - 1) {
        EXPECT_NEAR(down[static_cast<std::size_t>(up[static_cast<std::size_t>(level)])], level, 1)
            << name;
      }
    }
  }
}

TEST(CameraResponse, ExtremeGainsGiveTheEndsOfTheRange) {
  using Limits = std::numeric_limits<float>;
  for (const auto& [name, response] : responses()) {
    for (const PixelFormat format : kFormats) {
      const int top = levelsOf(format) - 1;
      for (const float tiny : {Limits::min(), Limits::denorm_min(), 1e-30F}) {
        EXPECT_THAT(applyToAllLevels(response, format, tiny), Each(0)) << name << ", gain " << tiny;
      }
      for (const float huge : {Limits::max(), 1e35F}) {
        const std::vector<int> result = applyToAllLevels(response, format, huge);
        // With no offset, DN 0 is no exposure at all, and stays so.
        const bool black_stays = response.isLinear() && response.offsetDn() == 0.0;
        EXPECT_EQ(result.front(), black_stays ? 0 : top) << name;
        EXPECT_THAT(std::vector<int>(result.begin() + 1, result.end()), Each(top)) << name;
      }
    }
  }
}

TEST(CameraResponse, OutOfContractGainsStayInRange) {
  for (const auto& [name, response] : responses()) {
    for (const PixelFormat format : kFormats) {
      for (const float gain : {std::numeric_limits<float>::quiet_NaN(),
                               std::numeric_limits<float>::infinity(), 0.0F, -1.0F}) {
        EXPECT_FALSE(applyToAllLevels(response, format, gain).empty()) << name;
      }
    }
  }
}

TEST(CameraResponse, SaturatedInputIsTakenAsItsLowerBound) {
  const CameraResponse response = CameraResponse::linear();
  EXPECT_EQ(applyToAllLevels(response, PixelFormat::kMono8, 0.5F).back(), 128);
  EXPECT_EQ(applyToAllLevels(response, PixelFormat::kMono8, 1.5F).back(), 255);
  EXPECT_EQ(applyToAllLevels(response, PixelFormat::kMono16, 0.5F).back(), 32768);
  EXPECT_EQ(applyToAllLevels(response, PixelFormat::kMono16, 1.5F).back(), 65535);
}

TEST(CameraResponse, OffsetActsBeforeTheGain) {
  const std::vector<int> result =
      applyToAllLevels(CameraResponse::linear(5.0), PixelFormat::kMono8, 2.0F);
  EXPECT_EQ(result[0], 5);    // 2 * (0 + 5) - 5
  EXPECT_EQ(result[10], 25);  // 2 * (10 + 5) - 5
}

TEST(CameraResponse, EveryPixelHasItsOwnGainAndColoursShareIt) {
  const SensorSize size{300, 2};
  std::vector<float> gain(size.pixelCount());
  for (std::size_t i = 0; i < gain.size(); ++i) {
    gain[i] = 0.5F + static_cast<float>(i) / static_cast<float>(gain.size());
  }
  const Image in = randomImage(size, PixelFormat::kColour8, 3);
  Image out(size, PixelFormat::kColour8);
  CameraResponse::linear().applyGain(in.view(), gain.data(), out.mutableView());
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const float pixel_gain = gain[static_cast<std::size_t>(y * size.width + x)];
      for (int channel = 0; channel < 3; ++channel) {
        const float exact = pixel_gain * static_cast<float>(in.view().row(y)[3 * x + channel]);
        ASSERT_NEAR(out.view().row(y)[3 * x + channel], std::min(exact, 255.0F), 0.51F);
      }
    }
  }
}

TEST(CameraResponse, LeavesRowPaddingAlone) {
  const SensorSize size{33, 3};
  const std::vector<float> gain(size.pixelCount(), 1.7F);
  for (const auto& [name, response] : responses()) {
    for (const PixelFormat format : kFormats) {
      const Image in = randomImage(size, format, 4);
      Image out(size, format);
      response.applyGain(in.view(), gain.data(), out.mutableView());
      for (int y = 0; y < size.height; ++y) {
        const std::uint8_t* end = out.view().row(y) + out.rowBytes();
        EXPECT_THAT(std::vector<std::uint8_t>(end, end + Image::kPadding),
                    Each(Image::kPaddingByte));
      }
    }
  }
}

TEST(CameraResponse, MayWriteOverItsInput) {
  const SensorSize size{123, 4};
  const std::vector<float> gain(size.pixelCount(), 0.6F);
  for (const PixelFormat format : kFormats) {
    Image image = randomImage(size, format, 5);
    Image out(size, format);
    CameraResponse::linear(2.0).applyGain(image.view(), gain.data(), out.mutableView());
    CameraResponse::linear(2.0).applyGain(image.view(), gain.data(), image.mutableView());
    EXPECT_EQ(image.bytes, out.bytes);
  }
}

TEST(CameraResponse, ExposureAndDigitalNumberAreInverse) {
  for (const auto& [name, response] : responses()) {
    for (double dn = 0.0; dn <= 255.0; dn += 0.37) {
      EXPECT_NEAR(response.digitalNumber(response.exposure(dn)), dn, 1e-6) << name;
    }
    EXPECT_EQ(response.digitalNumber(0.0), 0.0) << name;
    EXPECT_EQ(response.digitalNumber(1e9), 255.0) << name;
  }
}

TEST(CameraResponse, RefusesAnOffsetOutOfRange) {
  EXPECT_THROW(CameraResponse::linear(-0.1), std::invalid_argument);
  EXPECT_THROW(CameraResponse::linear(255.1), std::invalid_argument);
  EXPECT_THROW(CameraResponse::linear(std::nan("")), std::invalid_argument);
}

template <typename Exception, typename Call>
std::string messageOf(const Call& call) {
  try {
    call();
  } catch (const Exception& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(CameraResponse, MaySpanSixtyNaturalLogUnitsAndNoMore) {
  std::vector<double> table(256);
  for (std::size_t i = 0; i < table.size(); ++i) {
    table[i] = 60.0 * static_cast<double>(i) / 255.0;
  }
  EXPECT_NO_THROW(CameraResponse::fromTable(table));
  table.back() = std::nextafter(60.0, 61.0);
  EXPECT_THROW(CameraResponse::fromTable(table), std::invalid_argument);
}

TEST(CameraResponse, NamesTheFirstTableValueThatBreaksTheRule) {
  std::vector<double> table = sensorLikeTable();
  table[17] = table[16];
  EXPECT_THAT(messageOf<std::invalid_argument>([&] { CameraResponse::fromTable(table); }),
              HasSubstr("value 17 of the camera response"));
  table[3] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(messageOf<std::invalid_argument>([&] { CameraResponse::fromTable(table); }),
              HasSubstr("value 3 of the camera response is inf"));
  table = sensorLikeTable();
  table.back() = table.front() + 1000.0;
  EXPECT_THAT(messageOf<std::invalid_argument>([&] { CameraResponse::fromTable(table); }),
              HasSubstr("spans 1000 natural-log units, expected at most 60"));
  table.pop_back();
  EXPECT_THAT(messageOf<std::invalid_argument>([&] { CameraResponse::fromTable(table); }),
              HasSubstr("has 255 values, expected 256"));
}

class ResponseFile : public ::testing::Test {
 protected:
  std::string write(const std::string& text) const {
    std::ofstream(path_) << text;
    return path_;
  }
  std::string messageFor(const std::string& text) const {
    const std::string path = write(text);
    return messageOf<std::runtime_error>([&] { CameraResponse::fromFile(path); });
  }

  const TemporaryDirectory directory_;
  const std::string path_ = directory_.file("response.txt");
};

std::string asText(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) {
    text += std::to_string(value) + "\n";
  }
  return text;
}

TEST_F(ResponseFile, IsReadWithComments) {
  const CameraResponse response =
      CameraResponse::fromFile(write("# made by hand\n\n" + asText(sensorLikeTable()) + "# end"));
  EXPECT_FALSE(response.isLinear());
  EXPECT_NEAR(response.exposure(100.0) / response.exposure(50.0), 105.0 / 55.0, 1e-4);
}

TEST_F(ResponseFile, MayHaveOneMegabyteAndNoMore) {
  std::string text = asText(sensorLikeTable());
  text.append((std::size_t{1} << 20) - text.size(), ' ');
  EXPECT_NO_THROW(CameraResponse::fromFile(write(text)));
  EXPECT_THAT(messageFor(text + " "), HasSubstr(path_ + ": larger than 1 MB"));
}

TEST_F(ResponseFile, NamesFileLineAndRule) {
  EXPECT_THAT(messageFor("# response\n0.5 one 2"), HasSubstr(path_ + ":2: 'one' is not a number"));
  EXPECT_THAT(messageFor("0.5\n0.4"), HasSubstr(path_ + ":2: value 1 of the camera response"));
  EXPECT_THAT(messageFor(asText(sensorLikeTable()) + "9"),
              HasSubstr(path_ + ":257: more than 256"));
  EXPECT_THAT(messageFor("1 2 3"), HasSubstr(path_ + ": the camera response has 3 values"));
  EXPECT_THAT(
      messageOf<std::runtime_error>([] { CameraResponse::fromFile("/nonexistent/response"); }),
      HasSubstr("/nonexistent/response: cannot be read"));
  EXPECT_THAT(messageOf<std::runtime_error>([] { CameraResponse::fromFile("/dev/zero"); }),
              HasSubstr("/dev/zero: larger than 1 MB"));
}

}  // namespace
}  // namespace fast_edi

/// What test/python/cost compares the Python module with: the same events and frames, from plain
/// arrays in C++. A library that is loaded beside the module, so that both are measured in turns.
#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "fast_edi/base/stored_image.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"

namespace {

using Clock = std::chrono::steady_clock;

class Sink : public fast_edi::FrameSink {
 public:
  fast_edi::MutableImageView begin(const fast_edi::InputFrame& input) override {
    return image_.reshape(input.image.size, input.image.format);
  }
  void finish(const fast_edi::OutputFrame& output) override { deblurred_ = output.deblurred; }
  bool deblurred() const { return deblurred_; }

 private:
  fast_edi::StoredImage image_;
  bool deblurred_ = false;
};

fast_edi::DeblurParameters parametersFor(bool plain) {
  fast_edi::DeblurParameters parameters;
  parameters.thresholds = {0.25, 0.25};
  parameters.filter.enabled = !plain;
  return parameters;
}

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

struct Camera {
  Camera(fast_edi::SensorSize sensor, bool plain)
      : size(sensor), deblurrer(parametersFor(plain), sink), pixels(sensor.pixelCount(), 100) {}

  const fast_edi::SensorSize size;
  Sink sink;
  fast_edi::Deblurrer deblurrer;
  const std::vector<std::uint8_t> pixels;
};

extern "C" {

Camera* makeCamera(int width, int height, int plain) {
  return new Camera({width, height}, plain != 0);
}

void deleteCamera(Camera* camera) {
  delete camera;
}

/// Takes arrays of events that make up one exposure, then the frame and the event that closes it.
/// \param t [us]
/// \return whether the frame was deblurred
int playFrame(Camera* camera, const std::int64_t* t, const std::uint16_t* x, const std::uint16_t* y,
              const std::uint8_t* p, int arrays, int array_events, std::int64_t end_us,
              double* take_s, double* close_s) {
  std::vector<fast_edi::Event> events;
  for (int i = 0; i < arrays * array_events; ++i) {
    events.push_back({x[i], y[i], t[i] * fast_edi::kNanosecondsPerMicrosecond, p[i] != 0});
  }
  const std::int64_t start_ns = events.front().t_ns;
  const std::int64_t end_ns = end_us * fast_edi::kNanosecondsPerMicrosecond;
  const auto count = static_cast<std::size_t>(array_events);

  const auto taking = Clock::now();
  for (std::size_t begin = 0; begin < events.size(); begin += count) {
    camera->deblurrer.addEvents(&events[begin], count, camera->size,
                                events[begin + count - 1].t_ns);
  }
  *take_s = secondsSince(taking);

  const auto closing = Clock::now();
  auto owned = std::make_shared<fast_edi::StoredImage>();
  owned->assign(
      {camera->pixels.data(), camera->size, static_cast<std::size_t>(camera->size.width)});
  fast_edi::InputFrame frame;
  frame.stamp_ns = start_ns + (end_ns - start_ns) / 2;
  frame.image = owned->view();
  frame.owner = owned;
  camera->deblurrer.addFrame(std::move(frame), end_ns);
  const std::int64_t exposure_us = (end_ns - start_ns) / fast_edi::kNanosecondsPerMicrosecond;
  camera->deblurrer.addExposure(static_cast<std::int32_t>(exposure_us), end_ns);
  const fast_edi::Event last{0, 0, end_ns, false};
  camera->deblurrer.addEvents(&last, 1, camera->size, end_ns);
  *close_s = secondsSince(closing);
  return camera->sink.deblurred() ? 1 : 0;
}

}  // extern "C"

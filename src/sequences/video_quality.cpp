#include "sequences/video_quality.hpp"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <iomanip>
#include <map>
#include <ostream>
#include <stdexcept>

#include <opencv2/core.hpp>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "measures/image_metrics.hpp"
#include "sequences/sequence_input.hpp"
#include "simulation/davis_simulator.hpp"

namespace fast_edi {
namespace {

/// Measures the latent images of each exposure as they come.
class VideoScorer : public FrameSink {
 public:
  VideoScorer(const DavisSimulator& simulator, SensorSize size)
      : simulator_(simulator), picture_(size.height, size.width, CV_8UC1) {}

  MutableImageView begin(const InputFrame&) override { return view(); }
  void finish(const OutputFrame& output) override { exposure_ = output.exposure; }
  bool wantsLatentImages() const override { return true; }
  MutableImageView beginLatent(const InputFrame&) override { return view(); }
  void finishLatent(const InputFrame&, std::int64_t stamp_ns) override {
    if (stamp_ns >= exposure_.start_ns && stamp_ns < exposure_.end_ns) {
      psnr_db_[exposure_.start_ns].push_back(psnr(picture_, simulator_.latentAt(stamp_ns)));
    }
  }

  /// Of the images within the exposure that starts then, in order.
  const std::vector<double>& of(std::int64_t exposure_start_ns) {
    return psnr_db_[exposure_start_ns];
  }

 private:
  MutableImageView view() {
    return {picture_.data, {picture_.cols, picture_.rows}, picture_.step[0], PixelFormat::kMono8};
  }

  const DavisSimulator& simulator_;
  cv::Mat picture_;
  ExposureInterval exposure_;
  std::map<std::int64_t, std::vector<double>> psnr_db_;  ///< by the start of the exposure
};

void add(const std::vector<double>& psnr_db, VideoQuality& quality) {
  const double middle = psnr_db[psnr_db.size() / 2];
  const double worst = *std::min_element(psnr_db.begin(), psnr_db.end());
  quality.largest_loss_db = std::max(quality.largest_loss_db, middle - worst);
  for (std::size_t i = 0; i < psnr_db.size(); ++i) {
    quality.psnr_db[i] += psnr_db[i];
  }
  ++quality.frames;
}

InputFrame inputFrame(const cv::Mat& blurry, const ExposureInterval& exposure) {
  InputFrame input;
  input.stamp_ns = exposure.at(ExposureInstant::kMid);
  input.image = {blurry.data, {blurry.cols, blurry.rows}, blurry.step[0], PixelFormat::kMono8};
  return input;
}

void printRow(std::ostream& out, const VideoQuality& quality) {
  out << "| " << quality.name << " |";
  for (const double psnr_db : quality.psnr_db) {
    out << " " << psnr_db << " |";
  }
  out << " " << quality.lossDb() << " | " << quality.largest_loss_db << " |\n";
}

}  // namespace

double VideoQuality::lossDb() const {
  return psnr_db.empty()
             ? 0.0
             : psnr_db[psnr_db.size() / 2] - *std::min_element(psnr_db.begin(), psnr_db.end());
}

VideoQuality videoQuality(const EvaluationSequence& sequence, const DeblurParameters& parameters,
                          int images, int skip, const std::function<void(int)>& progress) {
  if (images < 1 || images % 2 == 0) {
    throw std::invalid_argument("images of the video: expected an odd number, got " +
                                std::to_string(images));
  }
  DeblurParameters known = sensorParameters(parameters, sequence.settings, 1.0);
  known.latent = {images, 0};
  DavisSimulator simulator(sequence.settings);
  VideoScorer scorer(simulator, sequence.settings.sensor.size);
  Deblurrer deblurrer(known, scorer);
  VideoQuality quality{sequence.name, 0, std::vector<double>(static_cast<std::size_t>(images)), 0};
  WireArrays arrays;
  SimulatedInterval interval;
  std::deque<cv::Mat> frames;  // the pipeline looks at the last ones still
  std::vector<std::int64_t> exposure_starts_ns;
  while (simulator.next(interval)) {
    frames.push_back(interval.frame.blurry.clone());
    exposure_starts_ns.push_back(interval.frame.exposure.start_ns);
    deblurrer.addFrame(inputFrame(frames.back(), interval.frame.exposure),
                       interval.frame.exposure.end_ns);
    const WireArrays::Array array = arrays.pack(interval.events);
    deblurrer.addEvents(array.events, sequence.settings.sensor.size, array.sequence,
                        interval.end_ns);
    progress(static_cast<int>(frames.size()));
  }
  deblurrer.finish();
  for (std::size_t i = static_cast<std::size_t>(skip); i < exposure_starts_ns.size(); ++i) {
    const std::vector<double>& psnr_db = scorer.of(exposure_starts_ns[i]);
    if (psnr_db.size() == quality.psnr_db.size()) {
      add(psnr_db, quality);
    }
  }
  for (double& psnr_db : quality.psnr_db) {
    psnr_db /= std::max(quality.frames, 1);
  }
  return quality;
}

void printVideoTable(std::ostream& out, const std::vector<VideoQuality>& sequences) {
  if (sequences.empty()) {
    return;
  }
  VideoQuality mean{"mean", 0, std::vector<double>(sequences.front().psnr_db.size()), 0};
  for (const VideoQuality& quality : sequences) {
    for (std::size_t i = 0; i < mean.psnr_db.size(); ++i) {
      mean.psnr_db[i] += quality.psnr_db[i] / static_cast<double>(sequences.size());
    }
    mean.largest_loss_db = std::max(mean.largest_loss_db, quality.largest_loss_db);
  }
  out << std::fixed << std::setprecision(2) << "| PSNR [dB] at |";
  for (std::size_t i = 0; i < mean.psnr_db.size(); ++i) {
    out << " " << (static_cast<double>(i) + 0.5) / static_cast<double>(mean.psnr_db.size()) << " |";
  }
  out << " loss | largest |\n|---|";
  for (std::size_t i = 0; i < mean.psnr_db.size() + 2; ++i) {
    out << "---:|";
  }
  out << "\n";
  for (const VideoQuality& quality : sequences) {
    printRow(out, quality);
  }
  printRow(out, mean);
}

}  // namespace fast_edi

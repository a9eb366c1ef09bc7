/// \file
/// `demo_report`: what a recording with live deblurred frames shows, as a picture and as figures.
///
/// The recording goes through the pipeline once more. That gives each frame's exposure and events,
/// and checks that what was published live is what comes out offline.

#include <algorithm>
#include <cstdint>
#include <deque>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <cv_bridge/cv_bridge.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <boost/program_options.hpp>
#include <opencv2/imgcodecs.hpp>

#include "bags/nothing_deblurred.hpp"
#include "calibration/learned_contrast.hpp"
#include "command_line.hpp"
#include "evaluation/comparison_sheet.hpp"
#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/bags/bag_pipeline.hpp"
#include "fast_edi/bags/bag_reader.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "fast_edi/messages/event_array.hpp"
#include "fast_edi/messages/image_pixels.hpp"
#include "fast_edi/tags/tag_detector.hpp"
#include "measures/image_metrics.hpp"
#include "node/comparison_view.hpp"

namespace fast_edi {
namespace {

namespace po = boost::program_options;

constexpr std::size_t kSheetRows = 4;
/// A frame is settled once this many more have come: by then its output and truth are there too.
constexpr std::size_t kSettleAfterFrames = 16;
constexpr double kNanosecondsInMillisecond = 1e6;
constexpr double kNanosecondsInSecond = 1e9;
constexpr int kNameWidth = 28;
constexpr double kNoticeableGain = 1.25;
constexpr char kDiagnosticsTopic[] = "/diagnostics";

struct Arguments {
  std::string bag;
  std::string live;
  std::string config;
  std::string picture;
  std::string truth = "/dvs/ground_truth/image_raw";
  std::string name;
  TopicNames topics;
  std::vector<std::string> overrides;
  bool overwrite = false;
};

/// A frame before, after, or as it truly was.
struct View {
  cv::Mat mono8;  ///< may share the message's memory
  double sharpness = 0.0;
  std::size_t tags = 0;
  std::optional<double> psnr_db;  ///< against the truth
};

/// Sums over the frames that have a view.
struct ViewTotals {
  std::size_t frames = 0;
  double sharpness = 0.0;
  std::size_t tags = 0;
  std::size_t frames_with_psnr = 0;
  double psnr_db = 0.0;

  void add(const View& view) {
    ++frames;
    sharpness += view.sharpness;
    tags += view.tags;
    if (view.psnr_db) {
      ++frames_with_psnr;
      psnr_db += *view.psnr_db;
    }
  }
};

/// A frame in all its views; the truth is empty where it is not known.
struct FrameViews {
  View before;
  View after;
  View truth;
};

struct PendingFrame {
  BagPipeline::Output offline;
  cv::Mat events;  ///< drawn, for the frames that go on the sheet
  std::size_t number = 0;
  bool on_sheet = false;
};

double milliseconds(std::int64_t duration_ns) {
  return static_cast<double>(duration_ns) / kNanosecondsInMillisecond;
}

std::string text(double value, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

/// What was recorded of the nodelet, read as far as it is asked for.
class LiveRecording {
 public:
  LiveRecording(const std::string& path, std::string image_topic)
      : reader_(path), image_topic_(std::move(image_topic)) {}

  /// The image with that stamp, if it was published. Earlier ones are discarded.
  sensor_msgs::ImageConstPtr take(const ros::Time& stamp) {
    while (images_.count(stamp) == 0 && readOne()) {
    }
    const auto found = images_.find(stamp);
    if (found == images_.end()) {
      return nullptr;
    }
    sensor_msgs::ImageConstPtr image = found->second;
    images_.erase(images_.begin(), std::next(found));
    return image;
  }

  void readToEnd() {
    while (readOne()) {
      images_.clear();
    }
  }

  std::size_t imageCount() const { return image_count_; }
  /// The last value that was reported under \p key, if any.
  std::optional<std::string> diagnostic(const std::string& key) const {
    const auto found = diagnostics_.find(key);
    return found == diagnostics_.end() ? std::nullopt : std::make_optional(found->second);
  }

 private:
  bool readOne() {
    BagMessage message;
    if (!reader_.next(message)) {
      return false;
    }
    if (message.connection->topic == image_topic_) {
      const auto image = deserialise<sensor_msgs::Image>(message);
      images_[image->header.stamp] = image;
      ++image_count_;
    } else if (message.connection->topic == kDiagnosticsTopic) {
      const auto array = deserialise<diagnostic_msgs::DiagnosticArray>(message);
      for (const auto& status : array->status) {
        for (const auto& value : status.values) {
          diagnostics_[value.key] = value.value;
        }
      }
    }
    return true;
  }

  BagReader reader_;
  const std::string image_topic_;
  std::map<ros::Time, sensor_msgs::ImageConstPtr> images_;
  std::map<std::string, std::string> diagnostics_;
  std::size_t image_count_ = 0;
};

/// The events of the recording: their span, and those of an exposure as a picture.
class RecordedEvents {
 public:
  explicit RecordedEvents(const DeblurParameters& parameters)
      : mapping_(parameters.event_mapping), time_offset_ns_(parameters.time_offset_ns) {}

  void add(const BagMessage& message) {
    const auto array = deserialise<EventArrayView>(message);
    const WireEvents events = array->events();
    view_.addEvents(events, sensorSize(*array), mapping_);
    if (events.empty()) {
      return;
    }
    first_ns_ = first_ns_.value_or(decodeWireEvent(events.record(0)).t_ns);
    last_ns_ = decodeWireEvent(events.record(events.count - 1)).t_ns;
  }

  double spanSeconds() const {
    return first_ns_ ? static_cast<double>(last_ns_ - *first_ns_) / kNanosecondsInSecond : 0.0;
  }

  /// Empty for a frame whose exposure is not known.
  cv::Mat draw(const BagPipeline::Output& output) const {
    if (!output.frame.input.supported || output.frame.exposure.length() == 0) {
      return {};
    }
    const ExposureInterval window{output.frame.exposure.start_ns + time_offset_ns_,
                                  output.frame.exposure.end_ns + time_offset_ns_};
    const sensor_msgs::Image& input = *messageFrame(output.frame.input).message;
    const cv::Mat panels =
        cv_bridge::toCvCopy(view_.draw(input, *output.image, window), "bgr8")->image;
    const int width = panels.cols / 3;
    return panels.colRange(width, 2 * width).clone();
  }

 private:
  ComparisonView view_;
  const EventMapping mapping_;
  const std::int64_t time_offset_ns_;
  std::optional<std::int64_t> first_ns_;
  std::int64_t last_ns_ = 0;
};

/// The true sharp frames, until they are discarded.
class TrueFrames {
 public:
  void add(const BagMessage& message) {
    const auto image = deserialise<sensor_msgs::Image>(message);
    images_[image->header.stamp] = image;
  }
  /// Empty if there is none; may share the memory of the message.
  cv::Mat at(const ros::Time& stamp) const {
    const auto found = images_.find(stamp);
    return found == images_.end() ? cv::Mat() : greyPixels(*found->second);
  }
  /// Discards this one and those before.
  void discardUntil(const ros::Time& stamp) {
    images_.erase(images_.begin(), images_.upper_bound(stamp));
  }

 private:
  std::map<ros::Time, sensor_msgs::ImageConstPtr> images_;
};

/// Name, before, after, truth.
void printLine(std::ostream& out, const std::string& name, const std::string& before,
               const std::string& after, const std::string& truth) {
  constexpr int kColumnWidth = 12;
  out << std::left << std::setw(kNameWidth) << name << std::right << std::setw(kColumnWidth)
      << before << std::setw(kColumnWidth) << after << std::setw(kColumnWidth) << truth << "\n";
}

std::string meanText(double sum, std::size_t count, int digits) {
  return count == 0 ? "-" : text(sum / static_cast<double>(count), digits);
}

/// Image quality of the frames before and after, and of the truth.
class QualityTable {
 public:
  /// Measures the views of a frame and counts them. They share the memory of the pictures.
  /// \param truth empty if it is not known
  FrameViews add(const cv::Mat& before, const cv::Mat& after, const cv::Mat& truth) {
    FrameViews views;
    views.before = measure(before, truth);
    views.after = measure(after, truth);
    before_.add(views.before);
    after_.add(views.after);
    if (!truth.empty()) {
      views.truth = measure(truth, {});
      true_.add(views.truth);
    }
    return views;
  }

  bool hasTruth() const { return true_.frames > 0; }

  void print(std::ostream& out) const {
    const bool truth = hasTruth();
    printLine(out, "", "blurry", "deblurred", truth ? "truth" : "");
    printLine(out, "sharpness [DN^2/px^2]", meanText(before_.sharpness, before_.frames, 1),
              meanText(after_.sharpness, after_.frames, 1),
              truth ? meanText(true_.sharpness, true_.frames, 1) : "");
    printLine(out, "AprilTags found (36h11)", std::to_string(before_.tags),
              std::to_string(after_.tags), truth ? std::to_string(true_.tags) : "");
    if (truth) {
      printLine(out, "PSNR [dB]", meanText(before_.psnr_db, before_.frames_with_psnr, 2),
                meanText(after_.psnr_db, after_.frames_with_psnr, 2), "");
    }
  }

 private:
  View measure(const cv::Mat& mono8, const cv::Mat& truth) const {
    View view;
    view.mono8 = mono8;
    view.sharpness = sharpness(mono8).tenengrad_above_noise;
    view.tags = detector_.detect(mono8).size();
    if (!truth.empty() && truth.size() == mono8.size()) {
      view.psnr_db = psnr(mono8, truth);
    }
    return view;
  }

  TagDetector detector_;
  ViewTotals before_;
  ViewTotals after_;
  ViewTotals true_;
};

std::string caption(const View& view) {
  std::string words = "sharpness " + text(view.sharpness, 1);
  if (view.tags > 0) {
    words += ", " + std::to_string(view.tags) + (view.tags == 1 ? " tag" : " tags");
  }
  if (view.psnr_db) {
    words += ", " + text(*view.psnr_db, 1) + " dB";
  }
  return words;
}

/// The picture: a row for each of some frames, from the middles of equal parts of the recording.
class FrameSheet {
 public:
  /// \param frames_expected in the recording
  explicit FrameSheet(std::uint64_t frames_expected) : frames_expected_(frames_expected) {}

  /// Whether a frame goes on the sheet; to be asked once for each, in order.
  bool choose(std::size_t number) {
    const std::uint64_t first = (2 * rows_chosen_ + 1) * frames_expected_ / (2 * kSheetRows);
    const bool chosen = rows_chosen_ < kSheetRows && number >= first;
    rows_chosen_ += chosen ? 1 : 0;
    return chosen;
  }
  void add(const PendingFrame& frame, const FrameViews& views);
  cv::Mat draw(const std::string& title, bool with_truth) const;

 private:
  const std::uint64_t frames_expected_;
  std::size_t rows_chosen_ = 0;
  std::vector<SheetRow> rows_;
  double gain_ = kMaxDisplayGain;
};

void FrameSheet::add(const PendingFrame& frame, const FrameViews& views) {
  const OutputFrame& output = frame.offline.frame;
  SheetRow row;
  row.label = "frame " + std::to_string(frame.number + 1) + ": ";
  if (output.deblurred) {
    row.label += "exposure " + text(milliseconds(output.exposure.length()), 1) + " ms, " +
                 std::to_string(output.events) + " events";
  } else {
    row.label += std::string("passed through, ") + toString(output.pass_reason);
  }
  // Copies: the frames share the memory of messages that will be gone.
  row.panels = {views.before.mono8.clone(), frame.events, views.after.mono8.clone()};
  row.captions = {caption(views.before), "", caption(views.after)};
  if (!views.truth.mono8.empty()) {
    row.panels.push_back(views.truth.mono8.clone());
    row.captions.push_back(caption(views.truth));
  }
  gain_ = std::min(gain_, displayGain(views.before.mono8));
  rows_.push_back(std::move(row));
}

cv::Mat FrameSheet::draw(const std::string& title, bool with_truth) const {
  Sheet sheet;
  sheet.title = title;
  sheet.columns = {"blurry frame", "events (red ON, blue OFF)", "deblurred"};
  if (with_truth) {
    sheet.columns.push_back("truth");
  }
  sheet.rows = rows_;
  if (gain_ > kNoticeableGain) {
    sheet.title += "  (frames shown " + text(gain_, 1) + " times as bright)";
    for (SheetRow& row : sheet.rows) {
      for (cv::Mat& panel : row.panels) {
        if (panel.channels() == 1) {
          cv::Mat brighter;
          panel.convertTo(brighter, CV_8U, gain_);
          panel = brighter;
        }
      }
    }
  }
  return drawSheet(sheet);
}

std::uint64_t messagesOn(const BagReader& reader, const std::string& topic) {
  std::uint64_t messages = 0;
  for (const auto& entry : reader.connections()) {
    messages += entry.second.topic == topic ? entry.second.messages : 0;
  }
  return messages;
}

/// Brings together what belongs to one frame: as it was published live, as it comes out offline,
/// its truth, its events.
class Report {
 public:
  Report(const Arguments& arguments, const LoadedParameters& parameters, const BagReader& reader)
      : arguments_(arguments),
        live_(arguments.live, arguments.topics.outputImage()),
        given_thresholds_(parameters.deblur.thresholds),
        pipeline_(arguments.topics, parameters),
        events_(parameters.deblur),
        sheet_(messagesOn(reader, arguments.topics.image)) {}

  void add(const BagMessage& message) {
    const std::string& topic = message.connection->topic;
    if (topic == arguments_.topics.events) {
      events_.add(message);
    } else if (topic == arguments_.truth) {
      truth_.add(message);
    }
    pipeline_.add(message);
    takeOutputs();
    while (pending_.size() > kSettleAfterFrames) {
      settleOldest();
    }
  }

  void finish() {
    pipeline_.finish();
    takeOutputs();
    while (!pending_.empty()) {
      settleOldest();
    }
    live_.readToEnd();
  }

  bool hasOutput() const { return live_.imageCount() > 0; }
  bool lostFrames() const { return frames_lost_ > 0; }

  void print(std::ostream& out) const;
  cv::Mat draw() const { return sheet_.draw(arguments_.name, quality_.hasTruth()); }

 private:
  void printLatency(std::ostream& out, const std::string& name, const std::string& key,
                    const std::string& remark) const;

  void takeOutputs() {
    for (BagPipeline::Output& output : pipeline_.takeOutputs()) {
      PendingFrame frame;
      frame.number = frames_seen_++;
      frame.on_sheet = sheet_.choose(frame.number);
      if (frame.on_sheet) {
        frame.events = events_.draw(output);
      }
      frame.offline = std::move(output);
      pending_.push_back(std::move(frame));
    }
  }

  void settleOldest();

  const Arguments& arguments_;
  LiveRecording live_;
  const ContrastThresholds given_thresholds_;
  BagPipeline pipeline_;
  RecordedEvents events_;
  TrueFrames truth_;
  QualityTable quality_;
  FrameSheet sheet_;
  std::deque<PendingFrame> pending_;
  std::size_t frames_seen_ = 0;
  std::size_t frames_lost_ = 0;
  std::size_t frames_as_offline_ = 0;
};

void Report::settleOldest() {
  const PendingFrame frame = std::move(pending_.front());
  pending_.pop_front();
  const ros::Time stamp = frame.offline.image->header.stamp;
  const MessageFrame& input = messageFrame(frame.offline.frame.input);
  const sensor_msgs::ImageConstPtr live = live_.take(stamp);
  if (!live) {
    ++frames_lost_;
  } else {
    frames_as_offline_ += live->data == frame.offline.image->data ? 1 : 0;
    if (frame.offline.frame.input.supported) {
      const cv::Mat truth = truth_.at(stamp);
      const FrameViews views = quality_.add(greyPixels(*input.message), greyPixels(*live), truth);
      if (frame.on_sheet) {
        sheet_.add(frame, views);
      }
    }
  }
  truth_.discardUntil(stamp);
}

void Report::printLatency(std::ostream& out, const std::string& name, const std::string& key,
                          const std::string& remark) const {
  const std::optional<std::string> p50 = live_.diagnostic(key + " p50 [ms]");
  const std::optional<std::string> p99 = live_.diagnostic(key + " p99 [ms]");
  if (p50 && p99) {
    out << std::left << std::setw(kNameWidth) << name << "median " << *p50 << " ms, 99 % within "
        << *p99 << " ms" << remark << "\n";
  }
}

void Report::print(std::ostream& out) const {
  const DeblurCounters& counters = pipeline_.counters();
  out << "frames in                   " << counters.frames_in << "\n"
      << "frames out                  " << live_.imageCount() << " (" << frames_lost_ << " lost)\n"
      << "deblurred                   " << counters.frames_deblurred << "\n"
      << "passed through unchanged    " << counters.framesPassed() << "\n";
  for (std::size_t i = 0; i < kPassReasonCount; ++i) {
    if (counters.frames_passed[i] > 0) {
      out << "  " << toString(static_cast<PassReason>(i)) << ": " << counters.frames_passed[i]
          << "\n";
    }
  }
  out << "same bits as deblur_bag     " << frames_as_offline_ << " of " << live_.imageCount()
      << "\n";
  out << "events                      " << counters.events_in;
  const double span_s = events_.spanSeconds();
  if (span_s > 0.0) {
    out << ", " << text(static_cast<double>(counters.events_in) / span_s / 1e6, 3) << " Mev/s";
  }
  out << "\n";
  printLatency(out, "image arrival to output", "Image to output",
               " (the wait for the exposure's last events included)");
  printLatency(out, "last message to output", "Close latency", "");
  const std::string nothing = nothingDeblurred(counters, pipeline_.status().differing_clocks);
  out << (nothing.empty() ? "" : nothing + "\n");
  const std::string remark = learnedContrastRemark(given_thresholds_, pipeline_.status().thresholds,
                                                   counters.calibration_fits);
  out << (remark.empty() ? "" : remark + "\n") << "\n";
  quality_.print(out);
}

/// \return false when help was asked for and given
bool parseArguments(int argc, char** argv, Arguments& arguments) {
  TopicNames& topics = arguments.topics;
  po::options_description visible("Options");
  visible.add_options()("help,h", "print this")(
      "in", po::value(&arguments.bag)->required()->value_name("BAG"), "recording")(
      "live", po::value(&arguments.live)->required()->value_name("BAG"),
      "what was recorded of the nodelet")(
      "config", po::value(&arguments.config)->required()->value_name("YAML"),
      "YAML file with the parameters")("picture",
                                       po::value(&arguments.picture)->required()->value_name("PNG"),
                                       "picture to write, e.g. out.png")(
      "name", po::value(&arguments.name)->value_name("TEXT"), "heading of the picture")(
      "camera-info", po::value(&topics.camera_info)->value_name("TOPIC"),
      "calibration; the sibling of --image by default, may be missing")(
      "truth", tools::textOption(arguments.truth, "TOPIC"), "true sharp frames; may be missing");
  tools::addTopicOptions(visible, topics);
  tools::addForceOption(visible, arguments.overwrite);
  auto values = tools::readCommandLine(
      argc, argv, visible,
      {"Usage: demo_report --in BAG --live BAG --config YAML --picture PNG [options] "
       "[parameter:=value ...]\n\n"
       "Compares the frames of a recording with the deblurred ones that the nodelet "
       "published while it\nwas played.\n",
       "0 done; 1 failed, or a frame has no output."},
      &arguments.overrides);
  if (!values) {
    return false;
  }
  po::notify(*values);
  if (arguments.name.empty()) {
    arguments.name = arguments.bag;
  }
  return true;
}

int run(const Arguments& arguments) {
  tools::requireFree(arguments.picture, arguments.overwrite);
  const LoadedParameters parameters = parametersFromFile(arguments.config, arguments.overrides);
  BagReader reader(arguments.bag);
  Report report(arguments, parameters, reader);
  BagMessage message;
  while (reader.next(message)) {
    report.add(message);
  }
  report.finish();
  report.print(std::cout);
  if (!report.hasOutput()) {
    std::cerr << "demo_report: no deblurred frame was published\n";
    return tools::kFailed;
  }
  if (!cv::imwrite(arguments.picture, report.draw())) {
    std::cerr << "demo_report: cannot write " << arguments.picture << "\n";
    return tools::kFailed;
  }
  return report.lostFrames() ? tools::kFailed : tools::kDone;
}

}  // namespace
}  // namespace fast_edi

int main(int argc, char** argv) {
  return fast_edi::tools::runTool("demo_report", [argc, argv] {
    fast_edi::Arguments arguments;
    return fast_edi::parseArguments(argc, argv, arguments) ? fast_edi::run(arguments)
                                                           : fast_edi::tools::kDone;
  });
}

#include "tools/deblur_bag/deblur_recordings.hpp"

#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <map>
#include <stdexcept>
#include <system_error>

#include <boost/program_options.hpp>

#include "command_line.hpp"
#include "interruption.hpp"
#include "tools/deblur_bag/deblur_recording.hpp"

namespace fast_edi::deblur_bag {
namespace {

namespace fs = std::filesystem;

std::string bagNameOf(const std::string& recording) {
  fs::path path = fs::path(recording).lexically_normal();
  if (!path.has_filename()) {
    path = path.parent_path();  // FOLDER/
  }
  const fs::path name = fs::is_directory(path) ? path.filename() : path.stem();
  if (name.empty() || name == "." || name == ".." || name == "/") {
    throw boost::program_options::error("--out-dir: \"" + recording + "\" gives no name to a bag");
  }
  return name.string() + ".bag";
}

/// What became of all recordings.
class Totals {
 public:
  void add(const std::string& recording, const RecordingOutcome& outcome) {
    const BagDeblurReport& report = outcome.report;
    ++done_;
    if (outcome.exit_code == tools::kNothingDeblurred) {
      not_deblurred_.push_back(recording);
    }
    if (report.incomplete()) {
      incomplete_.push_back(recording);
    }
    frames_in_ += report.counters.frames_in;
    frames_deblurred_ += report.counters.frames_deblurred;
    frames_passed_ += report.counters.framesPassed();
    events_in_ += report.counters.events_in;
  }
  void addFailure(const std::string& recording, const std::string& cause) {
    failed_.push_back(recording + ": " + cause);
  }

  int exitCode() const {
    if (!failed_.empty()) {
      return tools::kFailed;
    }
    if (!not_deblurred_.empty()) {
      return tools::kNothingDeblurred;
    }
    return incomplete_.empty() ? tools::kDone : tools::kInputIncomplete;
  }

  void print(std::size_t recordings, double seconds) const {
    constexpr double kEventsPerMega = 1e6;
    std::cout << "\nall recordings\n";
    printCount(done_, "done");
    printCount(incomplete_.size(), "of these cut short or damaged");
    printCount(not_deblurred_.size(), "of these without any deblurred frame");
    printCount(failed_.size(), "failed");
    printCount(recordings - done_ - failed_.size(), "not done: interrupted");
    printCount(frames_in_, "frames in");
    printCount(frames_deblurred_, "frames deblurred");
    printCount(frames_passed_, "frames passed through unchanged");
    printCount(events_in_, "events in");
    std::cout << std::fixed << std::setprecision(2) << seconds << " s, " << std::setprecision(1)
              << static_cast<double>(events_in_) / kEventsPerMega / seconds << " Mev/s\n"
              << std::flush;
    for (const std::string& recording : incomplete_) {
      std::cerr << "warning: cut short or damaged: " << recording << "\n";
    }
    for (const std::string& recording : not_deblurred_) {
      std::cerr << "warning: no frame was deblurred: " << recording << "\n";
    }
    for (const std::string& failure : failed_) {
      std::cerr << "failed: " << failure << "\n";
    }
  }

 private:
  static void printCount(std::uint64_t count, const char* what) {
    std::cout << "  " << std::setw(10) << count << "  " << what << "\n";
  }

  std::uint64_t done_ = 0;
  std::vector<std::string> incomplete_;
  std::vector<std::string> not_deblurred_;
  std::vector<std::string> failed_;
  std::uint64_t frames_in_ = 0;
  std::uint64_t frames_deblurred_ = 0;
  std::uint64_t frames_passed_ = 0;
  std::uint64_t events_in_ = 0;
};

void makeFolder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) {
    throw std::runtime_error("cannot make the folder " + folder + ": " +
                             (error ? error.message() : "a file has this name"));
  }
}

}  // namespace

std::vector<std::string> outputsOf(const std::vector<std::string>& recordings,
                                   const std::string& folder) {
  std::vector<std::string> outputs;
  std::map<std::string, std::string> taken;
  for (const std::string& recording : recordings) {
    outputs.push_back((fs::path(folder) / bagNameOf(recording)).string());
    const auto [other, is_new] = taken.emplace(outputs.back(), recording);
    if (!is_new) {
      throw boost::program_options::error("--out-dir: " + other->second + " and " + recording +
                                          " would both become " + outputs.back());
    }
  }
  return outputs;
}

int deblurRecordings(const Arguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<std::string>& recordings = arguments.inputs;
  const std::vector<std::string> outputs = outputsOf(recordings, arguments.output_folder);
  makeFolder(arguments.output_folder);
  Totals totals;
  for (std::size_t i = 0; i < recordings.size() && tools::interruptingSignal() == 0; ++i) {
    std::cout << (i > 0 ? "\n" : "") << recordings[i] << "\n" << std::flush;
    Arguments one = arguments;
    one.inputs = {recordings[i]};
    one.output = outputs[i];
    try {
      const RecordingOutcome outcome = deblurRecording(one);
      if (!outcome.report.interrupted) {
        totals.add(recordings[i], outcome);
      }
    } catch (const std::exception& error) {
      std::cerr << "deblur_bag: " << error.what() << "\n";
      totals.addFailure(recordings[i], error.what());
    }
  }
  totals.print(recordings.size(),
               std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return tools::interruptingSignal() != 0 ? tools::kInterrupted + tools::interruptingSignal()
                                          : totals.exitCode();
}

}  // namespace fast_edi::deblur_bag

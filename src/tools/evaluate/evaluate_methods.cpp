#include "tools/evaluate/evaluate_methods.hpp"

#include <cstdint>
#include <memory>
#include <utility>

#include "bags/recorded_frames.hpp"
#include "dark_channel/dark_channel_method.hpp"
#include "evaluation/method_options.hpp"
#include "evaluation/recorded_method.hpp"
#include "networks/network_method.hpp"
#include "progress_bar.hpp"

namespace fast_edi::evaluate {

OtherMethods otherMethods(const Arguments& arguments, std::vector<std::string>& incomplete) {
  std::vector<std::string> names = methodNames();
  OtherMethods methods;
  if (arguments.dark_channel) {
    const auto bar = std::make_shared<ProgressBar>("one frame ");
    methods.push_back(
        std::make_unique<DarkChannelMethod>(arguments.dark_channel_options, [bar](double done) {
          constexpr double kSteps = 1000.0;
          bar->update(static_cast<std::uint64_t>(done * kSteps),
                      static_cast<std::uint64_t>(kSteps));
        }));
    names.push_back(methods.back()->name());
  }
  const NetworkRange range = networkRange(arguments.network_range);
  for (const std::string& text : arguments.networks) {
    const NamedFile network = namedFile("--network", text, names);
    methods.push_back(std::make_unique<NetworkMethod>(network.name, network.file, range));
  }
  for (const std::string& text : arguments.columns) {
    const NamedFile column = namedFile("--column", text, names);
    const RecordedTopic from = recordedTopic(column.file, arguments.topics.outputImage());
    RecordedFrames frames = requireFrames(from.recording, from.topic);
    if (frames.malformed > 0) {
      incomplete.push_back(column.name + ": " + std::to_string(frames.malformed) +
                           " malformed frames in " + from.recording + " left out");
    }
    if (!frames.damage.empty()) {
      incomplete.push_back(column.name + ": " + from.recording + " is cut short or damaged");
    }
    methods.push_back(std::make_unique<RecordedMethod>(
        column.name, from.recording + " " + from.topic, std::move(frames.by_stamp)));
  }
  return methods;
}

}  // namespace fast_edi::evaluate

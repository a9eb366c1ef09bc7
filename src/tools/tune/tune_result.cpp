#include "tools/tune/tune_result.hpp"

#include <iostream>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/config/parameter_file.hpp"
#include "tuning/shell_text.hpp"

namespace fast_edi::tune {

std::string configurationText(const TuningSession& session) {
  return "# By eye, from rosrun fast_edi tune. Nothing is learned beyond it: refine_contrast and\n"
         "# refine_delay: true would learn from there.\n" +
         session.parameters().yaml();
}

bool save(const Arguments& arguments, TuningSession& session) {
  try {
    ParameterFile(arguments.save).write(configurationText(session));
  } catch (const std::runtime_error& error) {
    std::cerr << "tune: " << error.what() << "\n";
    session.setMessage(error.what());
    return false;
  }
  std::cout << "written: " << arguments.save << std::endl;
  session.setMessage("saved to " + arguments.save);
  return true;
}

void printCommand(const Arguments& arguments, const Start& start, const TuningSession& session,
                  const std::string& saved) {
  std::vector<std::string> words = {"rosrun", "fast_edi", "deblur_bag", "--in"};
  words.insert(words.end(), arguments.recordings.begin(), arguments.recordings.end());
  words.insert(words.end(), {"--out", "deblurred.bag"});
  const TopicNames names;
  for (const auto& [option, topic, name] :
       {std::tuple("--events", start.topics.events, names.events),
        {"--image", start.topics.image, names.image},
        {"--exposure", start.topics.exposure, names.exposure}}) {
    if (topic != name) {
      words.insert(words.end(), {option, topic});
    }
  }
  if (saved == configurationText(session)) {
    words.insert(words.end(), {"--config", arguments.save});
  } else {
    if (!arguments.config.empty()) {
      words.insert(words.end(), {"--config", arguments.config});
    }
    const std::vector<std::string> overrides = session.parameters().overrides();
    words.insert(words.end(), overrides.begin(), overrides.end());
  }
  std::cout << "to deblur the recording with these parameters:\n" << shellText(words) << std::endl;
}

}  // namespace fast_edi::tune

#include "node/learned_service.hpp"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <sstream>
#include <utility>

#include <ros/console.h>

#include "fast_edi/config/learned_file.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

fs::path rosHome() {
  const std::string home = environment("ROS_HOME");
  return home.empty() ? fs::path(environment("HOME")) / ".ros" : fs::path(home);
}

/// ROS itself creates its folder when it needs it; any other one has to exist.
void prepareFolder(const fs::path& file) {
  if (file.parent_path() == fs::absolute(rosHome())) {
    fs::create_directories(file.parent_path());
  }
}

/// \return what was written
/// \throws std::exception saying why nothing was
std::string write(const std::string& path, const DeblurStatus& status) {
  prepareFolder(path);
  LearnedFile(path).write(status.thresholds, status.event_delay_ns);
  std::istringstream lines(learnedYaml(status.thresholds, status.event_delay_ns));
  std::string values;
  for (std::string line; std::getline(lines, line);) {
    values += (values.empty() ? "" : ", ") + line;
  }
  return "written: " + path + ": " + values + " (learned from " +
         std::to_string(status.learned_pairs) + " pairs of frames)";
}

}  // namespace

std::string learnedFilePath(const std::string& given, const std::string& node_name) {
  if (!given.empty()) {
    return fs::absolute(rosHome() / given).string();
  }
  std::string name = node_name.substr(std::min(node_name.find_first_not_of('/'), node_name.size()));
  std::replace(name.begin(), name.end(), '/', '_');
  return fs::absolute(rosHome() / (name + "_learned.yaml")).string();
}

LearnedService::LearnedService(ros::NodeHandle private_nh, std::string path, Reader read)
    : path_(std::move(path)), read_(std::move(read)) {
  server_ = private_nh.advertiseService<std_srvs::Trigger::Request, std_srvs::Trigger::Response>(
      "save_learned",
      [this](std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response) {
        return save(request, response);
      });
}

bool LearnedService::save(std_srvs::Trigger::Request& /*request*/,
                          std_srvs::Trigger::Response& response) const {
  const DeblurStatus status = read_();
  response.success = 0;
  if (status.learned_pairs == 0) {
    response.message =
        "not written: nothing has been learned since the node began to listen, the events "
        "restarted "
        "or parameters changed. Expected: filter, and refine_contrast or refine_delay, are on, the "
        "output is subscribed to, and consecutive frames with motion have been deblurred";
  } else {
    try {
      response.message = write(path_, status);
      response.success = 1;
    } catch (const std::exception& error) {
      response.message = std::string("not written: ") + error.what();
    }
  }
  ROS_INFO_STREAM(server_.getService() << ": " << response.message);
  return true;
}

}  // namespace fast_edi

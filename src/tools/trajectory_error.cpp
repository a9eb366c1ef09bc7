/// \file
/// `trajectory_error`: absolute trajectory error and drift of recorded odometry against recorded
/// true poses.

#include <functional>
#include <iomanip>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/serialization.h>
#include <boost/program_options.hpp>
#include <opencv2/imgcodecs.hpp>

#include "command_line.hpp"
#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/bags/bag_error.hpp"
#include "fast_edi/bags/bag_reader.hpp"
#include "trajectory/trajectory_error.hpp"
#include "trajectory/trajectory_plot.hpp"

namespace {

namespace po = boost::program_options;
namespace tools = fast_edi::tools;
using fast_edi::BagMessage;
using fast_edi::TimedPosition;
using tools::kDone;
using tools::kInputIncomplete;

struct Arguments {
  std::string bag;
  std::string truth_bag;
  std::string estimate = "/vins_estimator/odometry";
  std::string truth = "/dvs/ground_truth/pose";
  std::string alignment = "yaw";
  std::string plot;
  double max_gap_s = 0.5;
  bool overwrite = false;
};

po::options_description describeOptions(Arguments& arguments) {
  po::options_description options("Options");
  auto add = options.add_options();
  using tools::textOption;
  add("help,h", "print this");
  add("estimate", textOption(arguments.estimate, "TOPIC"), "estimated poses");
  add("truth", textOption(arguments.truth, "TOPIC"), "true poses");
  add("truth-bag", po::value(&arguments.truth_bag)->value_name("BAG"),
      "where the true poses are; the same bag by default");
  add("align", textOption(arguments.alignment, "HOW"),
      "what the estimate is laid over the truth by: yaw (translation and rotation about z), se3 "
      "(any rotation) or sim3 (scale too)");
  add("gap",
      po::value(&arguments.max_gap_s)->default_value(arguments.max_gap_s, "0.5")->value_name("S"),
      "a longer pause between two estimates counts as a reset [s]");
  add("plot", po::value(&arguments.plot)->value_name("PNG"), "draw both from above");
  tools::addForceOption(options, arguments.overwrite);
  return options;
}

/// \return false when help was asked for and given
bool parseArguments(int argc, char** argv, Arguments& arguments) {
  const po::options_description visible = describeOptions(arguments);
  std::vector<std::string> words;
  auto values = tools::readCommandLine(
      argc, argv, visible,
      {"Usage: trajectory_error BAG [options]\n\n"
       "Compares recorded odometry with true poses, by the stamps of their headers:\n"
       "absolute trajectory error after one alignment of the whole, drift at the end\n"
       "(where the estimate went from its first to its last pose, against the truth),\n"
       "and for how long there was an estimate. Poses are nav_msgs/Odometry,\n"
       "geometry_msgs/PoseStamped or geometry_msgs/PoseWithCovarianceStamped.\n",
       "0 done; 1 failed; 2 a bag was cut short or damaged."},
      &words);
  if (!values) {
    return false;
  }
  po::notify(*values);
  std::vector<std::string> overrides;
  std::vector<std::string> bags;
  tools::requireRecordings(words, bags, overrides);
  if (bags.size() > 1) {
    throw po::error("one recording at a time, got " + bags[0] + " and " + bags[1]);
  }
  arguments.bag = bags.front();
  if (!overrides.empty()) {
    throw po::error("takes no parameters, got " + overrides.front());
  }
  if (!(arguments.max_gap_s > 0.0)) {
    throw po::error("--gap: expected more than 0 s");
  }
  if (arguments.truth_bag.empty()) {
    arguments.truth_bag = arguments.bag;
  }
  return true;
}

TimedPosition timedPosition(const std_msgs::Header& header, const geometry_msgs::Pose& pose) {
  return {static_cast<std::int64_t>(header.stamp.toNSec()),
          {pose.position.x, pose.position.y, pose.position.z}};
}

using PoseParser = std::function<TimedPosition(const BagMessage&)>;

/// By md5: what a type is called does not matter.
std::map<std::string, PoseParser> poseParsers() {
  return {
      {ros::message_traits::md5sum<nav_msgs::Odometry>(),
       [](const BagMessage& raw) {
         const auto odometry = fast_edi::deserialise<nav_msgs::Odometry>(raw);
         return timedPosition(odometry->header, odometry->pose.pose);
       }},
      {ros::message_traits::md5sum<geometry_msgs::PoseStamped>(),
       [](const BagMessage& raw) {
         const auto stamped = fast_edi::deserialise<geometry_msgs::PoseStamped>(raw);
         return timedPosition(stamped->header, stamped->pose);
       }},
      {ros::message_traits::md5sum<geometry_msgs::PoseWithCovarianceStamped>(),
       [](const BagMessage& raw) {
         const auto stamped = fast_edi::deserialise<geometry_msgs::PoseWithCovarianceStamped>(raw);
         return timedPosition(stamped->header, stamped->pose.pose);
       }},
  };
}

/// \throws fast_edi::BagError when the bag has no poses on \p topic
std::vector<TimedPosition> readPositions(const std::string& path, const std::string& topic,
                                         bool& incomplete) {
  fast_edi::BagReader reader(path);
  const std::map<std::string, PoseParser> known = poseParsers();
  std::map<std::uint32_t, PoseParser> parsers;
  for (const auto& [id, connection] : reader.connections()) {
    if (connection.topic != topic) {
      continue;
    }
    const auto parser = known.find(connection.md5sum);
    if (parser == known.end()) {
      throw fast_edi::BagError(path + ": " + topic + " has messages of type " +
                               connection.datatype +
                               ", expected nav_msgs/Odometry, geometry_msgs/PoseStamped or "
                               "geometry_msgs/PoseWithCovarianceStamped");
    }
    parsers[id] = parser->second;
  }
  std::vector<TimedPosition> positions;
  BagMessage message;
  while (reader.next(message)) {
    const auto parser = parsers.find(message.connection->id);
    if (parser == parsers.end()) {
      continue;
    }
    try {
      positions.push_back(parser->second(message));
    } catch (const ros::serialization::StreamOverrunException&) {
      std::cerr << "warning: " << path << ": a message on " << topic
                << " is shorter than it says\n";
      incomplete = true;
    }
  }
  tools::printDamage(path, reader.damage());
  incomplete = incomplete || !reader.damage().empty();
  if (positions.empty()) {
    throw fast_edi::BagError(path + ": no poses on " + topic);
  }
  return positions;
}

int run(const Arguments& arguments) {
  if (!arguments.plot.empty()) {
    tools::requireFree(arguments.plot, arguments.overwrite);
  }
  fast_edi::TrajectoryComparison comparison;
  comparison.alignment = fast_edi::trajectoryAlignmentFromName(arguments.alignment);
  comparison.max_gap_ns = static_cast<std::int64_t>(
      arguments.max_gap_s * static_cast<double>(fast_edi::kNanosecondsPerSecond));
  bool incomplete = false;
  const fast_edi::TrajectoryError error = fast_edi::compareTrajectories(
      readPositions(arguments.bag, arguments.estimate, incomplete),
      readPositions(arguments.truth_bag, arguments.truth, incomplete), comparison);

  constexpr double kPercent = 100.0;
  std::cout << std::fixed << std::setprecision(3)
            << "absolute trajectory error, RMSE [m]: " << error.rmse_m << "\n"
            << "    median, largest [m]:             " << error.median_m << ", " << error.largest_m
            << "\n"
            << "drift at the end [m]:                " << error.end_drift_m << "\n"
            << "length of the true path [m]:         " << error.path_length_m << "\n"
            << "tracked share of the time [%]:       " << std::setprecision(1)
            << kPercent * error.tracked_share << "\n"
            << "resets:                              " << error.resets << "\n"
            << "estimates compared, left out:        " << error.compared << ", " << error.left_out
            << "\n";
  if (comparison.alignment == fast_edi::TrajectoryAlignment::kSimilarity) {
    std::cout << "scale:                               " << std::setprecision(4) << error.scale
              << "\n";
  }
  if (!arguments.plot.empty()) {
    if (!cv::imwrite(arguments.plot, fast_edi::topViewPlot(arguments.estimate, error))) {
      throw std::runtime_error(arguments.plot + ": cannot be written");
    }
    std::cout << "written: " << arguments.plot << "\n";
  }
  return incomplete ? kInputIncomplete : kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return tools::runTool("trajectory_error", [argc, argv] {
    Arguments arguments;
    return parseArguments(argc, argv, arguments) ? run(arguments) : kDone;
  });
}

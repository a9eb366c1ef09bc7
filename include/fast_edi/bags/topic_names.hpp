/// \file
/// Topics of a recording, as davis_ros_driver names them by default.
#pragma once

#include <map>
#include <string>

#include "fast_edi/bags/bag_index.hpp"

namespace fast_edi {

struct TopicNames {
  std::string events = "/dvs/events";
  std::string image = "/dvs/image_raw";
  std::string exposure = "/dvs/exposure";
  std::string camera_info;  ///< empty: the sibling of `image`
  std::string output;       ///< namespace of the output; empty: `deblurred` beside `image`

  std::string cameraInfo() const;
  std::string outputImage() const;
  std::string outputCameraInfo() const;
  /// The high-rate video: `latent` beside `image`, or below `output`.
  std::string outputLatent() const;
};

/// The namespace of \p topic: "/dvs" for "/dvs/image_raw", "" for "/image_raw".
std::string topicNamespace(const std::string& topic);

/// Whether \p topics are in a bag and of the right types. Topics with the md5 of an event array are
/// taken whatever their type's name.
/// \return what is wrong, one line for each fault, followed by all topics that the bag has; empty
///         when events and images are there. A missing exposure or camera_info is no fault.
std::string checkTopics(const TopicNames& topics,
                        const std::map<std::uint32_t, BagConnection>& connections);

/// For recordings of other drivers: where `events` or `image` has its default name and no message
/// was recorded there, the only topic that has the type is taken instead; as `exposure`, the only
/// std_msgs/Int32 whose name ends in "exposure" (many other things are integers). Ambiguity leaves
/// the names as they are, for checkTopics() to complain. True frames of a simulation (a part of the
/// name being "ground_truth") and this package's own outputs are never taken. Other names were
/// given by somebody, and stay.
TopicNames guessTopics(TopicNames topics,
                       const std::map<std::uint32_t, BagConnection>& connections);

/// What guessTopics() did, for people: one line for each name that it changed, and one when there
/// is no exposure topic but an std_msgs/Int32 that it might have meant. Empty when there is nothing
/// to say.
std::string guessText(const TopicNames& wanted, const TopicNames& guessed,
                      const std::map<std::uint32_t, BagConnection>& connections);

}  // namespace fast_edi

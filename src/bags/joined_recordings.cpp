#include "bags/joined_recordings.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace fast_edi {
namespace {

bool isSame(const BagConnection& a, const BagConnection& b) {
  return a.topic == b.topic && a.md5sum == b.md5sum && *a.header == *b.header;
}

}  // namespace

JoinedRecordings::JoinedRecordings(std::vector<Part> parts) {
  readings_.reserve(parts.size());
  for (Part& part : parts) {
    readings_.emplace_back();
    readings_.back().part = std::move(part);
    connect(readings_.back());
  }
  for (Reading& reading : readings_) {
    advance(reading);
  }
}

void JoinedRecordings::connect(Reading& reading) {
  for (const auto& [id, connection] : reading.part.source->connections()) {
    const BagConnection& wanted = connection;
    const auto same = std::find_if(connections_.begin(), connections_.end(),
                                   [&](const auto& entry) { return isSame(entry.second, wanted); });
    if (same != connections_.end()) {
      same->second.messages += connection.messages;
      same->second.counted = same->second.counted && connection.counted;
      reading.ids[id] = same->first;
      continue;
    }
    const auto new_id = static_cast<std::uint32_t>(connections_.size());
    BagConnection& added = connections_[new_id] = connection;
    added.id = new_id;
    reading.ids[id] = new_id;
  }
}

void JoinedRecordings::advance(Reading& reading) {
  BagMessage& message = reading.message;
  if (reading.part.source->next(message)) {
    message.connection = &connections_.at(reading.ids.at(message.connection->id));
  } else {
    message = {};
  }
  const std::vector<BagDamage>& damage = reading.part.source->damage();
  for (; reading.damage < damage.size(); ++reading.damage) {
    const BagDamage& place = damage[reading.damage];
    damage_.push_back({place.offset, "of " + reading.part.path + ": " + place.what});
  }
}

bool JoinedRecordings::next(BagMessage& message) {
  if (given_ != nullptr) {
    advance(*std::exchange(given_, nullptr));
  }
  for (Reading& reading : readings_) {
    if (reading.message.connection != nullptr &&
        (given_ == nullptr || reading.message.time < given_->message.time)) {
      given_ = &reading;
    }
  }
  if (given_ == nullptr) {
    return false;
  }
  message = given_->message;
  return true;
}

std::uint64_t JoinedRecordings::position() const {
  return std::accumulate(readings_.begin(), readings_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const Reading& reading) {
                           return sum + reading.part.source->position();
                         });
}

std::uint64_t JoinedRecordings::length() const {
  return std::accumulate(readings_.begin(), readings_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const Reading& reading) {
                           return sum + reading.part.source->length();
                         });
}

std::string JoinedRecordings::compression() const {
  return readings_.front().part.source->compression();
}

std::uint64_t JoinedRecordings::fileSize() const {
  return std::accumulate(readings_.begin(), readings_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const Reading& reading) {
                           return sum + reading.part.source->fileSize();
                         });
}

bool JoinedRecordings::countsMessages() const {
  return std::all_of(readings_.begin(), readings_.end(),
                     [](const Reading& reading) { return reading.part.source->countsMessages(); });
}

bool JoinedRecordings::knowsExposures() const {
  return std::all_of(readings_.begin(), readings_.end(),
                     [](const Reading& reading) { return reading.part.source->knowsExposures(); });
}

std::optional<BiasConfiguration> JoinedRecordings::biases() const {
  for (const Reading& reading : readings_) {
    if (std::optional<BiasConfiguration> biases = reading.part.source->biases()) {
      return biases;
    }
  }
  return std::nullopt;
}

}  // namespace fast_edi

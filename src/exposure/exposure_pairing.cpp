#include "fast_edi/exposure/exposure_pairing.hpp"

#include <algorithm>

#include "fast_edi/base/parameter_ranges.hpp"
#include "fast_edi/base/types.hpp"

namespace fast_edi {
namespace {

/// No message arrives so early before its image; bounds the memory whatever the clock does.
constexpr std::size_t kMaxWaitingMessages = 100;

}  // namespace

ExposurePairing::ExposurePairing(std::int64_t timeout_ns, DeblurCounters& counters)
    : counters_(counters), timeout_ns_(timeout_ns) {}

std::optional<std::int64_t> ExposurePairing::read(std::int32_t exposure_us) {
  ++counters_.exposures_in;
  const std::int64_t length_ns = exposure_us * kNanosecondsPerMicrosecond;
  if (length_ns <= 0 || length_ns > kMaxExposure_ns) {
    ++counters_.exposures_refused;
    return std::nullopt;
  }
  last_ns_ = length_ns;
  return length_ns;
}

void ExposurePairing::note(std::int32_t exposure_us) {
  read(exposure_us);
}

void ExposurePairing::addImage(std::uint64_t image, std::int64_t now_ns,
                               std::vector<ExposureMatch>& matches) {
  if (!first_image_ns_) {
    first_image_ns_ = now_ns;
  }
  advance(now_ns, matches);
  if (without_messages_) {
    matches.push_back({image, std::nullopt});
    return;
  }
  if (isOneMessageAhead(now_ns)) {
    dropMessages(1);
  }
  last_image_ns_ = now_ns;
  if (messages_.empty()) {
    images_.push_back({image, now_ns});
  } else {
    matches.push_back({image, messages_.front().length_ns});
    messages_.pop_front();
  }
  updateUnmatched(now_ns);
}

void ExposurePairing::addMessage(std::int32_t exposure_us, std::int64_t now_ns,
                                 std::vector<ExposureMatch>& matches) {
  advance(now_ns, matches);
  const std::optional<std::int64_t> length_ns = read(exposure_us);
  any_received_ = true;
  if (without_messages_) {
    without_messages_ = false;
    return;
  }
  if (images_.empty()) {
    messages_.push_back({length_ns, now_ns});
    if (messages_.size() > kMaxWaitingMessages) {
      dropMessages(1);
    }
  } else {
    matches.push_back({images_.front().image, length_ns});
    images_.pop_front();
    ahead_since_ns_.reset();
  }
  updateUnmatched(now_ns);
}

void ExposurePairing::advance(std::int64_t now_ns, std::vector<ExposureMatch>& matches) {
  if (!any_received_ && !without_messages_ && first_image_ns_ &&
      now_ns - *first_image_ns_ >= timeout_ns_) {
    without_messages_ = true;
    dropImages(images_.size(), matches);
    restartUnmatched(now_ns);
  }
  const auto expired = [&](const auto& waiting) {
    return !waiting.empty() && now_ns - waiting.front().arrival_ns >= timeout_ns_;
  };
  while (expired(images_)) {
    dropImages(1, matches);
    restartUnmatched(now_ns);
  }
  while (expired(messages_)) {
    dropMessages(1);
    restartUnmatched(now_ns);
  }
  if (min_unmatched_ > 0 && now_ns - unmatched_since_ns_ >= timeout_ns_) {
    if (messages_.empty()) {
      dropImages(min_unmatched_, matches);
    } else {
      dropMessages(min_unmatched_);
    }
    restartUnmatched(now_ns);
  }
}

void ExposurePairing::finish(std::vector<ExposureMatch>& matches) {
  dropImages(images_.size(), matches);
  restart();
}

void ExposurePairing::restart() {
  images_.clear();
  messages_.clear();
  any_received_ = false;
  without_messages_ = false;
  first_image_ns_.reset();
  min_unmatched_ = 0;
  last_image_ns_.reset();
  ahead_since_ns_.reset();
}

void ExposurePairing::dropImages(std::size_t count, std::vector<ExposureMatch>& matches) {
  for (; count > 0; --count) {
    matches.push_back({images_.front().image, std::nullopt});
    images_.pop_front();
    ++counters_.exposures_missing;
  }
}

void ExposurePairing::dropMessages(std::size_t count) {
  for (; count > 0; --count) {
    messages_.pop_front();
    ++counters_.exposures_surplus;
  }
}

/// True when images have found an old message throughout a timeout. A message waits for an
/// image, and has waited for most of a period, when it belongs to the image before.
bool ExposurePairing::isOneMessageAhead(std::int64_t now_ns) {
  const bool old = !messages_.empty() && last_image_ns_ &&
                   2 * (now_ns - messages_.front().arrival_ns) > now_ns - *last_image_ns_;
  if (!old) {
    ahead_since_ns_.reset();
    return false;
  }
  if (!ahead_since_ns_) {
    ahead_since_ns_ = now_ns;
  }
  if (now_ns - *ahead_since_ns_ < timeout_ns_) {
    return false;
  }
  ahead_since_ns_.reset();
  return true;
}

/// Keeps min_unmatched_ up after images_ or messages_ changed by one.
void ExposurePairing::updateUnmatched(std::int64_t now_ns) {
  const std::size_t unmatched = images_.size() + messages_.size();
  if (unmatched > 0 && min_unmatched_ == 0) {
    unmatched_since_ns_ = now_ns;
    min_unmatched_ = unmatched;
  } else {
    min_unmatched_ = std::min(min_unmatched_, unmatched);
  }
}

void ExposurePairing::restartUnmatched(std::int64_t now_ns) {
  min_unmatched_ = images_.size() + messages_.size();
  unmatched_since_ns_ = now_ns;
}

}  // namespace fast_edi

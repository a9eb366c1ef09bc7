/// \file
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

/// More notes than this on the damage of a recording say nothing new.
constexpr std::size_t kMaxDamageNotes = 1000;

/// Adds a note, unless there are enough.
inline void noteDamage(std::vector<RecordingDamage>& notes, RecordingDamage damage) {
  if (notes.size() < kMaxDamageNotes) {
    notes.push_back(std::move(damage));
  }
}

}  // namespace fast_edi

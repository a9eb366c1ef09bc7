/// \file
/// Random numbers that are the same everywhere: the engine is fixed by the C++ standard, the
/// distributions are Boost's (those of the standard library differ between implementations).
#pragma once

#include <cstdint>
#include <random>

namespace fast_edi {

using RandomEngine = std::mt19937_64;

/// What random numbers are drawn for. Each purpose has its own stream, so that switching one
/// non-ideality on or off leaves the others as they were.
enum class RandomStream : std::uint32_t {
  kTexture = 1,
  kTags,
  kMotion,
  kThresholds,
  kInitialLevels,
  kHotPixels,
  kShotNoise,
  kFrameNoise,
  kRoom,
  kRoomMotion,
  kImu,
  kLamps,
};

/// An engine for one purpose; equal arguments give equal sequences.
RandomEngine makeRandomEngine(std::uint64_t seed, RandomStream stream);

}  // namespace fast_edi

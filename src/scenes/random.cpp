#include "scenes/random.hpp"

namespace fast_edi {

RandomEngine makeRandomEngine(std::uint64_t seed, RandomStream stream) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U),
                         static_cast<std::uint32_t>(stream)};
  return RandomEngine(sequence);
}

}  // namespace fast_edi

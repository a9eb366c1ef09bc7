#include "config/nearest_key.hpp"

#include <algorithm>
#include <cctype>

namespace fast_edi {
namespace {

constexpr std::size_t kInsertOrDelete = 2;
constexpr std::size_t kChangeCase = 1;

char lowered(char letter) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
}

std::size_t replacementCost(char a, char b) {
  if (a == b) {
    return 0;
  }
  return lowered(a) == lowered(b) ? kChangeCase : 2 * kInsertOrDelete;
}

}  // namespace

std::size_t editDistance(const std::string& a, const std::string& b) {
  // distances[j]: from the letters of a seen so far to the first j letters of b.
  std::vector<std::size_t> distances(b.size() + 1);
  for (std::size_t j = 0; j < distances.size(); ++j) {
    distances[j] = j * kInsertOrDelete;
  }
  for (const char letter : a) {
    std::size_t diagonal = distances[0];
    distances[0] += kInsertOrDelete;
    for (std::size_t j = 1; j < distances.size(); ++j) {
      const std::size_t kept = diagonal + replacementCost(letter, b[j - 1]);
      diagonal = distances[j];
      distances[j] =
          std::min({kept, distances[j] + kInsertOrDelete, distances[j - 1] + kInsertOrDelete});
    }
  }
  return distances.back();
}

std::string nearestKey(const std::string& key, const std::vector<std::string>& candidates) {
  return *std::min_element(candidates.begin(), candidates.end(),
                           [&key](const std::string& a, const std::string& b) {
                             return editDistance(key, a) < editDistance(key, b);
                           });
}

}  // namespace fast_edi

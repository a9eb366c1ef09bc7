/// \file
/// Guessing what a misspelt key was meant to be.
#pragma once

#include <string>
#include <vector>

namespace fast_edi {

/// Cost of turning \p a into \p b: 2 for each letter inserted or deleted, 1 for each that changes
/// between upper and lower case. (Keys are rather abbreviated than mistyped, so replacing a letter
/// costs as much as deleting and inserting one.)
std::size_t editDistance(const std::string& a, const std::string& b);

/// The candidate with the smallest edit distance; the first of several. \pre !candidates.empty()
std::string nearestKey(const std::string& key, const std::vector<std::string>& candidates);

}  // namespace fast_edi

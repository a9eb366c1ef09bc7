/// \file
/// Words as a line that can be pasted into a shell.
#pragma once

#include <string>
#include <vector>

namespace fast_edi {

/// Words with characters that a shell could take for something else stand in quotes.
std::string shellText(const std::vector<std::string>& words);

}  // namespace fast_edi

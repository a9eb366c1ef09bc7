/// \file
/// Whether a node that was loaded works as a new one does.
#pragma once

#include <string>

namespace fast_edi::load {

/// Plays a small recording to a node that is set to thresholds 0.3 and 0.25 and `filter: false`,
/// and compares what comes out with what a new pipeline makes of the same.
/// \param ns namespace of the topics
/// \param node its name
/// \return what differs; empty when each frame is the same bit for bit
std::string faultAfterLoad(const std::string& ns, const std::string& node);

}  // namespace fast_edi::load

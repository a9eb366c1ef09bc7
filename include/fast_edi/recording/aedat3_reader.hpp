/// \file
/// AEDAT 3.1, the format of cAER
/// (https://docs.inivation.com/software/software-advanced-usage/file-formats/aedat-3.1.html), of
/// DAVIS cameras.
///
/// Lines that begin with `#` up to `#!END-HEADER`, then packets of events of one kind. A frame has
/// start and end of its exposure. Event by event is read, so that no stated size makes room for a
/// packet.
#pragma once

#include <memory>
#include <string>

#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

/// \throws RecordingError when the file cannot be opened, its header does not end, or it was
///         recorded by a camera that is no DAVIS240 or DAVIS346
std::unique_ptr<Recording> openAedat3(const std::string& path);

}  // namespace fast_edi

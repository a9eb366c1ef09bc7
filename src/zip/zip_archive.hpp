/// \file
/// Zip archives, read member by member without unpacking anything to the disk.
#pragma once

#include <memory>
#include <string>

#include "recording/file_set.hpp"

namespace fast_edi {

/// The files of an archive; where all lie in one folder, those of that folder.
///
/// Members must be stored or deflated. One that states more than 200 times the bytes that it takes
/// in the archive, beyond 64 MiB, is refused: no recording is like that. Checksums are checked.
/// \throws RecordingError when \p path cannot be read as an archive
std::unique_ptr<FileSet> openZip(const std::string& path);

}  // namespace fast_edi

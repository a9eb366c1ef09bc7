/// Zip archives of pictures and text: the input is the file.
#include <cstddef>
#include <cstdint>

#include "fast_edi/pictures/picture_folder_reader.hpp"
#include "fuzz/recording_intake.hpp"

namespace {

const fast_edi::fuzzing::MemoryFile& inputFile() {
  static const fast_edi::fuzzing::MemoryFile file;
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  inputFile().fill(data, size);
  fast_edi::fuzzing::readTwice([] { return fast_edi::openPictureArchive(inputFile().path()); });
  return 0;
}

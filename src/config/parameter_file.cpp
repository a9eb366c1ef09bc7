#include "fast_edi/config/parameter_file.hpp"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw std::runtime_error("cannot write " + path + ": " + reason);
}

void writeText(const std::string& path, const std::string& text) {
  errno = 0;
  std::ofstream file(path, std::ios::trunc);
  file << text << std::flush;
  if (!file) {
    refuse(path, std::generic_category().message(errno));
  }
}

}  // namespace

ParameterFile::ParameterFile(const std::string& path)
    : path_(path), active_path_(path + ".active") {
  writeText(active_path_, "");
}

ParameterFile::~ParameterFile() {
  std::error_code ignored;
  fs::remove(active_path_, ignored);
}

void ParameterFile::write(const std::string& text) {
  writeText(active_path_, text);
  std::error_code error;
  fs::rename(active_path_, path_, error);
  if (error) {
    refuse(path_, error.message());
  }
}

}  // namespace fast_edi

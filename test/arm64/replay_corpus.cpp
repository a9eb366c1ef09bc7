/// Runs the fuzzer that it is linked with on each of the files named, without libFuzzer. What would
/// be a finding ends the program.
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    std::ifstream file(argv[i], std::ios::binary);
    if (!file) {
      std::cerr << "replay_corpus: " << argv[i] << ": cannot be opened\n";
      return 1;
    }
    const std::vector<char> content{std::istreambuf_iterator<char>(file), {}};
    std::cout << argv[i] << std::endl;  // before it can end the program
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(content.data()), content.size());
  }
  return argc > 1 ? 0 : 1;
}

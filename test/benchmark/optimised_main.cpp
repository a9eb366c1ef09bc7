#include "optimised_main.hpp"

#include <cstdio>
#include <cstdlib>

#include <benchmark/benchmark.h>

#if defined(__OPTIMIZE__) && defined(NDEBUG)
int runBenchmarks(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return EXIT_FAILURE;
  benchmark::AddCustomContext("compiler", __VERSION__);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return EXIT_SUCCESS;
}
#else
int runBenchmarks(int, char** argv) {
  std::fprintf(stderr,
               "%s was built without optimisation or with assertions; its figures would mean "
               "nothing. Build with -DCMAKE_BUILD_TYPE=Release.\n",
               argv[0]);
  return EXIT_FAILURE;
}
#endif

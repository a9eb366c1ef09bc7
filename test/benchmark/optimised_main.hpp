/// \file
/// main() of a benchmark program. Refuses to run unoptimised: such figures mislead.
#pragma once

/// Runs all registered benchmarks. \return the process's exit code
int runBenchmarks(int argc, char** argv);

/// \file
/// Loops that gain from wider vector registers are compiled twice, for every x86-64 and for those
/// with AVX2; which one runs is decided when the program starts. Both do the same operations
/// element by element, without contraction, so results are the same bit for bit.
#pragma once

// Sanitizers instrument the code that picks the version before they are ready for it.
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(FAST_EDI_SCALAR)
#define FAST_EDI_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define FAST_EDI_VECTOR_CLONES
#endif

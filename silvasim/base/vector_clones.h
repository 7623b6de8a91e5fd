// SILVA_VECTOR_CLONES before a function compiles it twice, for any x86-64 and for one with AVX2, and the loader takes the
// one that the machine can run. Both give the same bits: no fused multiply-add is among AVX2, and none of the loops sums.
//
// For free functions that are plain loops over columns; what they call must be inline. Elsewhere it says nothing.
#pragma once

// Sanitizers are not ready yet when the loader asks which clone to take.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define SILVA_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define SILVA_VECTOR_CLONES
#endif

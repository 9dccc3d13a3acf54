// SPDX-License-Identifier: Apache-2.0
// Loops over lanes for the registers of the machine that runs them.
#pragma once

/// Before a function: compiled a second time for AVX2, the choice made once when the program is loaded. Both
/// give the same bits, since no build fuses multiply-adds. Sanitizers cannot be there yet when it is made;
/// with clang it is untried.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__clang__)
#define SPECTRACE_WIDE __attribute__((target_clones("default", "avx2")))
#define SPECTRACE_HAS_WIDE 1
#else
#define SPECTRACE_WIDE
#endif

namespace spectrace {

/// What those loops run with here: "AVX2", ...
inline const char* instruction_set() {
#ifdef SPECTRACE_HAS_WIDE
  if (__builtin_cpu_supports("avx2")) return "AVX2";
#endif
#if defined(__AVX512F__)
  return "AVX-512";
#elif defined(__AVX2__)
  return "AVX2";
#elif defined(__SSE4_2__)
  return "SSE4.2";
#elif defined(__SSE2__)
  return "SSE2";
#elif defined(__ARM_NEON)
  return "NEON";
#else
  return "scalar";
#endif
}

}  // namespace spectrace

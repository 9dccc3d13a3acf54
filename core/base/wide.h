// SPDX-License-Identifier: Apache-2.0
// Loops over lanes for the registers of the machine that runs them.
#pragma once

/// Before a function: compiled a second time for AVX2, the choice made once when the program is loaded. Both
/// give the same bits, since no build fuses multiply-adds. Sanitizers cannot be there yet when it is made;
/// with clang it is untried.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__clang__)
#define SPECTRACE_WIDE __attribute__((target_clones("default", "avx2")))
#else
#define SPECTRACE_WIDE
#endif

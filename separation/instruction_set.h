// SPDX-License-Identifier: Apache-2.0
// Inner loops compiled for several instruction sets, the widest that the processor has chosen at run time.
#pragma once

/// On a lambda given to run_kernel(), and on what its loops call.
#define SPECTRACE_KERNEL __attribute__((always_inline))

namespace spectrace {

enum class InstructionSet { kBaseline, kAvx2, kAvx512 };
/// The widest that this processor has.
InstructionSet widest_instruction_set();

#if defined(__x86_64__)
template <typename F>
__attribute__((target("avx2"), noinline)) void run_with_avx2(const F& kernel) {
  kernel();
}
template <typename F>
__attribute__((target("avx512f,avx512vl,avx512dq,avx512bw"), noinline)) void run_with_avx512(
    const F& kernel) {
  kernel();
}
#endif

/// Calls `kernel`, a lambda marked SPECTRACE_KERNEL, in code of its own for each instruction set. The results
/// have the same bits on each of them as long as no sum runs across the lanes of a vector: nothing is
/// contracted or reordered (cmake/SpectraceOptions.cmake).
template <typename F>
void run_kernel(const F& kernel) {
#if defined(__x86_64__)
  static const InstructionSet set = widest_instruction_set();
  if (set == InstructionSet::kAvx512) return run_with_avx512(kernel);
  if (set == InstructionSet::kAvx2) return run_with_avx2(kernel);
#endif
  kernel();
}

}  // namespace spectrace

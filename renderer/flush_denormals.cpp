// SPDX-License-Identifier: Apache-2.0
#include "renderer/flush_denormals.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace spectrace {

#if defined(__SSE2__)
namespace {
constexpr unsigned kFlushBits = 0x8040;  // MXCSR: flush to zero (15), denormals are zero (6)
}
FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | kFlushBits); }
FlushDenormals::~FlushDenormals() { _mm_setcsr(saved_); }
#else
FlushDenormals::FlushDenormals() : saved_(0) {}
FlushDenormals::~FlushDenormals() = default;
#endif

}  // namespace spectrace

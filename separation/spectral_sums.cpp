// SPDX-License-Identifier: Apache-2.0
#include "separation/spectral_sums.h"

#include "separation/fast_log.h"
#include "separation/instruction_set.h"

namespace spectrace {
namespace {

/// Whatever runs over k is one register: no sum crosses lanes, so the bits do not depend on its width.
SPECTRACE_KERNEL inline LogRootSums<float> root_sums_inline(const StripProblem& p, const CellRange& cells,
                                                            const Strip& s) {
  LogRootSums<float> sums;
  for (std::size_t i = cells.first; i < cells.end; i += cells.stride) {
    const float a = p.diffuse[i], b = p.specular[i];
    const float* const data = p.log_data + i * kStrip;
    for (std::size_t k = 0; k < kStrip; ++k) {
      const float specular = s[k] * b, model = p.s_d[k] * a + p.epsilon + specular;
      const float r = data[k] - fast_log(model), u = specular / model;
      const float square = u * u, v = u - square, rv = r * v;  // u' = u (1 - u)
      sums.gradient[k] += r * u;
      sums.slope[k] += rv - square;
      sums.curvature[k] += rv - u * (2 * rv + 3 * v);
      sums.information[k] += square;
    }
  }
  return sums;
}

}  // namespace

CellRange cells_of_group(const CellTable& table, std::size_t group, std::size_t stride) {
  const std::size_t begin = table.begin[group];
  return {.first = (begin + stride - 1) / stride * stride, .end = table.begin[group + 1], .stride = stride};
}

LogRootSums<float> root_sums(const StripProblem& problem, const CellRange& cells, const Strip& s) {
  LogRootSums<float> sums;
  run_kernel([&]() SPECTRACE_KERNEL { sums = root_sums_inline(problem, cells, s); });
  return sums;
}

GroupSolution solve_group(const StripProblem& problem, const CellRange& cells, const Strip& towards,
                          int count, float prior, const Strip& highest) {
  GroupSolution result;
  run_kernel([&]() SPECTRACE_KERNEL {
    LogRoot root(towards, count, prior, problem.epsilon, highest);
    while (!root.done()) root.step(root_sums_inline(problem, cells, root.at()));
    result = {.s = root.result(), .unfinished = root.unfinished()};
  });
  return result;
}

std::array<Strip, 3> squares(const StripProblem& p, const CellRange& cells, const std::array<Strip, 3>& s) {
  std::array<Strip, 3> sums{};
  run_kernel([&]() SPECTRACE_KERNEL {
    for (std::size_t i = cells.first; i < cells.end; i += cells.stride) {
      const float a = p.diffuse[i], b = p.specular[i];
      const float* const data = p.log_data + i * kStrip;
      for (std::size_t m = 0; m < 3; ++m) {
        for (std::size_t k = 0; k < kStrip; ++k) {
          const float r = data[k] - fast_log(p.s_d[k] * a + p.epsilon + s[m][k] * b);
          sums[m][k] += r * r;
        }
      }
    }
  });
  return sums;
}

TwoLobeTerms two_lobe_terms(const StripProblem& p, const CellRange& cells, const Strip& s_d,
                            const Strip& s_s) {
  TwoLobeTerms t;
  run_kernel([&]() SPECTRACE_KERNEL {
    for (std::size_t i = cells.first; i < cells.end; i += cells.stride) {
      const float a = p.diffuse[i], b = p.specular[i];
      const float* const data = p.log_data + i * kStrip;
      for (std::size_t k = 0; k < kStrip; ++k) {
        const float model = s_d[k] * a + s_s[k] * b + p.epsilon, inverse = 1 / model;
        const float r = data[k] - fast_log(model), d = a * inverse, s = b * inverse;
        const float dd = d * d, ds = d * s, ss = s * s;
        t.rr[k] += r * r;
        t.r_d[k] += r * d, t.r_s[k] += r * s;
        t.dd[k] += dd, t.ds[k] += ds, t.ss[k] += ss;
        t.r_dd[k] += r * dd, t.r_ds[k] += r * ds, t.r_ss[k] += r * ss;
      }
    }
  });
  return t;
}

}  // namespace spectrace

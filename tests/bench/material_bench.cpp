// SPDX-License-Identifier: Apache-2.0
// How long one evaluation of a material takes, in each of its forms; and a separation.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>

#include "separation/compact.h"
#include "tests/bench/bench_materials.h"

namespace spectrace::bench {
namespace {

constexpr int kRepetitions = 5;    // of which the median counts
constexpr std::size_t kAhead = 8;  // a path has its vertex in the first cache; only tables may miss
constexpr double kSecondsPerRepetition = 0.1;

/// Calls `work(material, vertex)` on one vertex after another.
template <typename Work>
void over_vertices(benchmark::State& state, Axis axis, const std::string& form, const Work& work) {
  const Material& subject = material(axis, form);
  const std::vector<Vertex>& all = vertices();
  std::size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    const Vertex& v = all[i];
    i = i + 1 < all.size() ? i + 1 : 0;
    __builtin_prefetch(&all[(i + kAhead) % all.size()]);
    benchmark::DoNotOptimize(work(subject, v));
  }
}

std::string name_of_run(const std::string& what, Axis axis, const std::string& form) {
  return what + "/" + std::string(name_of(axis)) + "/" + form;
}

template <typename Work>
void add(const std::string& what, const Work& work) {
  for (const Axis axis : kAxes) {
    for (const std::string& form : forms()) {
      benchmark::RegisterBenchmark(
          name_of_run(what, axis, form).c_str(),
          [axis, form, work](benchmark::State& state) { over_vertices(state, axis, form, work); })
          ->MinTime(kSecondsPerRepetition)
          ->Repetitions(kRepetitions)
          ->ReportAggregatesOnly();
    }
  }
}

const auto kEvaluate = [](const Material& m, const Vertex& v) {
  return evaluate(m, v.wo, v.wi, {.lambda = v.lambda});
};
const auto kEvaluateLobes = [](const Material& m, const Vertex& v) {
  return evaluate_lobes(m, v.wo, v.wi, {.lambda = v.lambda});
};
const auto kSample = [](const Material& m, const Vertex& v) {
  return sample(m, v.wo, v.random, {.lambda = v.lambda});
};

void separation(benchmark::State& state, Axis axis) {
  const MeasuredBrdf measured(measured_tables(axis));
  SilentProgress progress;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(separate(measured, {}, progress));
  }
}

void compaction(benchmark::State& state, Axis axis) {
  SilentProgress progress;
  const SeparationResult result = separate(MeasuredBrdf(measured_tables(axis)), {}, progress);
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(compact_to_tensors(compact(result.tables, kDefaultQuality).tables));
  }
}

void add_whole(const std::string& what, void (*work)(benchmark::State&, Axis)) {
  for (const Axis axis : kAxes) {
    benchmark::RegisterBenchmark((what + "/" + std::string(name_of(axis))).c_str(),
                                 [axis, work](benchmark::State& state) { work(state, axis); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime()
        ->MeasureProcessCPUTime()
        ->Iterations(1)
        ->Repetitions(kRepetitions)
        ->ReportAggregatesOnly();
  }
}

/// Prints as usual, and remembers the medians.
class MedianReporter : public benchmark::ConsoleReporter {
 public:
  MedianReporter() : ConsoleReporter(OO_Tabular) {}
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.aggregate_name == "median") median_cpu_[run.run_name.function_name] = run.GetAdjustedCPUTime();
    }
    ConsoleReporter::ReportRuns(runs);
  }
  /// 0 where it did not run.
  [[nodiscard]] double median_cpu(const std::string& name) const {
    const auto it = median_cpu_.find(name);
    return it == median_cpu_.end() ? 0 : it->second;
  }

 private:
  std::map<std::string, double> median_cpu_;
};

void print_ratios(const MedianReporter& reporter) {
  std::printf("\n%-42s %10s %12s\n", "median of CPU time", "[ns]", "to raw");
  for (const char* const what : {"evaluate", "evaluate_lobes", "sample"}) {
    for (const Axis axis : kAxes) {
      const double raw = reporter.median_cpu(name_of_run(what, axis, std::string(kRaw)));
      for (const std::string& form : forms()) {
        const std::string name = name_of_run(what, axis, form);
        const double ns = reporter.median_cpu(name);
        if (raw > 0 && ns > 0) std::printf("%-42s %10.1f %12.3f\n", name.c_str(), ns, ns / raw);
      }
    }
  }
}

}  // namespace
}  // namespace spectrace::bench

int main(int argc, char** argv) {
  using namespace spectrace::bench;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  for (const Axis axis : kAxes) {
    benchmark::AddCustomContext("material, " + std::string(name_of(axis)), source_of(axis));
  }
  add("evaluate", kEvaluate);
  add("evaluate_lobes", kEvaluateLobes);
  add("sample", kSample);
  add_whole("separation", separation);
  add_whole("compaction", compaction);
  MedianReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  print_ratios(reporter);
  benchmark::Shutdown();
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "renderer/partial_render.h"
#include "renderer/provenance.h"

namespace spectrace {

namespace {

namespace fs = std::filesystem;

std::string describe(SampleRange range) { return fmt::format("{}:{}", range.first, range.last); }

/// Parts joined as they come to those they touch, so that in order of their samples no more than two are
/// held.
class MergedRuns {
 public:
  void add(const fs::path& file, PartialRender part) {
    const std::uint64_t first = part.film.target().first;
    const auto after = runs_.upper_bound(first);
    const auto before = after == runs_.begin() ? runs_.end() : std::prev(after);
    Run run{file, file, std::move(part)};
    if (before != runs_.end()) refuse_overlap(before->second, run);
    if (after != runs_.end()) refuse_overlap(run, after->second);
    auto it = runs_.emplace(first, std::move(run)).first;
    if (before != runs_.end() && joins(before->second, it->second)) {
      runs_.erase(it);
      it = before;
    }
    if (after != runs_.end() && joins(it->second, after->second)) runs_.erase(after);
  }
  [[nodiscard]] PartialRender whole() {
    const auto first = runs_.begin(), second = std::next(first);
    if (second != runs_.end()) {
      const SampleRange missing{first->second.range().last, second->second.range().first};
      throw InputError(second->second.first_file.string(), "",
                       fmt::format("samples {} are missing before its first", describe(missing)));
    }
    return std::move(first->second.partial);
  }

 private:
  struct Run {
    fs::path first_file, last_file;
    PartialRender partial;
    [[nodiscard]] SampleRange range() const { return partial.film.target(); }
  };

  static void refuse_overlap(const Run& before, const Run& next) {
    if (next.range().first >= before.range().last) return;
    throw InputError(next.first_file.string(), "",
                     fmt::format("samples {} overlap with samples {} of {}", describe(next.range()),
                                 describe(before.range()), before.last_file.string()));
  }
  /// Appends `next` where it begins at the end of `run`.
  static bool joins(Run& run, const Run& next) {
    if (run.range().last != next.range().first) return false;
    run.partial.film.append(next.partial.film);
    run.partial.metadata = joined_provenance(std::move(run.partial.metadata), next.partial.metadata);
    run.last_file = next.last_file;
    return true;
  }

  std::map<std::uint64_t, Run> runs_;  // by first sample
};

}  // namespace

PartialRender merge_partials(const std::vector<fs::path>& files) {
  SPECTRACE_CHECK(!files.empty());
  MergedRuns runs;
  std::optional<RenderIdentity> identity;
  std::optional<FilmLayout> layout;
  int width = 0, height = 0;
  for (const fs::path& file : files) {
    PartialRender part = read_partial(file);
    if (!identity) {
      identity = part.identity;
      layout = part.film.layout();
      width = part.film.width();
      height = part.film.height();
    }
    check_same_image(part, file, *identity, width, height, *layout);
    if (!part.film.is_complete()) {
      throw InputError(file.string(), "", "is not complete: go on with it first (--resume)");
    }
    runs.add(file, std::move(part));
  }
  return runs.whole();
}

}  // namespace spectrace

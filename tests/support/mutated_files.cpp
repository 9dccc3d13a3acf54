// SPDX-License-Identifier: Apache-2.0
#include "tests/support/mutated_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <mutex>
#include <regex>
#include <set>
#include <thread>

#include "core/image/image.h"
#include "materials/tensor_file.h"
#include "tests/support/mutator.h"
#include "tests/support/readable_inputs.h"
#include "tests/support/run_program.h"

namespace spectrace::test {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kAtOnce = 4;
/// Hundreds of times what any of these runs takes: beyond it a run is taken for one without end.
constexpr const char* kEndlessSeconds = "120";
constexpr int kKilled = 128 + 9;
constexpr const char* kOld = "an old output";

/// What is wrong with the answer to one damaged file; empty: nothing.
class Verdict {
 public:
  Verdict(const Reading& reading, const fs::path& folder, const ProgramResult& result)
      : reading_(reading), folder_(folder), result_(result) {}

  [[nodiscard]] std::string problem(const Files& before, const Files& after) const {
    const bool is_success = result_.exit_code == 0 || (reading_.may_differ && result_.exit_code == 1);
    if (result_.exit_code == kKilled) return "does not end";
    if (is_success) return problem_of_outputs(before, after);
    if (result_.exit_code != 3) return fmt::format("exit code {}", result_.exit_code);
    if (after != before) return "refused, but another content in the folder";
    return problem_of_message();
  }

 private:
  [[nodiscard]] bool names_place(const std::string& line) const {
    static const std::regex kJsonPlace(R"([^:]*:\d+:\d+: .*)");
    const bool is_first = line.starts_with(reading_.damaged);
    if (reading_.damaged.ends_with(".json")) {
      if (is_first) return std::regex_match(line, kJsonPlace);
      // Other files, where a damaged scene says of them what they are not.
      return std::any_of(reading_.files.begin(), reading_.files.end(),
                         [&](const std::string& name) { return line.starts_with(name); });
    }
    // Or the place in the scene that names it first.
    return is_first || line.find(": " + reading_.damaged + ":") != std::string::npos;
  }

  /// One line a mistake.
  [[nodiscard]] std::string problem_of_message() const {
    constexpr std::size_t kLongestLine = 1500;  // three parts and what joins them
    const std::vector<std::string> lines = result_.error_lines();
    if (lines.empty()) return "no message";
    if (lines.size() > 1 && !reading_.lists_mistakes) return "more than one line";
    for (const std::string& line : lines) {
      if (line.size() > kLongestLine) return fmt::format("a line of {} characters", line.size());
      if (!names_place(line)) return "names neither file nor place";
    }
    return "";
  }

  [[nodiscard]] std::string problem_of_outputs(const Files& before, const Files& after) const {
    for (const auto& [name, content] : after) {
      const auto old = before.find(name);
      if (old != before.end() && old->second == content) continue;
      if (std::find(reading_.outputs.begin(), reading_.outputs.end(), name) == reading_.outputs.end()) {
        return fmt::format("left {} behind", name);
      }
      try {
        if (const std::string wrong = problem_of_file(folder_ / name); !wrong.empty()) return wrong;
      } catch (const std::exception& e) {
        return fmt::format("wrote {}, which cannot be read: {}", name, e.what());
      }
    }
    return "";
  }

  static std::string problem_of_file(const fs::path& file) {
    if (file.extension() == ".exr" || file.extension() == ".png") {
      for (const float value : read_image(file).data) {
        if (!std::isfinite(value)) return fmt::format("{} holds {}", file.filename().string(), value);
      }
    } else {
      (void)TensorFile::read(file);
    }
    return "";
  }

  const Reading& reading_;
  const fs::path& folder_;
  const ProgramResult& result_;
};

class Campaign {
 public:
  Campaign(FileKind kind, std::uint64_t first_seed, std::size_t count)
      : readings_(write_readable_inputs(kind, whole_.path())), first_seed_(first_seed), count_(count) {}

  MutationTally run() {
    expect_whole_ones_pass();
    std::vector<std::thread> workers;
    for (std::size_t i = 0; i < kAtOnce; ++i) workers.emplace_back([this] { work(); });
    for (std::thread& worker : workers) worker.join();
    return std::move(tally_);
  }

 private:
  void work() {
    const TemporaryFolder folder;
    fs::copy(whole_.path(), folder.path(), fs::copy_options::recursive);
    for (std::size_t i = next_++; i < count_; i = next_++) {
      const std::uint64_t seed = first_seed_ + i;
      const Reading& reading = readings_[i % readings_.size()];
      try {
        try_one(reading, seed, folder);
      } catch (const std::exception& e) {
        const std::lock_guard lock(mutex_);
        tally_.failures.push_back(fmt::format("seed {}: {}", seed, e.what()));
      }
    }
  }

  /// Else all that is tested is how one mistake of ours is refused.
  void expect_whole_ones_pass() {
    const TemporaryFolder folder;
    fs::copy(whole_.path(), folder.path(), fs::copy_options::recursive);
    for (const Reading& reading : readings_) {
      const ProgramResult result = run_spectrace(reading.command, folder.path());
      if (result.exit_code == 0 || (reading.may_differ && result.exit_code == 1)) continue;
      tally_.failures.push_back(fmt::format("{}, undamaged: exit code {}\n{}",
                                            fmt::join(reading.command, " "), result.exit_code,
                                            result.errors));
    }
  }

  void try_one(const Reading& reading, std::uint64_t seed, const TemporaryFolder& folder) {
    Mutator mutator(seed);
    const std::string whole = read_text(whole_ / reading.damaged);
    const std::string damaged = reading.is_text ? mutator.mutate_text(whole) : mutator.mutate_binary(whole);
    for (const std::string& output : reading.outputs) write_text(folder / output, kOld);
    write_text(folder / reading.damaged, damaged);  // which --resume takes for its output as well
    const Files before = files_in(folder.path());

    std::vector<std::string> words{"-s", "KILL", kEndlessSeconds, SPECTRACE_BINARY};
    words.insert(words.end(), reading.command.begin(), reading.command.end());
    const auto start = std::chrono::steady_clock::now();
    const ProgramResult result = run_program("/usr/bin/timeout", words, folder.path());
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;

    const Files after = files_in(folder.path());
    const std::string problem = Verdict(reading, folder.path(), result).problem(before, after);
    restore(folder, after);
    const std::lock_guard lock(mutex_);
    tally_.longest_s = std::max(tally_.longest_s, seconds.count());
    (result.exit_code == 3 ? tally_.refused : tally_.harmless) += 1;
    if (!problem.empty()) {
      tally_.failures.push_back(fmt::format("seed {}, {}: {}\n{}", seed, fmt::join(reading.command, " "),
                                            problem, result.errors.substr(0, 1000)));
    }
  }

  /// To what it was for the next one.
  void restore(const TemporaryFolder& folder, const Files& files) const {
    for (const auto& [name, content] : files) {
      const fs::path original = whole_ / name;
      if (!fs::exists(original)) {
        fs::remove(folder / name);
      } else {
        fs::copy_file(original, folder / name, fs::copy_options::overwrite_existing);
      }
    }
  }

  TemporaryFolder whole_;
  std::vector<Reading> readings_;
  std::uint64_t first_seed_;
  std::size_t count_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;
  MutationTally tally_;
};

}  // namespace

MutationTally run_on_mutated(FileKind kind, std::uint64_t first_seed, std::size_t count) {
  return Campaign(kind, first_seed, count).run();
}

}  // namespace spectrace::test

// SPDX-License-Identifier: Apache-2.0
#include "tests/support/run_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <sstream>
#include <system_error>
#include <thread>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX asks the user to declare it

namespace spectrace::test {
namespace {

void check(int error, const char* what) {
  if (error != 0) throw std::system_error(error, std::generic_category(), what);
}

class FileActions {
 public:
  FileActions() { check(posix_spawn_file_actions_init(&actions_), "posix_spawn_file_actions_init"); }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;

  void open(int descriptor, const std::filesystem::path& file, int flags) {
    constexpr mode_t kOwnerReadsAndWrites = 0600;
    check(posix_spawn_file_actions_addopen(&actions_, descriptor, file.c_str(), flags, kOwnerReadsAndWrites),
          "posix_spawn_file_actions_addopen");
  }
  void change_folder(const std::filesystem::path& folder) {
    check(posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str()),
          "posix_spawn_file_actions_addchdir_np");
  }
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

}  // namespace

std::vector<std::string> ProgramResult::error_lines() const {
  std::vector<std::string> lines;
  std::istringstream stream(errors);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

ProgramResult run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                          const std::filesystem::path& folder, const std::filesystem::path& output_to,
                          DelayedSignal signal) {
  const TemporaryFolder streams;
  const std::filesystem::path out = output_to.empty() ? streams / "out" : output_to;
  FileActions actions;
  actions.open(STDIN_FILENO, "/dev/null", O_RDONLY);
  actions.open(STDOUT_FILENO, out, O_WRONLY | O_CREAT);
  actions.open(STDERR_FILENO, streams / "err", O_WRONLY | O_CREAT);
  if (!folder.empty()) actions.change_folder(folder);

  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  pid_t child = 0;
  check(posix_spawn(&child, program.c_str(), actions.get(), nullptr, argv.data(), environ), "posix_spawn");
  if (signal.signal != 0) {
    constexpr int kMostPolls = 3000;  // half a minute
    for (int i = 0;
         i < kMostPolls && !signal.after_file.empty() && !std::filesystem::exists(signal.after_file); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(signal.after_ms));
    kill(child, signal.signal);  // it may have ended: until it is waited for, its number is no one else's
  }
  int status = 0;
  while (waitpid(child, &status, 0) == -1) {
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "waitpid");
  }
  ProgramResult result;
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  if (output_to.empty()) result.output = read_text(out);
  result.errors = read_text(streams / "err");
  return result;
}

}  // namespace spectrace::test

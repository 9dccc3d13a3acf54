// SPDX-License-Identifier: Apache-2.0
// A disk that is full, or becomes so in the middle of a file: one line, what was there before is still there.
#include <sys/mount.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "tests/cli/program.h"

namespace spectrace::test {
namespace {

/// Inputs beside a folder "disk", in which every command writes its output.
class FullDisk : public Program {
 protected:
  void SetUp() override {
    write_lambert_scene("ball.json");
    const std::string film = R"("film": {"width": 16, "height": 16)";
    std::string spectral = read_text(folder_ / "ball.json");
    spectral.insert(spectral.find(film) + film.size(), R"(, "spectral": {"bins": 8})");
    write_text(folder_ / "spectral.json", spectral);
    write_measured("m.bsdf");
    std::filesystem::create_directory(folder_ / "measured");
    std::filesystem::copy(folder_ / "m.bsdf", folder_ / "measured");
    ASSERT_EQ(run({"ball.json", "-o", "part.exr", "--samples", "0:8"}).exit_code, 0);
    ASSERT_EQ(run({"ball.json", "-o", "other.exr", "--seed", "1"}).exit_code, 0);
    std::filesystem::create_directory(disk());
  }
  [[nodiscard]] std::filesystem::path disk() const { return folder_ / "disk"; }

  using Commands = std::vector<std::vector<std::string>>;

  /// One for each kind of file that the program writes.
  static Commands commands() {
    Commands all{
        {"ball.json", "-o", "disk/ball.exr"},
        {"spectral.json", "-o", "disk/spectral.exr"},
        {"ball.json", "-o", "disk/cut.exr", "--samples", "0:8"},
        {"ball.json", "-o", "disk/kept.exr", "--checkpoint", "3600"},
        {"merge", "part.partial", "-o", "disk/merged.exr"},
        {"separate", "m.bsdf", "-o", "disk/m.sep"},
        {"acquire", (kScenes / "materials" / "pearlescent.json").string(), "-o", "disk/p.bsdf",
         "--elevations", "6", "--table", "6"},
        {"compare", "part.exr", "other.exr", "--html", "disk/page.html"},
        {"compare", "part.exr", "other.exr", "--maps", "disk/maps"},
        {"sheet", "disk/sheet.png", "part.exr", "other.exr"},
    };
    return on_small_grid(all);
  }
  /// Whose files may be so small that they fit where little is left, or whose figures are new ones each time.
  static Commands reports() {
    return on_small_grid({
        {"compare", "part.exr", "other.exr", "--json", "disk/figures.json"},
        {"compare", "disk/reference.exr", "other.exr", "--update"},
        {"bench", "ball.json", "--spp", "8", "--json", "disk/bench.json"},
        {"separate", "m.bsdf", "-o", "kept.sep", "--report", "disk/separation.json"},
        {"cost", "ball.json", "-o", "disk/cost", "--budget", "1"},
        {"reproduce", "measured", "-o", "disk/report", "--spp", "1", "--height", "11"},
    });
  }
  static Commands on_small_grid(Commands all) {
    for (std::vector<std::string>& arguments : all) {
      if (arguments[0] != "separate" && arguments[0] != "reproduce") continue;
      arguments.insert(arguments.end(), kSmallGrid.begin(), kSmallGrid.end());
    }
    return all;
  }

  /// `run_one` fails on every command, with one line and exit code 3 or 4, and changes nothing on the disk.
  template <typename Run>
  void expect_nothing_lost(const Commands& all, const Run& run_one) const {
    const Files before = files_in(disk());
    for (const std::vector<std::string>& arguments : all) {
      const std::string named = arguments[0] + ' ' + arguments[1] + ' ' + arguments[2];
      const ProgramResult result = run_one(arguments);
      EXPECT_EQ(result.signal, 0) << named;
      EXPECT_TRUE(result.exit_code == 3 || result.exit_code == 4) << named << ": " << result.exit_code;
      EXPECT_EQ(result.error_lines().size(), 1U) << named << '\n' << result.errors;
      EXPECT_TRUE(result.complains("disk/")) << named << '\n' << result.errors;
      EXPECT_EQ(files_in(disk()), before) << named << ": another content";
    }
  }
  void write_all_once(const Commands& all) const {
    for (const std::vector<std::string>& arguments : all) {
      const ProgramResult result = run(arguments);
      ASSERT_LE(result.exit_code, 1) << result.errors;  // 1: the images differ
    }
    ASSERT_GE(files_in(disk()).size(), all.size());
  }
};

/// Writing beyond a size fails as it does on a full disk, and needs no rights.
TEST_F(FullDisk, AFileThatMayNotGrowLeavesTheOneBeforeIntact) {
  write_all_once(commands());
  expect_nothing_lost(commands(), [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> limited{"-c", "trap '' XFSZ; ulimit -f 1; exec \"$@\"", "sh", SPECTRACE_BINARY};
    limited.insert(limited.end(), arguments.begin(), arguments.end());
    return run_program("/bin/sh", limited, folder_.path());
  });
}

/// A file system in memory over the folder, which goes with this object.
class SmallDisk {
 public:
  SmallDisk(const std::filesystem::path& folder, const char* options)
      : folder_(folder), error_(::mount("tmpfs", folder.c_str(), "tmpfs", 0, options) == 0 ? 0 : errno) {}
  ~SmallDisk() {
    if (error_ == 0) ::umount2(folder_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  [[nodiscard]] int error() const { return error_; }

  /// Fills it but for `left` bytes.
  void fill(std::uintmax_t left) const {
    const std::uintmax_t free = std::filesystem::space(folder_).available;
    ASSERT_GT(free, left);
    std::ofstream(folder_ / "filler", std::ios::binary) << std::string(std::size_t(free - left), 'x');
    ASSERT_EQ(std::filesystem::space(folder_).available, left);
  }

 private:
  std::filesystem::path folder_;
  int error_;
};

TEST_F(FullDisk, ADiskThatBecomesFullLeavesWhatWasThereIntact) {
  const SmallDisk small(disk(), "size=16m");
  if (small.error() != 0) {
    GTEST_SKIP() << "mounting a small disk needs root: " << std::system_category().message(small.error());
  }
  write_all_once(commands());
  const auto put_reference = [&] {
    std::filesystem::copy(folder_ / "part.exr", disk() / "reference.exr",
                          std::filesystem::copy_options::overwrite_existing);
  };
  put_reference();
  write_all_once(reports());
  put_reference();  // so that it is another picture again
  const auto run_one = [&](const std::vector<std::string>& arguments) { return run(arguments); };
  small.fill(0);
  expect_nothing_lost(commands(), run_one);
  expect_nothing_lost(reports(), run_one);

  constexpr std::uintmax_t kPage = 4096;  // what the file system gives out: less than most files need
  std::filesystem::remove(disk() / "filler");
  small.fill(kPage);
  Commands larger = commands();
  std::erase_if(larger, [](const std::vector<std::string>& command) {
    return command[0] == "compare" || command[0] == "sheet";
  });
  expect_nothing_lost(larger, run_one);
}

}  // namespace
}  // namespace spectrace::test

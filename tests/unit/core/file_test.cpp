// SPDX-License-Identifier: Apache-2.0
#include "core/base/file.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace spectrace {
namespace {

using test::read_text;
using test::TemporaryFolder;
using test::write_text;

std::string hex_of(std::string_view text) { return sha256_hex(std::as_bytes(std::span(text))); }

/// Runs `work` in a child process, whose limits, mounts and user may change; its exit code.
int run_in_child(const std::function<int()>& work) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(work());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}
enum ChildResult : int {
  kRefusedAndKept,
  kNotRefused,
  kWrongMessage,
  kOldFileLost,
  kLeftovers,
  kCannotSetUp
};

/// Tries to write 1 MB over an old file, which must be refused and leave all as it was.
int overwrite_must_fail(const std::filesystem::path& file) {
  const std::string old = read_text(file);
  const std::string text(1 << 20, 'x');
  try {
    write_file_atomically(file, text);
    return kNotRefused;
  } catch (const InputError& error) {
    if (std::string_view(error.what()).find(file.string() + ": cannot write: ") != 0) return kWrongMessage;
  }
  if (read_text(file) != old) return kOldFileLost;
  const std::filesystem::directory_iterator left(file.parent_path());
  return std::distance(begin(left), end(left)) == 1 ? kRefusedAndKept : kLeftovers;
}

// FIPS 180-4's own examples (NIST CAVP, "SHA256ShortMsg") and every length around the padding's edges: the
// digests of 'a' repeated were computed with Python's hashlib.
TEST(Sha256, AgreesWithPublishedDigests) {
  EXPECT_EQ(hex_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hex_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hex_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(hex_of(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(hex_of(std::string(55, 'a')), "9f4390f8d30c2dd92ec9f095b65e2b9ae9b0a925a5258e241c9f1e910f734318");
  EXPECT_EQ(hex_of(std::string(56, 'a')), "b35439a4ac6f0948b6d6f9e3c6af0f5f590ce20f1bde7090ef7970686ec6738a");
  EXPECT_EQ(hex_of(std::string(63, 'a')), "7d3e74a05d7db15bce4ad9ec0658ea98e3f06eeecf16b4c6fff2da457ddc2f34");
  EXPECT_EQ(hex_of(std::string(64, 'a')), "ffe054fe7ae0cb6dc65c3af9b61d5209f439851db43d0ba5997337df154668eb");
  EXPECT_EQ(hex_of(std::string(119, 'a')),
            "31eba51c313a5c08226adf18d4a359cfdfd8d2e816b13f4af952f7ea6584dcfb");
  EXPECT_EQ(hex_of(std::string(120, 'a')),
            "2f3d335432c70b580af0e8e1b3674a7c020d683aa5f73aaaedfdc55af904c21c");
}

TEST(ReadFile, RefusesDevicesThatNeverEnd) { EXPECT_THROW(read_file("/dev/zero"), InputError); }

TEST(ReadFile, ReturnsTheBytes) {
  const TemporaryFolder folder;
  write_text(folder / "f", std::string("a\0b", 3));
  const std::vector<std::byte> bytes = read_file(folder / "f");
  ASSERT_EQ(bytes.size(), 3u);
  EXPECT_EQ(bytes[1], std::byte{0});
  EXPECT_EQ(read_file(folder / "f", 3).size(), 3u);
}

TEST(ReadFile, ReadsFilesWhoseSizeIsNotKnownBefore) {
  // The kernel reports 0 bytes for every file of /proc.
  EXPECT_GT(read_file("/proc/self/status").size(), 100u);
}

TEST(ReadFile, RefusesWhatItCannotRead) {
  const TemporaryFolder folder;
  write_text(folder / "f", "1234");
  EXPECT_THROW(read_file(folder / "absent"), InputError);
  EXPECT_THROW(read_file(folder.path()), InputError);
  EXPECT_THROW(read_file(folder / "f", 3), InputError);
  EXPECT_THROW(read_file("/proc/self/status", 10), InputError)
      << "the limit holds where the size is not known";
}

TEST(WriteAtomically, ReplacesTheWholeFile) {
  const TemporaryFolder folder;
  write_text(folder / "out.txt", "a longer old text");
  write_file_atomically(folder / "out.txt", "new");
  EXPECT_EQ(read_text(folder / "out.txt"), "new");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(WriteAtomically, KeepsTheExtensionAndTheFolderForTheTemporary) {
  const TemporaryFolder folder;
  std::filesystem::path seen;
  write_atomically(folder / "out.exr", [&](const std::filesystem::path& temporary) {
    seen = temporary;
    write_text(temporary, "x");
  });
  EXPECT_EQ(seen.extension(), ".exr");
  EXPECT_EQ(seen.parent_path(), folder.path());
  EXPECT_NE(seen, folder / "out.exr");
}

TEST(WriteAtomically, KeepsTheOldFileWhenTheWriterThrows) {
  const TemporaryFolder folder;
  write_text(folder / "out", "old");
  const auto half_a_file = [](const std::filesystem::path& temporary) {
    write_text(temporary, "half");
    throw std::runtime_error("writer");
  };
  EXPECT_THROW(write_atomically(folder / "out", half_a_file), std::runtime_error);
  EXPECT_EQ(read_text(folder / "out"), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(WriteAtomically, WritesThroughASymbolicLink) {
  const TemporaryFolder folder;
  write_text(folder / "target", "old");
  std::filesystem::create_symlink("target", folder / "link");
  write_file_atomically(folder / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(read_text(folder / "target"), "new");
}

TEST(WriteAtomically, NeverReplacesAFolderOrASpecialFile) {
  const TemporaryFolder folder;
  // A pipe of our own stands for the devices: were this to fail, root would lose /dev/null.
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::filesystem::create_directory(folder / "sub");
  EXPECT_THROW(write_file_atomically(folder / "pipe", "x"), InputError);
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
  EXPECT_THROW(write_file_atomically(folder / "sub", "x"), InputError);
  EXPECT_THROW(write_file_atomically(folder / "absent/out", "x"), InputError);
}

TEST(WriteAtomically, ReportsAReadOnlyFolder) {
  const TemporaryFolder folder;
  write_text(folder / "out", "old");
  constexpr uid_t kNobody = 65534;
  const int result = run_in_child([&] {
    ::chmod(folder.path().c_str(), 0555);
    if (::geteuid() == 0 && ::setuid(kNobody) != 0) return int{kCannotSetUp};  // root may write everywhere
    return overwrite_must_fail(folder / "out");
  });
  ::chmod(folder.path().c_str(), 0755);
  if (result == kCannotSetUp) GTEST_SKIP() << "cannot become an ordinary user";
  EXPECT_EQ(result, kRefusedAndKept);
}

TEST(WriteAtomically, ReportsAFileSizeLimit) {
  const TemporaryFolder folder;
  write_text(folder / "out", "old");
  const int result = run_in_child([&] {
    constexpr rlimit kLimit{1000, 1000};
    std::signal(SIGXFSZ, SIG_IGN);
    if (::setrlimit(RLIMIT_FSIZE, &kLimit) != 0) return int{kCannotSetUp};
    return overwrite_must_fail(folder / "out");
  });
  EXPECT_EQ(result, kRefusedAndKept);
}

TEST(WriteAtomically, ReportsAFullDisk) {
  const TemporaryFolder folder;
  const int result = run_in_child([&] {
    // A file system of our own, in a user and mount namespace: needs no privilege where the kernel allows it.
    const std::string user = std::to_string(::geteuid()), group = std::to_string(::getegid());
    if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return int{kCannotSetUp};
    write_text("/proc/self/setgroups", "deny");
    write_text("/proc/self/uid_map", "0 " + user + " 1");
    write_text("/proc/self/gid_map", "0 " + group + " 1");
    if (::mount("none", folder.path().c_str(), "tmpfs", 0, "size=64k") != 0) return int{kCannotSetUp};
    write_text(folder / "out", "old");
    if (read_text(folder / "out") != "old") return int{kCannotSetUp};
    return overwrite_must_fail(folder / "out");
  });
  if (result == kCannotSetUp) GTEST_SKIP() << "cannot mount a small file system without privilege";
  EXPECT_EQ(result, kRefusedAndKept);
}

}  // namespace
}  // namespace spectrace

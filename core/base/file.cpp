// SPDX-License-Identifier: Apache-2.0
#include "core/base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

#include "core/base/error.h"

namespace spectrace {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kReadChunk = std::size_t(1)
                                   << 16;  // for pipes and /proc, whose size is not known before

[[noreturn]] void system_error(const fs::path& file, std::string_view what, int error_number) {
  throw InputError(file.string(), "",
                   fmt::format("{}: {}", what, std::system_category().message(error_number)));
}

/// An open file descriptor, closed at the end of the scope.
class Descriptor {
 public:
  Descriptor(const fs::path& file, int flags) : fd_(::open(file.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] bool is_open() const { return fd_ >= 0; }
  [[nodiscard]] int get() const { return fd_; }
  /// Closing can report a delayed write error (NFS, quotas).
  int close() { return ::close(std::exchange(fd_, -1)); }

 private:
  int fd_;
};

/// A new, empty file, removed at the end of the scope unless it has been renamed.
class TemporaryFile {
 public:
  /// Created before any work, so that a folder that is missing or read-only is told by its own error.
  TemporaryFile(fs::path name, const fs::path& target) : name_(std::move(name)) {
    const Descriptor created(name_, O_WRONLY | O_CREAT | O_EXCL);
    if (!created.is_open()) system_error(target, "cannot write", errno);
  }
  ~TemporaryFile() {
    if (!name_.empty()) ::unlink(name_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  [[nodiscard]] const fs::path& name() const { return name_; }
  void release() { name_.clear(); }

 private:
  fs::path name_;
};

/// Where the bytes end up: a symbolic link keeps pointing where it did.
fs::path destination_of(const fs::path& file) {
  std::error_code not_there, error;
  const fs::path target = fs::is_symlink(file, not_there) ? fs::weakly_canonical(file, error) : file;
  if (error) throw InputError(file.string(), "", fmt::format("cannot write: {}", error.message()));
  const fs::file_status status = fs::status(target, not_there);
  // Renaming over a device would replace it, and over a folder fails only after all the work is done.
  if (fs::is_directory(status)) throw InputError(file.string(), "", "cannot write: it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw InputError(file.string(), "", "cannot write: it is not a regular file");
  }
  return target;
}

fs::path temporary_name(const fs::path& target) {
  static std::atomic<unsigned> counter{0};  // threads of one process; the process id tells processes apart
  // Without the target's own stem: that may already be as long as names can be.
  fs::path name = target;
  name.replace_filename(
      fmt::format(".spectrace-{}-{}{}", ::getpid(), counter++, target.extension().string()));
  return name;
}

void write_all(int fd, std::span<const std::byte> bytes, const fs::path& file) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) system_error(file, "cannot write", errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

}  // namespace

std::vector<std::byte> read_file(const fs::path& file, std::size_t max_bytes) {
  const Descriptor in(file, O_RDONLY);
  if (!in.is_open()) system_error(file, "cannot open", errno);
  struct stat info {};
  if (::fstat(in.get(), &info) != 0) system_error(file, "cannot read", errno);
  if (S_ISDIR(info.st_mode)) throw InputError(file.string(), "", "cannot read: it is a folder");
  // Some, like /dev/zero, never end.
  if (S_ISCHR(info.st_mode) && ::isatty(in.get()) == 0) {
    throw InputError(file.string(), "", "cannot read: it is a device");
  }
  const auto too_large = [&] {
    return InputError(file.string(), "", fmt::format("larger than the {} bytes read at most", max_bytes));
  };
  const std::size_t expected = info.st_size > 0 ? static_cast<std::size_t>(info.st_size) : 0;
  if (expected > max_bytes) throw too_large();

  std::vector<std::byte> bytes;
  bytes.reserve(expected + 1);
  bytes.resize(expected);
  std::size_t size = 0;
  for (;;) {
    // One byte past the expected end tells "complete" from "still growing".
    if (size == bytes.size()) bytes.resize(size + (size == expected && expected > 0 ? 1 : kReadChunk));
    const ssize_t got = ::read(in.get(), bytes.data() + size, bytes.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) system_error(file, "cannot read", errno);
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
    if (size > max_bytes) throw too_large();
  }
  bytes.resize(size);
  return bytes;
}

void write_atomically(const fs::path& file, const std::function<void(const fs::path&)>& write) {
  const fs::path target = destination_of(file);
  TemporaryFile temporary(temporary_name(target), file);
  write(temporary.name());

  Descriptor written(temporary.name(), O_RDONLY);
  if (!written.is_open()) system_error(file, "cannot write", errno);
  // Without this a crash after the rename can leave the new name with no data (ext4 delayed allocation).
  if (::fsync(written.get()) != 0 || written.close() != 0) system_error(file, "cannot write", errno);
  if (::rename(temporary.name().c_str(), target.c_str()) != 0) system_error(file, "cannot write", errno);
  temporary.release();
}

void write_file_atomically(const fs::path& file, std::span<const std::byte> bytes) {
  write_atomically(file, [&](const fs::path& temporary) {
    Descriptor out(temporary, O_WRONLY | O_TRUNC);
    if (!out.is_open()) system_error(file, "cannot write", errno);
    write_all(out.get(), bytes, file);
    if (out.close() != 0) system_error(file, "cannot write", errno);
  });
}

void write_file_atomically(const fs::path& file, std::string_view text) {
  write_file_atomically(file, std::as_bytes(std::span(text)));
}

}  // namespace spectrace

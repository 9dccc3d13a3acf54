// SPDX-License-Identifier: Apache-2.0
#include "core/image/tev_view.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include "core/image/tev_packets.h"

namespace spectrace {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// How long a wait lasts before it looks whether it is still wanted.
constexpr milliseconds kSlice{50};

struct TevFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

[[noreturn]] void fail(std::string_view what, int error_number) {
  throw TevFailure(fmt::format("{}: {}", what, std::system_category().message(error_number)));
}

/// A connection whose every wait ends: after the patience, or when it is told to stop.
class Connection {
 public:
  Connection(const TevAddress& address, milliseconds patience, const std::atomic<bool>& stop)
      : patience_(patience), stop_(stop) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const int error =
        ::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &hints, &found);
    if (error != 0) throw TevFailure(fmt::format("no such host: {}", ::gai_strerror(error)));
    const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, &::freeaddrinfo);
    int last_error = 0;
    for (const addrinfo* a = found; a != nullptr && fd_ < 0; a = a->ai_next) last_error = try_connect(*a);
    if (fd_ < 0) fail("cannot connect", last_error);
  }
  ~Connection() {
    if (fd_ >= 0) ::close(fd_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void send(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      // Without MSG_NOSIGNAL a receiver that went away would end the program.
      const ssize_t sent = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (sent >= 0) {
        bytes = bytes.subspan(static_cast<std::size_t>(sent));
      } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
        if (const int error = wait_writable(fd_)) fail("sending failed", error);
      } else if (errno != EINTR) {
        fail("sending failed", errno);
      }
    }
  }

 private:
  /// 0 where the socket can be written to; else why not.
  int wait_writable(int fd) const {
    const Clock::time_point end = Clock::now() + patience_;
    while (Clock::now() < end) {
      if (stop_) return ECANCELED;
      pollfd wanted{.fd = fd, .events = POLLOUT, .revents = 0};
      const int ready = ::poll(&wanted, 1, static_cast<int>(std::min(kSlice, patience_).count()));
      if (ready > 0) return 0;
      if (ready < 0 && errno != EINTR) return errno;
    }
    return ETIMEDOUT;
  }

  /// 0 and fd_ set, or the error.
  int try_connect(const addrinfo& address) {
    const int fd =
        ::socket(address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, address.ai_protocol);
    if (fd < 0) return errno;
    int error = 0;
    if (::connect(fd, address.ai_addr, address.ai_addrlen) != 0) {
      error = errno == EINPROGRESS ? wait_writable(fd) : errno;
      socklen_t size = sizeof error;
      if (error == 0) ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
    }
    if (error != 0) {
      ::close(fd);
      return error;
    }
    fd_ = fd;
    return 0;
  }

  int fd_ = -1;
  milliseconds patience_;
  const std::atomic<bool>& stop_;
};

}  // namespace

class TevView::Sender {
 public:
  Sender(TevAddress address, std::string name, Progress& progress, const TevOptions& options)
      : address_(std::move(address)), name_(std::move(name)), progress_(progress), options_(options) {}
  ~Sender() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  [[nodiscard]] bool wants_picture() {
    const std::lock_guard lock(mutex_);
    return !has_failed_ && !is_busy_ && (!last_ || Clock::now() - *last_ >= options_.interval);
  }
  void take(const Image& image) {
    try {
      const std::lock_guard lock(mutex_);
      if (has_failed_) return;
      last_ = Clock::now();
      waiting_ = image;
      is_busy_ = true;
      if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
    } catch (const std::exception& e) {  // no memory, no thread
      give_up(e.what());
    }
    changed_.notify_all();
  }
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !is_busy_ || has_failed_; });
  }

 private:
  /// Of the thread: whatever comes to wait is sent, until the end or a failure.
  void run() {
    try {
      Connection connection(address_, options_.patience, stop_);
      while (const std::optional<Image> image = next()) send(connection, *image);
    } catch (const std::exception& e) {
      give_up(e.what());
    }
    changed_.notify_all();
  }

  void give_up(const char* why) {
    if (!stop_) {
      progress_.note(
          fmt::format("tev at {}:{}: {}; rendering goes on without it", address_.host, address_.port, why));
    }
    const std::lock_guard lock(mutex_);  // after the note, so that who waits for the end has seen it
    has_failed_ = true;
    waiting_.reset();
  }

  /// The picture that waits; nothing at the end.
  std::optional<Image> next() {
    std::unique_lock lock(mutex_);
    if (!waiting_) {
      is_busy_ = false;
      changed_.notify_all();
    }
    changed_.wait(lock, [this] { return waiting_ || stop_; });
    if (stop_) return std::nullopt;
    return std::exchange(waiting_, std::nullopt);
  }

  void send(Connection& connection, const Image& image) {
    const bool is_new =
        shown_.width != image.width || shown_.height != image.height || shown_.channels != image.channels;
    if (is_new) connection.send(tev_create(name_, image));
    for (const TevTile& tile : changed_tiles(image, shown_)) connection.send(tev_update(name_, image, tile));
    shown_ = image;
  }

  const TevAddress address_;
  const std::string name_;
  Progress& progress_;
  const TevOptions options_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Image> waiting_;
  std::optional<Clock::time_point> last_;
  bool is_busy_ = false;  // a picture waits or is being sent
  bool has_failed_ = false;
  std::atomic<bool> stop_ = false;
  Image shown_;  // of the thread alone
  std::thread thread_;
};

std::optional<TevAddress> parse_tev_address(std::string_view text) {
  TevAddress address;
  std::string_view host = text, port;
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    host = text.substr(1, end - 1);
    port = text.substr(end + 1);
    if (!port.empty() && port.front() != ':') return std::nullopt;
  } else if (const std::size_t colon = text.find(':'); colon != std::string_view::npos) {
    host = text.substr(0, colon);
    port = text.substr(colon);
  }
  if (!host.empty()) address.host = host;
  if (!port.empty()) {
    port.remove_prefix(1);
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
    if (error != std::errc() || end != port.data() + port.size() || address.port == 0) return std::nullopt;
  }
  return address;
}

TevView::TevView(TevAddress address, std::string name, Progress& progress, const TevOptions& options)
    : sender_(std::make_unique<Sender>(std::move(address), std::move(name), progress, options)) {}
TevView::~TevView() = default;

bool TevView::wants_picture() const { return sender_->wants_picture(); }

void TevView::show(const Image& image) {
  if (sender_->wants_picture()) sender_->take(image);
}

void TevView::finish(const Image& image) {
  sender_->take(image);
  sender_->wait();
}

}  // namespace spectrace

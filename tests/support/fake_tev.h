// SPDX-License-Identifier: Apache-2.0
// A viewer that listens as tev does, and keeps what it is sent.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "core/image/image.h"
#include "core/image/tev_packets.h"
#include "core/image/tev_view.h"

namespace spectrace::test {

/// Reads one packet from its bytes, as tev does.
class TevReader {
 public:
  explicit TevReader(const std::vector<std::byte>& bytes) : bytes_(bytes) {}
  template <typename T>
  T take() {
    T x{};
    std::memcpy(&x, &bytes_.at(at_ + sizeof x - 1) - (sizeof x - 1), sizeof x);
    at_ += sizeof x;
    return x;
  }
  std::string text() {
    std::string text;
    for (char c = take<char>(); c != 0; c = take<char>()) text += c;
    return text;
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

 private:
  const std::vector<std::byte>& bytes_;
  std::size_t at_ = 0;
};

/// What tev would show after these packets; each is held to the protocol.
class Viewer {
 public:
  std::map<std::string, Image> images;
  int creations = 0;
  std::vector<TevTile> tiles;

  void receive(const std::vector<std::byte>& packet) {
    TevReader in(packet);
    EXPECT_EQ(in.take<std::uint32_t>(), packet.size());
    const auto type = in.take<std::uint8_t>();
    EXPECT_EQ(in.take<std::uint8_t>(), 0) << "steals the focus";
    const std::string name = in.text();
    if (type == 4) {
      create(in, name);
    } else {
      ASSERT_EQ(type, 6);
      update(in, name);
    }
    EXPECT_EQ(in.left(), 0U);
  }

 private:
  static std::vector<std::string> names(TevReader& in) {
    std::vector<std::string> names(static_cast<std::size_t>(in.take<std::int32_t>()));
    for (std::string& name : names) name = in.text();
    return names;
  }
  void create(TevReader& in, const std::string& name) {
    const auto width = in.take<std::int32_t>(), height = in.take<std::int32_t>();
    images[name] = Image(width, height, names(in));
    ++creations;
  }
  void update(TevReader& in, const std::string& name) {
    ASSERT_TRUE(images.contains(name));
    Image& image = images[name];
    ASSERT_EQ(names(in), image.channels);
    TevTile tile;
    for (int* x : {&tile.x, &tile.y, &tile.width, &tile.height}) *x = in.take<std::int32_t>();
    tiles.push_back(tile);
    std::vector<std::int64_t> offsets(image.channels.size()), strides(offsets.size());
    for (std::int64_t& x : offsets) x = in.take<std::int64_t>();
    for (std::int64_t& x : strides) x = in.take<std::int64_t>();
    std::vector<float> values(in.left() / sizeof(float));
    for (float& x : values) x = in.take<float>();
    for (int pixel = 0; pixel < tile.width * tile.height; ++pixel) {
      for (std::size_t c = 0; c < offsets.size(); ++c) {
        image.at(tile.x + pixel % tile.width, tile.y + pixel / tile.width, c) =
            values.at(static_cast<std::size_t>(offsets[c] + pixel * strides[c]));
      }
    }
  }
};

/// Accepts one connection and reads it in a thread, to the end or until it has had enough.
class FakeTev {
 public:
  explicit FakeTev(std::size_t enough = std::size_t(-1)) : listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ::bind(listener_, reinterpret_cast<const sockaddr*>(&address), size);
    ::listen(listener_, 1);
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this, enough] { serve(enough); });
  }
  ~FakeTev() { join(); }
  FakeTev(const FakeTev&) = delete;
  FakeTev& operator=(const FakeTev&) = delete;

  [[nodiscard]] TevAddress address() const { return {"127.0.0.1", port_}; }
  /// Waits for the end of the connection.
  const Viewer& viewer() {
    join();
    return viewer_;
  }

 private:
  void serve(std::size_t enough) {
    const int fd = ::accept(listener_, nullptr, nullptr);
    std::size_t read = 0;
    for (std::uint32_t length = 0; read < enough && take(fd, &length, sizeof length);) {
      std::vector<std::byte> packet(length);
      std::memcpy(packet.data(), &length, sizeof length);
      if (!take(fd, packet.data() + sizeof length, length - sizeof length)) break;
      viewer_.receive(packet);
      read += length;
    }
    ::close(fd);
    ::close(listener_);
  }
  static bool take(int fd, void* data, std::size_t size) {
    return ::recv(fd, data, size, MSG_WAITALL) == static_cast<ssize_t>(size);
  }
  void join() {
    if (thread_.joinable()) thread_.join();
  }

  int listener_;
  std::uint16_t port_ = 0;
  Viewer viewer_;
  std::thread thread_;
};

}  // namespace spectrace::test

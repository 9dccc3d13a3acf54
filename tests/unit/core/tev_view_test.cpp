// SPDX-License-Identifier: Apache-2.0
#include "core/image/tev_view.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <condition_variable>
#include <cstring>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "core/image/tev_packets.h"

namespace spectrace {
namespace {

// Nothing is left out for coming too soon.
constexpr TevOptions kAtOnce{.interval = std::chrono::milliseconds(0)};

class Notes final : public Progress {
 public:
  void update(std::string_view, double, double) override {}
  void note(std::string_view text) override {
    const std::lock_guard lock(mutex_);
    lines_.emplace_back(text);
  }
  [[nodiscard]] std::vector<std::string> lines() {
    const std::lock_guard lock(mutex_);
    return lines_;
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> lines_;
};

/// Reads one packet from its bytes, as tev does.
class Reader {
 public:
  explicit Reader(const std::vector<std::byte>& bytes) : bytes_(bytes) {}
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
    Reader in(packet);
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
  static std::vector<std::string> names(Reader& in) {
    std::vector<std::string> names(static_cast<std::size_t>(in.take<std::int32_t>()));
    for (std::string& name : names) name = in.text();
    return names;
  }
  void create(Reader& in, const std::string& name) {
    const auto width = in.take<std::int32_t>(), height = in.take<std::int32_t>();
    images[name] = Image(width, height, names(in));
    ++creations;
  }
  void update(Reader& in, const std::string& name) {
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

Image gradient(int width, int height) {
  Image image(width, height, {"R", "G", "B", "diffuse.R", "depth.Z"});
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = std::sqrt(static_cast<float>(i));
  return image;
}

TEST(TevView, ShowsThePicture) {
  FakeTev tev;
  Notes notes;
  const Image image = gradient(300, 200);  // tiles that do not fit
  {
    TevView view(tev.address(), "scene", notes, kAtOnce);
    view.finish(image);
  }
  const Viewer& viewer = tev.viewer();
  EXPECT_EQ(viewer.creations, 1);
  EXPECT_EQ(viewer.tiles.size(), 6U);
  ASSERT_TRUE(viewer.images.contains("scene"));
  EXPECT_EQ(viewer.images.at("scene").channels, image.channels);
  EXPECT_EQ(viewer.images.at("scene").data, image.data);
  EXPECT_TRUE(notes.lines().empty());
}

TEST(TevView, SendsOnlyTilesThatChanged) {
  FakeTev tev;
  Notes notes;
  Image image = gradient(300, 200);
  {
    TevView view(tev.address(), "scene", notes, kAtOnce);
    view.finish(image);
    view.finish(image);
    image.at(299, 130, 4) = -1;
    view.finish(image);
  }
  const Viewer& viewer = tev.viewer();
  ASSERT_EQ(viewer.tiles.size(), 7U);
  EXPECT_EQ(viewer.tiles.back().x, 256);
  EXPECT_EQ(viewer.tiles.back().y, 128);
  EXPECT_EQ(viewer.tiles.back().width, 44);
  EXPECT_EQ(viewer.tiles.back().height, 72);
  EXPECT_EQ(viewer.images.at("scene").data, image.data);
}

TEST(TevView, BeginsAnewWithAnotherSize) {
  FakeTev tev;
  Notes notes;
  {
    TevView view(tev.address(), "scene", notes, kAtOnce);
    view.finish(gradient(64, 64));
    view.finish(gradient(64, 32));
  }
  EXPECT_EQ(tev.viewer().creations, 2);
  EXPECT_EQ(tev.viewer().images.at("scene").data, gradient(64, 32).data);
}

TEST(TevView, LeavesOutWhatComesTooSoonButNotTheLast) {
  FakeTev tev;
  Notes notes;
  Image image = gradient(64, 64);
  {
    TevView view(tev.address(), "scene", notes, {.interval = std::chrono::hours(1)});
    EXPECT_TRUE(view.wants_picture());
    view.finish(image);
    EXPECT_FALSE(view.wants_picture());
    for (int i = 0; i < 100; ++i) {
      image.at(0, 0, 0) = static_cast<float>(i);
      view.show(image);
    }
    image.at(0, 0, 0) = 1000;
    view.finish(image);
  }
  EXPECT_EQ(tev.viewer().tiles.size(), 2U);
  EXPECT_EQ(tev.viewer().images.at("scene").data, image.data);
}

TEST(TevView, NotesOnceThatNobodyListens) {
  TevAddress nobody;
  {
    FakeTev gone(0);
    nobody = gone.address();
    Notes unused;
    TevView(nobody, "last", unused, kAtOnce).finish(gradient(8, 8));
  }
  Notes notes;
  TevView view(nobody, "scene", notes, kAtOnce);
  for (int i = 0; i < 3; ++i) view.finish(gradient(8, 8));
  ASSERT_EQ(notes.lines().size(), 1U);
  EXPECT_EQ(notes.lines().front(), "tev at 127.0.0.1:" + std::to_string(nobody.port) +
                                       ": cannot connect: Connection refused; rendering goes on without it");
  EXPECT_FALSE(view.wants_picture());
}

TEST(TevView, GoesQuietWhenTevCloses) {
  FakeTev tev(1);  // closes after the first packet, with more on its way
  Notes notes;
  TevView view(tev.address(), "scene", notes, kAtOnce);
  Image image = gradient(1024, 1024);  // 21 MB: more than sockets buffer
  for (int i = 0; i < 5; ++i) {
    image.at(1, 1, 0) = static_cast<float>(-i);
    view.finish(image);
  }
  ASSERT_EQ(notes.lines().size(), 1U);
  EXPECT_NE(notes.lines().front().find("sending failed"), std::string::npos) << notes.lines().front();
}

// Sending to one who has read all and gone would end this program by SIGPIPE.
TEST(TevView, SurvivesABrokenPipe) {
  Image image = gradient(8, 8);
  FakeTev tev(tev_create("scene", image).size() + tev_update("scene", image, {0, 0, 8, 8}).size());
  Notes notes;
  TevView view(tev.address(), "scene", notes, kAtOnce);
  view.finish(image);
  EXPECT_EQ(tev.viewer().tiles.size(), 1U);
  // The first packets that are sent now are lost without a word.
  for (int i = 0; i < 1000 && notes.lines().empty(); ++i) {
    image.at(1, 1, 0) = static_cast<float>(-i);
    view.finish(image);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_EQ(notes.lines().size(), 1U);
  EXPECT_NE(notes.lines().front().find("Broken pipe"), std::string::npos) << notes.lines().front();
}

class Deaf {  // takes what its buffers hold and never reads
 public:
  Deaf() : listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ::bind(listener_, reinterpret_cast<const sockaddr*>(&address), size);
    ::listen(listener_, 1);
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~Deaf() {
    if (connection_ >= 0) ::close(connection_);
    ::close(listener_);
  }
  Deaf(const Deaf&) = delete;
  Deaf& operator=(const Deaf&) = delete;
  [[nodiscard]] TevAddress address() const { return {"127.0.0.1", port_}; }
  /// Until the first bytes are there.
  void wait() {
    connection_ = ::accept(listener_, nullptr, nullptr);
    char first = 0;
    EXPECT_EQ(::recv(connection_, &first, 1, MSG_PEEK), 1);
  }

 private:
  int listener_, connection_ = -1;
  std::uint16_t port_ = 0;
};

TEST(TevView, LosesPatienceWithOneWhoDoesNotRead) {
  const Deaf deaf;
  Notes notes;
  TevView view(deaf.address(), "scene", notes, {.interval = {}, .patience = std::chrono::milliseconds(20)});
  view.finish(gradient(1024, 1024));
  ASSERT_EQ(notes.lines().size(), 1U);
  EXPECT_NE(notes.lines().front().find("timed out"), std::string::npos) << notes.lines().front();
}

TEST(TevView, EndsWhileItSends) {
  Deaf deaf;
  Notes notes;
  {
    // An hour of patience: without giving up at the end the test would take it.
    TevView view(deaf.address(), "scene", notes, {.interval = {}, .patience = std::chrono::hours(1)});
    view.show(gradient(1024, 1024));
    deaf.wait();
  }
  EXPECT_TRUE(notes.lines().empty()) << "an end is no failure";
}

TEST(TevView, UnderstandsAddresses) {
  const auto parsed = [](std::string_view text) {
    const auto address = parse_tev_address(text);
    return address ? address->host + " " + std::to_string(address->port) : "none";
  };
  EXPECT_EQ(parsed(""), "127.0.0.1 14158");
  EXPECT_EQ(parsed("viewer"), "viewer 14158");
  EXPECT_EQ(parsed("viewer:80"), "viewer 80");
  EXPECT_EQ(parsed(":80"), "127.0.0.1 80");
  EXPECT_EQ(parsed("[::1]:80"), "::1 80");
  EXPECT_EQ(parsed("[::1]"), "::1 14158");
  for (const char* wrong : {"a:", "a:x", "a:0", "a:65536", "a:-1", "a:80x", "::1", "[::1", "[::1]80"}) {
    EXPECT_EQ(parsed(wrong), "none") << wrong;
  }
}

}  // namespace
}  // namespace spectrace

// SPDX-License-Identifier: Apache-2.0
#include "core/image/tev_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <mutex>
#include <vector>

#include "core/image/tev_packets.h"
#include "tests/support/fake_tev.h"

namespace spectrace {
namespace {

using test::FakeTev;
using test::Viewer;

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

// SPDX-License-Identifier: Apache-2.0
// A picture in the making, shown in tev (https://github.com/Tom94/tev) over its TCP protocol.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/progress.h"
#include "core/image/image.h"

namespace spectrace {

struct TevAddress {
  std::string host = "127.0.0.1";
  std::uint16_t port = 14158;  ///< what tev listens on unless told otherwise
};
/// "HOST:PORT", "[IPV6]:PORT", "HOST" or ":PORT", what is left out as above; nothing where it is none of
/// them.
[[nodiscard]] std::optional<TevAddress> parse_tev_address(std::string_view text);

struct TevOptions {
  std::chrono::milliseconds interval{250};  ///< pictures that come sooner after another are left out
  std::chrono::milliseconds patience{
      2000};  ///< for a connection, and for a receiver that takes no more bytes
};

/// Never throws, never stops the caller for longer than a copy of the picture: a thread of its own connects
/// and sends. The first failure is noted, once; from then on nothing happens.
class TevView {
 public:
  /// `name`: of the picture in tev. `progress` must outlive the view; nothing is connected yet.
  TevView(TevAddress address, std::string name, Progress& progress, const TevOptions& options = {});
  ~TevView();  ///< gives up what has not been sent
  TevView(const TevView&) = delete;
  TevView& operator=(const TevView&) = delete;

  /// Whether show() would take a picture now: asked before one is made for it.
  [[nodiscard]] bool wants_picture() const;
  /// Sends the tiles that differ from what was sent before; skipped if it comes too soon. All channels.
  void show(const Image& image);
  /// Sends the last picture, however soon, and waits until it is sent or its receiver has used up the
  /// patience.
  void finish(const Image& image);

 private:
  class Sender;
  std::unique_ptr<Sender> sender_;
};

}  // namespace spectrace

// SPDX-License-Identifier: Apache-2.0
// Two images against each other, layer by layer, and against the limits.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/compare/limits.h"
#include "core/image/channel_groups.h"

namespace spectrace::cli {

struct CompareSettings {
  std::vector<std::string> layers;  ///< to compare, and to hold to limits that name none; empty: all colours
                                    ///< and spectra that both images have, limits for the beauty
  std::vector<Limit> limits;
  MetricOptions options;
  std::optional<ZTestOptions> z_test;
};

struct NamedImage {
  std::string file;
  Image image;
  Metadata metadata;
  std::vector<ChannelGroup> groups;
};
NamedImage load_image(const std::string& file);

struct LayerZTest {
  ZTestResult result;
  std::string noise;  ///< where the test image's variance comes from, in words
  bool test_has_variance = false;
};

struct LayerResult {
  ChannelGroup reference, test;  ///< the same channels, each in its image
  bool is_named = false;         ///< by --layer or a limit; without any, the beauty
  ChannelMetrics metrics;
  std::optional<LayerZTest> z_test;

  [[nodiscard]] const std::string& name() const { return reference.name; }
};

struct LimitResult {
  std::string layer;
  Limit limit;
  double found = 0;
  bool holds = false;
};

struct Comparison {
  std::string reference, test;
  int width = 0, height = 0;
  bool test_is_finite = true;
  std::vector<std::string> non_finite;  ///< one line a channel that has such values, of all channels
  std::vector<std::string> not_compared;
  std::string note;  ///< on what the figures hold besides the difference in question
  std::vector<LayerResult> layers;
  std::vector<LimitResult> limits;

  [[nodiscard]] bool passes() const;
};

/// Throws InputError where the sizes differ, or where a layer, or a variance that a z-test needs, is missing.
Comparison compare_two(const NamedImage& reference, const NamedImage& test, const CompareSettings& settings);

}  // namespace spectrace::cli

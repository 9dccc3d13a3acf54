// SPDX-License-Identifier: Apache-2.0
// What differs, as pictures.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/compare/comparison.h"

namespace spectrace::cli {

/// One layer: R, G, B, linear, to be shown as they are. Values that are not finite are kept: writers paint
/// them magenta.
struct LayerPictures {
  std::string layer;
  Image reference, test;   ///< exposed alike
  Image difference;        ///< test - reference around mid grey, times `gain`
  Image error;             ///< error_map()
  std::optional<Image> z;  ///< of a z-test: z around mid grey, its threshold at white and black
  double exposure = 1, gain = 1;
};

LayerPictures make_pictures(const NamedImage& reference, const NamedImage& test, const LayerResult& layer);

/// PREFIXLAYER-difference.png, -error.png and, of a z-test, -z.png for each layer; the folder is made where
/// it is absent. The files' names.
std::vector<std::filesystem::path> write_maps(const std::filesystem::path& folder, const std::string& prefix,
                                              const NamedImage& reference, const NamedImage& test,
                                              const Comparison& result);

}  // namespace spectrace::cli

// SPDX-License-Identifier: Apache-2.0
// Separated once, rendered many times.
#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "separation/separate.h"

namespace spectrace::cli {

struct CachedSeparation {
  std::filesystem::path file;  ///< the `.sep`
  bool was_cached = false;
  SeparationReport report;  ///< empty where it was cached; unless `usable` there is no file
};

/// The compact `.sep` of a measured file in `folder` (made where absent), separating only where it is not
/// there yet. Its name holds the file's stem and a hash of its bytes, options, quality and method's version,
/// so that neither a changed measurement nor a changed method meets an old result. Throws InputError where
/// the file cannot be read or its fit is unusable.
CachedSeparation cached_separation(const std::filesystem::path& bsdf, const std::filesystem::path& folder,
                                   const SeparationOptions& options, int quality, Progress& progress);

/// Reads, separates and returns the result with its provenance filled in: file name and SHA-256.
SeparationResult separate_file(const std::filesystem::path& bsdf, const SeparationOptions& options,
                               Progress& progress);

}  // namespace spectrace::cli

// SPDX-License-Identifier: Apache-2.0
#include "cli/separation_cache.h"

#include <fmt/format.h>

#include <optional>
#include <span>
#include <string>
#include <system_error>

#include "core/base/cost.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/memory.h"
#include "materials/measured_brdf.h"
#include "materials/separated_lookup.h"
#include "separation/compact.h"

namespace spectrace::cli {
namespace {

// To be raised whenever the same file and options would give other tables.
constexpr int kMethodVersion = 9;
constexpr std::size_t kHashDigits = 16;  // 64 bits: no two materials of one folder meet

/// Everything but the thread count, which changes no bit of the result.
std::string key_of(const std::string& file_sha256, const SeparationOptions& o, int quality) {
  const std::string text = fmt::format(
      "{} v{} grid {} {} {} {} weight {} eps {} starts {} prior {} {} {} {} terms {} {} quality {} analytic "
      "{}",
      file_sha256, kMethodVersion, o.grid.n_theta_h, o.grid.n_theta_d, o.grid.n_phi_d,
      o.grid.quadratic_theta_h, static_cast<int>(o.weight), o.epsilon, o.starts, o.diffraction_prior,
      name_of(o.diffuse), name_of(o.residual), name_of(o.colour), o.residual_rank, o.reciprocal, quality,
      o.analytic);
  return sha256_hex(std::as_bytes(std::span(text))).substr(0, kHashDigits);
}

/// A cached file counts only if it reads back whole.
bool is_readable(const std::filesystem::path& file) {
  std::error_code absent;
  if (!std::filesystem::exists(file, absent)) return false;
  try {
    read_separated_source(file);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

SeparationResult separate_bytes(std::span<const std::byte> bytes, const std::string& sha256,
                                const std::filesystem::path& bsdf, const SeparationOptions& options,
                                Progress& progress) {
  std::optional<MeasuredBrdf> measured;
  const double seconds_read =
      seconds_of([&] { measured.emplace(measured_from_bytes(bytes, bsdf.string())); });
  require_memory(separation_memory_bytes(options, measured->axis().size()), bsdf.string(), "",
                 fmt::format("separating on a grid of {} x {} x {} cells", options.grid.n_theta_h,
                             options.grid.n_theta_d, options.grid.n_phi_d));
  SeparationResult result = separate(*measured, options, progress);
  result.report.seconds_read = seconds_read;
  result.tables.source_name = bsdf.filename().string();
  result.tables.source_sha256 = sha256;
  return result;
}

}  // namespace

SeparationResult separate_file(const std::filesystem::path& bsdf, const SeparationOptions& options,
                               Progress& progress) {
  std::vector<std::byte> bytes;
  std::string sha256;
  const double seconds_read = seconds_of([&] {
    bytes = read_file(bsdf);
    sha256 = sha256_hex(bytes);
  });
  SeparationResult result = separate_bytes(bytes, sha256, bsdf, options, progress);
  result.report.seconds_read += seconds_read;
  return result;
}

CachedSeparation cached_separation(const std::filesystem::path& bsdf, const std::filesystem::path& folder,
                                   const SeparationOptions& options, int quality, Progress& progress) {
  const std::vector<std::byte> bytes = read_file(bsdf);
  const std::string sha256 = sha256_hex(bytes);
  CachedSeparation cached;
  cached.file = folder / fmt::format("{}-{}.sep", bsdf.stem().string(), key_of(sha256, options, quality));
  cached.was_cached = is_readable(cached.file);
  if (cached.was_cached) return cached;

  SeparationResult result = separate_bytes(bytes, sha256, bsdf, options, progress);
  if (!result.report.usable) {
    cached.report = std::move(result.report);
    return cached;
  }
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw InputError(folder.string(), {}, "cannot make this folder: " + failed.message());
  compact_to_tensors(compact(result.tables, quality).tables).write(cached.file);
  cached.report = std::move(result.report);
  return cached;
}

}  // namespace spectrace::cli

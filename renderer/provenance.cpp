// SPDX-License-Identifier: Apache-2.0
#include "renderer/provenance.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <variant>

#include "core/base/version.h"
#include "core/base/wide.h"

namespace spectrace {

namespace {

constexpr const char *kSeconds = "spectrace:seconds", *kThreads = "spectrace:threads",
                     *kIsa = "spectrace:isa", *kMeasuredVertices = "spectrace:measuredVertices",
                     *kExtrapolatedShare = "spectrace:extrapolatedShare";

/// What a header without the attribute, or with one of another type, has.
template <typename T>
T value_of(const Metadata& header, const char* name) {
  const auto found = header.find(name);
  const T* const value = found == header.end() ? nullptr : std::get_if<T>(&found->second);
  return value != nullptr ? *value : T{};
}

}  // namespace

Metadata provenance(const Scene& scene, const RenderOptions& options, const RenderReport& report) {
  const WavelengthRange range = scene.wavelengths.range();
  const CropWindow window = scene.film.window();
  const SampleRange samples = report.samples;
  Metadata metadata{
      {"spectrace:version", std::string(version())},
      {"spectrace:commit", std::string(commit())},
      {"spectrace:sceneFile", scene.file_name},
      {"spectrace:sceneSha256", scene.sha256},
      {"spectrace:materialSha256s", fmt::format("{}", fmt::join(scene.material_sha256s, "; "))},
      {"spectrace:fileSha256s", fmt::format("{}", fmt::join(scene.file_sha256s, "; "))},
      {"spectrace:cropWindow", fmt::format("{} {} {} {} of {} x {}", window.x, window.y, window.width,
                                           window.height, scene.film.width, scene.film.height)},
      {"spectrace:seed", std::to_string(options.seed)},  // text: 64 unsigned bits fit no other attribute
      {"spectrace:sampler", std::string(sampler_name(scene.sampler))},
      {"spectrace:spp", std::int64_t(samples.count())},
      {"spectrace:sampleRange", fmt::format("{}:{}", samples.first, samples.last)},
      {kSeconds, report.seconds},
      {kThreads, std::int64_t(report.threads)},
      {kIsa, std::string(instruction_set())},
      {"spectrace:lambdaMinNm", double(range.min_nm)},
      {"spectrace:lambdaMaxNm", double(range.max_nm)},
      {"spectrace:observer", std::string("CIE 1931 2 degree")},
      {"spectrace:units",
       std::string("X, Y, Z: W.m^-2.sr^-1.nm^-1 weighted by the observer, over 106.857 nm; "
                   "R, G, B: linear sRGB of X, Y, Z")},
      {"spectrace:binMeasure", std::string("no bins")},
      {"spectrace:kernel", report.kernel},
      {"spectrace:effectsUsed", fmt::format("{}", fmt::join(report.effects.used, "; "))},
      {"spectrace:effectsSkipped", fmt::format("{}", fmt::join(report.effects.skipped, "; "))},
      {"spectrace:approximations", fmt::format("{}", fmt::join(scene.approximations, "; "))},
      {"spectrace:invalidSamples", std::int64_t(report.invalid_samples)},
      {kMeasuredVertices, std::int64_t(report.measured_vertices)},
      {kExtrapolatedShare, report.extrapolated_share},
  };
  add_matte_metadata(scene.matte_names, options.aovs, metadata);
  return metadata;
}

Metadata joined_provenance(Metadata header, const Metadata& other) {
  const auto seconds = [](const Metadata& h) { return value_of<double>(h, kSeconds); };
  const auto threads = [](const Metadata& h) { return value_of<std::int64_t>(h, kThreads); };
  const auto vertices = [](const Metadata& h) {
    constexpr std::int64_t kMost = std::int64_t(1) << 53;  // a file may say anything, and sums must fit
    return std::clamp<std::int64_t>(value_of<std::int64_t>(h, kMeasuredVertices), 0, kMost);
  };
  const auto beyond = [&](const Metadata& h) {
    return value_of<double>(h, kExtrapolatedShare) * double(vertices(h));
  };
  const std::int64_t all_vertices = vertices(header) + vertices(other);
  const double share = all_vertices > 0 ? (beyond(header) + beyond(other)) / double(all_vertices) : 0.0;
  std::string sets = value_of<std::string>(header, kIsa);
  const auto of_other = value_of<std::string>(other, kIsa);
  if (sets.find(of_other) == std::string::npos) sets += "; " + of_other;
  header[kSeconds] = seconds(header) + seconds(other);
  header[kThreads] = std::max(threads(header), threads(other));
  header[kIsa] = sets;
  header[kMeasuredVertices] = all_vertices;
  header[kExtrapolatedShare] = share;
  return header;
}

Metadata spectral_provenance(Metadata of_image, const SpectralBins& bins) {
  std::erase_if(of_image, [](const auto& entry) { return is_matte_metadata(entry.first); });
  of_image["spectralLayoutVersion"] = std::string("1.0");
  of_image["emissiveUnits"] = std::string("W.m^-2.sr^-1");
  of_image["spectrace:binMeasure"] =
      std::string(bins.at_centers ? "W.m^-2.sr^-1.nm^-1 at the centre of the bin"
                                  : "mean W.m^-2.sr^-1.nm^-1 over the bin");
  of_image["spectrace:binWidthNm"] = bins.width_nm();
  of_image["spectrace:binsMinNm"] = double(bins.range.min_nm);
  of_image["spectrace:binsMaxNm"] = double(bins.range.max_nm);
  return of_image;
}

}  // namespace spectrace

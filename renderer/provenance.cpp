// SPDX-License-Identifier: Apache-2.0
#include "renderer/provenance.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include "core/base/version.h"
#include "core/base/wide.h"

namespace spectrace {

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
      {"spectrace:cropWindow", fmt::format("{} {} {} {} of {} x {}", window.x, window.y, window.width,
                                           window.height, scene.film.width, scene.film.height)},
      {"spectrace:seed", std::to_string(options.seed)},  // text: 64 unsigned bits fit no other attribute
      {"spectrace:sampler", std::string(sampler_name(scene.sampler))},
      {"spectrace:spp", std::int64_t(samples.count())},
      {"spectrace:sampleRange", fmt::format("{}:{}", samples.first, samples.last)},
      {"spectrace:seconds", report.seconds},
      {"spectrace:threads", std::int64_t(report.threads)},
      {"spectrace:isa", std::string(instruction_set())},
      {"spectrace:lambdaMinNm", double(range.min_nm)},
      {"spectrace:lambdaMaxNm", double(range.max_nm)},
      {"spectrace:units", std::string("linear sRGB of W.m^-2.sr^-1.nm^-1 weighted by CIE 1931 / 106.857 nm")},
      {"spectrace:kernel", report.kernel},
      {"spectrace:effectsUsed", fmt::format("{}", fmt::join(report.effects.used, "; "))},
      {"spectrace:effectsSkipped", fmt::format("{}", fmt::join(report.effects.skipped, "; "))},
      {"spectrace:approximations", fmt::format("{}", fmt::join(scene.approximations, "; "))},
      {"spectrace:invalidSamples", std::int64_t(report.invalid_samples)},
      {"spectrace:extrapolatedShare", report.extrapolated_share},
  };
  add_matte_metadata(scene.matte_names, options.aovs, metadata);
  return metadata;
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

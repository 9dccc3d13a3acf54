// SPDX-License-Identifier: Apache-2.0
#include "cli/cost/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "core/image/metrics.h"
#include "renderer/render.h"

namespace spectrace::cli {

namespace {

std::vector<Part> parts_of(const RenderSession& session, bool has_bands) {
  const Image image = session.film().resolve();
  std::vector<Part> parts;
  for (const std::string lobe : {"diffuse", "specular"}) {
    const std::array<std::string, 3> channels{lobe + ".R", lobe + ".G", lobe + ".B"};
    parts.push_back({lobe, image.select(channels, "render")});
  }
  if (!has_bands) return parts;
  const Image spectral = session.film().resolve_spectral(Layer::kBeauty);
  const SpectralBins& bins = *session.film().layout().bins;
  for (std::size_t bin = 0; bin < bins.count; ++bin) {
    const double center = bins.center_nm(bin), half = bins.width_nm() / 2;
    const std::array<std::string, 1> channel{spectral.channels[spectral.channels.size() - bins.count + bin]};
    parts.push_back(
        {fmt::format("{:.0f}-{:.0f} nm", center - half, center + half), spectral.select(channel, "render")});
  }
  return parts;
}

double mean_of(const Image& image) {
  double sum = 0;
  for (const float value : image.data) sum += double(value);
  return sum / double(image.data.size());
}

}  // namespace

PartPair render_parts(SceneDesc description, int spp, std::uint64_t seed, int threads, Progress& progress) {
  const bool has_bands = !description.film.spectral;
  if (has_bands) description.film.spectral = SpectralFilmDesc{{description.range, kBands, false}, false};
  const Scene scene = build_scene(description, progress);
  const auto parts = [&](std::uint64_t of) {
    RenderSession session(scene, {.spp = spp, .seed = of, .threads = threads, .aovs = kLobeAovs});
    SilentProgress silent;
    session.finish(silent);
    return parts_of(session, has_bands);
  };
  return {parts(seed), parts(seed + 1)};
}

std::vector<PartBias> bias_by_part(const PartPair& test, const PartPair& reference) {
  std::vector<PartBias> biases;
  for (std::size_t i = 0; i < test[0].size(); ++i) {
    const std::string& name = test[0][i].name;
    const auto found = std::find_if(reference[0].begin(), reference[0].end(),
                                    [&](const Part& part) { return part.name == name; });
    if (found == reference[0].end()) continue;
    const Image &first = found->image,
                &second = reference[1][std::size_t(found - reference[0].begin())].image;
    const double mean = (mean_of(first) + mean_of(second)) / 2;
    if (!(mean > 0)) continue;  // a lobe that nothing has
    biases.push_back({name, bias_rel_mse({test[0][i].image, test[1][i].image}, {first, second},
                                         kRelativeEpsilon * mean * mean)});
  }
  return biases;
}

}  // namespace spectrace::cli

// SPDX-License-Identifier: Apache-2.0
#include "cli/render_output.h"

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "core/image/image.h"
#include "renderer/provenance.h"

namespace spectrace::cli {

namespace {

namespace fs = std::filesystem;

fs::path beside(const fs::path& file, const std::string& ending) {
  return fs::path(file).replace_extension().concat(ending);
}

}  // namespace

void write_images(const RenderOutput& output, const Film& film, const Metadata& metadata) {
  Image image = film.resolve();
  write_png(beside(output.file, ".png"), image, "", output.exposure);
  for (const Layer layer : {Layer::kDiffuse, Layer::kSpecular}) {
    if (!output.layer_pngs || !film.layout().layers.has(layer)) continue;
    const std::string name(layer_name(layer));
    write_png(beside(output.file, "-" + name + ".png"), image, name, output.exposure);
  }
  use_names(output.names, image);
  write_exr(output.file, image, metadata);
  if (!film.layout().bins) return;
  const Metadata spectral = spectral_provenance(metadata, *film.layout().bins);
  film.layout().bin_layers.for_each([&](Layer layer) {
    const std::string_view name = layer_name(layer);
    const std::string ending = fmt::format("{}{}.spectral.exr", name.empty() ? "" : ".", name);
    write_exr(beside(output.file, ending), film.resolve_spectral(layer), spectral);
  });
}

fs::path partial_file(const RenderOutput& output) { return beside(output.file, ".partial"); }

}  // namespace spectrace::cli

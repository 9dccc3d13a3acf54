// SPDX-License-Identifier: Apache-2.0
// One way in for every kind of measurement. What is not in the EPFL layout is measured into it, so that the
// renderer, the separation and `inspect` know one layout only.
#include <algorithm>
#include <string_view>

#include "core/base/error.h"
#include "core/base/file.h"
#include "materials/acquisition.h"
#include "materials/foreign_bsdf.h"
#include "materials/measured_tables.h"
#include "materials/merl_file.h"
#include "materials/scattered_brdf.h"

namespace spectrace {
namespace {

/// The description, which messages and the header of a `.sep` carry.
AcquisitionOptions options_for(const std::string& file_name, const std::string& kind) {
  AcquisitionOptions options;
  options.description = kind + " " + std::filesystem::path(file_name).filename().string();
  return options;
}

MeasuredTables converted(const BrdfSource& source, const AcquisitionOptions& options,
                         const std::string& file_name, const MeasuredSource& origin) {
  SilentProgress progress;
  try {
    MeasuredTables tables = acquire(source, options, progress);
    const std::size_t filled = tables.source.filled_cells;
    tables.source = origin;
    tables.source.filled_cells = filled;
    tables.file_name = file_name;
    return tables;
  } catch (const InputError& e) {
    throw InputError(file_name, "", e.diagnostics().front().problem);  // acquire() knows no file
  }
}

MeasuredTables from_merl(std::span<const std::byte> bytes, const std::string& file_name) {
  const MerlBrdf brdf(bytes, file_name);
  AcquisitionOptions options = options_for(file_name, "MERL");
  // Grids at which the conversion loses less than the file's own bins do (merl_file_test).
  options.elevations = 32;
  options.table_size = 64;
  options.ndf_size = 256;
  return converted(brdf, options, file_name,
                   {.format = "MERL binary", .samples = brdf.bins(), .invalid_samples = brdf.invalid_bins()});
}

MeasuredTables from_scattered(std::string_view text, const std::string& file_name) {
  const ScatteredSamples samples = parse_scattered(text, file_name);
  AcquisitionOptions options = options_for(file_name, "Cornell");
  // The grids at which the conversion loses no more than the fit does (docs/bring-your-own-data.md).
  options.elevations = 33;
  options.table_size = 64;
  return converted(ScatteredBrdf(samples), options, file_name,
                   {.format = "Cornell text",
                    .samples = samples.directions.size(),
                    .invalid_samples = samples.negative_values});
}

}  // namespace

MeasuredTables read_measured(const std::filesystem::path& file) {
  return measured_from_bytes(read_file(file), file.string());
}

MeasuredTables measured_from_bytes(std::span<const std::byte> bytes, const std::string& file_name) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  // By content; the extension says whose reader is to complain about what nobody recognises.
  const std::string extension = std::filesystem::path(file_name).extension().string();
  if (TensorFile::has_magic(bytes)) return measured_from_tensors(TensorFile::parse(bytes, file_name));
  if (is_merl(bytes) || extension == ".binary") return from_merl(bytes, file_name);
  if (extension == ".brdf" || (foreign_bsdf(text).empty() && is_scattered_text(text))) {
    return from_scattered(text, file_name);
  }
  return measured_from_tensors(TensorFile::parse(bytes, file_name));
}

}  // namespace spectrace

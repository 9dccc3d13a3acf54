// SPDX-License-Identifier: Apache-2.0
// One measured material in every form the renderer evaluates: what the benchmarks compare.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "materials/material.h"
#include "materials/measured_tables.h"
#include "separation/separate.h"

namespace spectrace::bench {

enum class Axis : std::uint8_t { kRgb, kSpectral };  ///< three channels, or 195 wavelengths
inline constexpr std::array kAxes{Axis::kRgb, Axis::kSpectral};
std::string_view name_of(Axis axis);  ///< "rgb", "spectral"

/// The form others are compared with, and the separated ones that are compared.
inline constexpr std::string_view kRaw = "raw";
/// "raw", "tabulated", then "compact" and "plain" with each model of kSeparationModelNames: "compact/sun".
std::vector<std::string> forms();

/// A file of the shared data; where that is absent, what the virtual goniophotometer makes of a built-in
/// material of the same kind. Read once.
const MeasuredTables& measured_tables(Axis axis);
/// What that is called: the file's name or the material's.
std::string source_of(Axis axis);
/// Of the options that make every model.
SeparationOptions separation_options();
/// Made when first asked for, and kept.
const Material& material(Axis axis, const std::string& form);

/// Everything one evaluation or sample takes, as a path's vertex would have it.
struct Vertex {
  Vec3 wo, wi;
  SampledWavelengths lambda;
  BsdfRandom random;
};
/// Directions distributed by their cosine, wavelengths as the renderer draws them. So many, that neither they
/// nor the table cells they touch stay in the first two caches.
const std::vector<Vertex>& vertices();

}  // namespace spectrace::bench

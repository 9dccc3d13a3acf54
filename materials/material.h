// SPDX-License-Identifier: Apache-2.0
// Every material of the program in one closed variant, and its JSON description.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/json.h"
#include "materials/analytic_brdf.h"
#include "materials/bsdf.h"
#include "materials/conductor.h"
#include "materials/dielectric.h"
#include "materials/diffractive.h"
#include "materials/glossy.h"
#include "materials/lambert.h"
#include "materials/measured_brdf.h"
#include "materials/paired_brdf.h"
#include "materials/plastic.h"
#include "materials/rough_dielectric.h"
#include "materials/separated_brdf.h"
#include "materials/tabulated_brdf.h"

namespace spectrace {

/// Visited once a path vertex; immutable, shared between threads.
using Material =
    std::variant<Lambert, SmoothConductor, RoughConductor, Dielectric, Glossy, Diffractive, MeasuredBrdf,
                 SeparatedBrdf, TabulatedBrdf, AnalyticBrdf, PairedBrdf, RoughDielectric, Plastic>;

[[nodiscard]] BsdfValue evaluate(const Material& material, Vec3 wo, Vec3 wi, const ShadingPoint& at);
[[nodiscard]] LobeValues evaluate_lobes(const Material& material, Vec3 wo, Vec3 wi, const ShadingPoint& at);
[[nodiscard]] std::optional<BsdfSample> sample(const Material& material, Vec3 wo, const BsdfRandom& u,
                                               const ShadingPoint& at);
[[nodiscard]] bool is_delta(const Material& material);
/// Has a delta lobe, alone or beside others.
[[nodiscard]] bool has_delta_lobe(const Material& material);
/// Light is refracted through it.
[[nodiscard]] bool is_transmissive(const Material& material);
/// Tells its two sides apart: such a material is never flipped to face the viewer.
[[nodiscard]] bool keeps_sides(const Material& material);

/// A measured file, not yet read.
struct MeasuredDesc {
  std::filesystem::path file;
  /// A `.sep` file whose diffraction model draws the directions instead (PairedBrdf); empty: its own density.
  std::filesystem::path directions{};
};
/// A `.sep` file, not yet read, and the model to render it with: without one the richest that the file holds.
struct SeparatedDesc {
  std::filesystem::path file;
  std::optional<SeparationModel> model{};
  bool analytic = false;               ///< the analytic model instead
  std::filesystem::path directions{};  ///< as MeasuredDesc::directions
};
/// Plastic without the table of its coat, which takes some 50 ms to make.
struct PlasticDesc {
  Texture reflectance;
  Spectrum eta = Spectrum::constant(Float(1.5));
  Float alpha = 0;
};
/// Analytic materials are plain already; measured ones name their files.
struct MaterialDesc {
  std::string name;
  std::string where;  ///< of the JSON object, for messages at build time
  std::variant<Lambert, SmoothConductor, RoughConductor, Dielectric, Glossy, Diffractive, MeasuredDesc,
               SeparatedDesc, RoughDielectric, PlasticDesc>
      kind;
};

/// One object {"type": ..., "name": ..., ...}; problems are recorded in the document. Forms:
/// docs/scene-format.md.
MaterialDesc parse_material(const JsonValue& json);
/// A file that holds one such object; throws InputError.
MaterialDesc load_material(const std::filesystem::path& file);
/// Reads the measured or separated file where there is one; throws InputError.
Material build_material(const MaterialDesc& description);

}  // namespace spectrace

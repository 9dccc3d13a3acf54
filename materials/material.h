// SPDX-License-Identifier: Apache-2.0
// Every material of the program in one closed variant, and its JSON description.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
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
#include "materials/masked.h"
#include "materials/measured_albedo.h"
#include "materials/measured_brdf.h"
#include "materials/mix.h"
#include "materials/normal_mapped.h"
#include "materials/paired_brdf.h"
#include "materials/plastic.h"
#include "materials/rough_dielectric.h"
#include "materials/separated_brdf.h"
#include "materials/tabulated_brdf.h"
#include "materials/two_sided.h"

namespace spectrace {

/// Visited once a path vertex; immutable, shared between threads.
using Material = std::variant<Lambert, SmoothConductor, RoughConductor, Dielectric, Glossy, Diffractive,
                              MeasuredBrdf, SeparatedBrdf, TabulatedBrdf, AnalyticBrdf, PairedBrdf,
                              RoughDielectric, Plastic, TwoSided, Mix, Masked, NormalMapped>;

/// What a NestedMaterial points to (ADR 0010).
struct MaterialNode {
  Material material;
};
[[nodiscard]] NestedMaterial nest(Material material);
/// Calls `visit` with the material and with all that it is made of.
void for_each_part(const Material& material, const std::function<void(const Material&)>& visit);

[[nodiscard]] BsdfValue evaluate(const Material& material, Vec3 wo, Vec3 wi, const ShadingPoint& at);
[[nodiscard]] LobeValues evaluate_lobes(const Material& material, Vec3 wo, Vec3 wi, const ShadingPoint& at);
[[nodiscard]] std::optional<BsdfSample> sample(const Material& material, Vec3 wo, const BsdfRandom& u,
                                               const ShadingPoint& at);
/// evaluate() towards `light`, where there is one, and sample(): the same bits. A material that shares work
/// between the two has a member of this name.
[[nodiscard]] Scattering scatter(const Material& material, Vec3 wo, const std::optional<Vec3>& light,
                                 const BsdfRandom& u, const ShadingPoint& at);
[[nodiscard]] bool is_delta(const Material& material);
/// Lobe that has all the light, if every direction tells the same: no need to ask evaluate_lobes().
[[nodiscard]] std::optional<Lobe> only_lobe(const Material& material);
/// Has a delta lobe, alone or beside others.
[[nodiscard]] bool has_delta_lobe(const Material& material);
/// Light is refracted through it.
[[nodiscard]] bool is_transmissive(const Material& material);
/// Tells its two sides apart: such a material is never flipped to face the viewer.
[[nodiscard]] bool keeps_sides(const Material& material);
/// Share of light that goes straight on through holes of a mask, in [0, 1], for shadow rays; `from_front`:
/// from the side the normal points to.
[[nodiscard]] Float pass_through(const Material& material, bool from_front, const ShadingPoint& at);
/// Somewhere that share may be above 0.
[[nodiscard]] bool has_holes(const Material& material);

/// A measured file, not yet read.
struct MeasuredDesc {
  std::filesystem::path file;
  /// A `.sep` file whose diffraction model draws the directions instead (PairedBrdf); empty: its own density.
  std::filesystem::path directions{};
  AlbedoLimit albedo = AlbedoLimit::kKeep;
};
/// A `.sep` file, not yet read, and the model to render it with: without one the richest that the file holds.
struct SeparatedDesc {
  std::filesystem::path file;
  std::optional<SeparationModel> model{};
  bool analytic = false;               ///< the analytic model instead
  std::optional<double> tolerance{};   ///< without a model: choose_model() takes one
  std::filesystem::path directions{};  ///< as MeasuredDesc::directions
};
/// Plastic without the table of its coat, which takes some 50 ms to make.
struct PlasticDesc {
  Texture reflectance;
  Spectrum eta = Spectrum::constant(Float(1.5));
  Float alpha = 0;
};

struct MaterialDesc;
/// Materials made of others: their parts, and the JSON keys of those.
struct TwoSidedDesc {
  static constexpr std::array<const char*, 2> kKeys{"front", "back"};
  std::vector<MaterialDesc> parts;
};
struct MixDesc {
  static constexpr std::array<const char*, 2> kKeys{"first", "second"};
  std::vector<MaterialDesc> parts;
  ScalarTexture weight;
};
struct MaskedDesc {
  static constexpr std::array<const char*, 1> kKeys{"material"};
  std::vector<MaterialDesc> parts;
  ScalarTexture opacity;
};
struct NormalMappedDesc {
  static constexpr std::array<const char*, 1> kKeys{"material"};
  std::vector<MaterialDesc> parts;
  NormalTexture normals;
};

/// Analytic materials are plain already; measured ones name their files.
struct MaterialDesc {
  std::string name;   ///< may be empty of a part
  std::string where;  ///< of the JSON object, for messages at build time
  std::variant<Lambert, SmoothConductor, RoughConductor, Dielectric, Glossy, Diffractive, MeasuredDesc,
               SeparatedDesc, RoughDielectric, PlasticDesc, TwoSidedDesc, MixDesc, MaskedDesc,
               NormalMappedDesc>
      kind;
};

/// Calls `visit` with all that a description is made of, and with itself last. `Desc`: MaterialDesc, const or
/// not.
template <typename Desc, typename Visit>
void for_each_desc(Desc& description, const Visit& visit) {
  std::visit(
      [&](auto& kind) {
        if constexpr (requires { kind.parts; }) {
          for (auto& part : kind.parts) for_each_desc(part, visit);
        }
      },
      description.kind);
  visit(description);
}

/// One object {"type": ..., "name": ..., ...}; problems are recorded in the document. Forms:
/// docs/scene-format.md.
MaterialDesc parse_material(const JsonValue& json);
/// A file that holds one such object; throws InputError.
MaterialDesc load_material(const std::filesystem::path& file);
/// Reads the measured or separated file where there is one; throws InputError.
Material build_material(const MaterialDesc& description);

}  // namespace spectrace

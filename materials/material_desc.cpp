// SPDX-License-Identifier: Apache-2.0
// Materials from JSON; the forms are documented in docs/materials.md.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "core/base/error.h"
#include "materials/choose_model.h"
#include "materials/material.h"
#include "materials/metals.h"
#include "materials/refractive_index.h"

namespace spectrace {

namespace {

constexpr NumberRange kAlphaRange{.min = kMinAlpha, .max = 1};
// The film lies in air: light always enters it.
constexpr NumberRange kFilmEta{.min = 1};
// Beyond 100 µm interference is finer than any wavelength step of this program.
constexpr NumberRange kFilmThickness{.min = 0, .max = 1e5};

// The widest range of wavelengths that optical constants are looked at in.
constexpr WavelengthRange kOptical{.min_nm = 200, .max_nm = 2000};

Float min_over(const Spectrum& s, WavelengthRange range) { return -s.scaled(-1).max_over(range); }

/// A refractive index or an extinction whose values lie in `range`.
Spectrum parse_optical_constant(const JsonValue& json, NumberRange range) {
  Spectrum s = parse_spectrum(json, SpectrumRole::kUnbounded, Spectrum::constant(1));
  const Float minimum = min_over(s, kOptical);
  if (!range.contains(minimum)) json.error("must be " + range.text() + " at every wavelength");
  return s;
}

/// "metal", "metal_file", or "eta" and "k".
void parse_index(const JsonValue& json, ConductorFresnel& fresnel) {
  const JsonValue metal = json.get("metal"), file = json.get("metal_file");
  if (!metal.exists() && !file.exists()) {
    fresnel.eta = parse_optical_constant(json.require("eta"), kPositive);
    fresnel.k = parse_optical_constant(json.require("k"), kNonNegative);
    return;
  }
  const std::string given = metal.exists() ? "metal" : "metal_file";
  for (const char* key : {"metal_file", "eta", "k"}) {
    if (const JsonValue other = json.get(key); key != given && other.exists()) {
      other.error(fmt::format("\"{}\" already gives eta and k", given));
    }
  }
  const auto take = [&](RefractiveIndex index) {
    fresnel.eta = std::move(index.eta);
    fresnel.k = std::move(index.k);
  };
  if (metal.exists()) {
    if (const std::string name = metal.choice("", kMetalNames); !name.empty()) take(named_metal(name));
    return;
  }
  try {
    take(read_refractive_index(file.path()));
  } catch (const InputError& e) {
    file.error(e.diagnostics().front().text());
  }
}

std::optional<ThinFilm> parse_thin_film(const JsonValue& json) {
  if (!json.exists()) return std::nullopt;
  ThinFilm film;
  film.eta = parse_optical_constant(json.require("eta"), kFilmEta);
  film.thickness_nm = static_cast<Float>(json.require("thickness_nm").number(0, kFilmThickness));
  json.reject_unknown_keys();
  return film;
}

ConductorFresnel parse_conductor_fresnel(const JsonValue& json) {
  ConductorFresnel fresnel;
  parse_index(json, fresnel);
  fresnel.film = parse_thin_film(json.get("thin_film"));
  return fresnel;
}

/// One alpha, or [alpha_x, alpha_y].
Ggx parse_roughness(const JsonValue& json) {
  Ggx ggx;
  if (json.is_array()) {
    const std::vector<double> alpha = json.numbers(2, 2, kAlphaRange);
    if (alpha.size() == 2) ggx = {static_cast<Float>(alpha[0]), static_cast<Float>(alpha[1])};
  } else {
    ggx.alpha_x = ggx.alpha_y = static_cast<Float>(json.number(ggx.alpha_x, kAlphaRange));
  }
  return ggx;
}

bool is_smooth(const JsonValue& roughness) {
  return !roughness.exists() || (roughness.is_number() && roughness.number(0) == 0);
}

decltype(MaterialDesc::kind) parse_dielectric(const JsonValue& json) {
  const JsonValue json_eta = json.require("eta");
  Spectrum eta = parse_optical_constant(json_eta, kPositive);
  const JsonValue roughness = json.get("roughness");
  std::optional<ThinFilm> film = parse_thin_film(json.get("thin_film"));
  if (is_smooth(roughness)) return Dielectric{std::move(eta), std::move(film)};
  // Asked of visible light alone: Sellmeier's equation has poles in the ultraviolet.
  const bool bends = min_over(eta, {}) >= 1 + kMinRoughContrast || eta.max_over({}) <= 1 - kMinRoughContrast;
  if (json_eta.exists() && !bends) {
    json_eta.error(fmt::format(
        "must stay {} away from 1, on one side, at every visible wavelength where the surface is rough",
        kMinRoughContrast));
  }
  return RoughDielectric(std::move(eta), parse_roughness(roughness), std::move(film));
}

decltype(MaterialDesc::kind) parse_conductor(const JsonValue& json) {
  ConductorFresnel fresnel = parse_conductor_fresnel(json);
  const JsonValue roughness = json.get("roughness");
  if (is_smooth(roughness)) return SmoothConductor{std::move(fresnel)};
  return RoughConductor{std::move(fresnel), parse_roughness(roughness)};
}

/// "f0", or the forms of conductors.
SpecularFresnel parse_fresnel(const JsonValue& json) {
  const JsonValue f0 = json.get("f0");
  if (!f0.exists()) return parse_conductor_fresnel(json);
  for (const char* key : {"eta", "k", "metal", "metal_file", "thin_film"}) {
    if (const JsonValue other = json.get(key); other.exists()) {
      other.error(std::string("\"f0\" and \"") + key + "\" exclude each other");
    }
  }
  return SchlickFresnel{parse_spectrum(f0, SpectrumRole::kReflectance)};
}

/// The shares of the surface that the two lobes cover; together at most 1.
void parse_scales(const JsonValue& json, double default_specular, Float& specular_scale,
                  Float& diffuse_scale) {
  const JsonValue specular = json.get("specular_scale"), diffuse = json.get("diffuse_scale");
  specular_scale = static_cast<Float>(specular.number(default_specular, kUnitInterval));
  diffuse_scale = static_cast<Float>(diffuse.number(1 - specular_scale, kUnitInterval));
  // 1e-6: the rounding of two single-precision shares.
  if (specular_scale + diffuse_scale > Float(1 + 1e-6)) {
    (diffuse.exists() ? diffuse : specular).error("specular_scale + diffuse_scale must be at most 1");
  }
}

Glossy parse_glossy(const JsonValue& json) {
  Glossy glossy;
  glossy.reflectance = parse_texture(json.require("reflectance"));
  glossy.fresnel = parse_fresnel(json);
  glossy.ggx = parse_roughness(json.require("roughness"));
  parse_scales(json, 0.5, glossy.specular_scale, glossy.diffuse_scale);
  return glossy;
}

MicroRoughness parse_micro_roughness(const JsonValue& json) {
  // Beyond 10 µm everything is diffracted at any wavelength and angle of this program.
  constexpr NumberRange kRms{.min = 0, .max = 1e4};
  // Shorter than 10 nm nothing is left of the spectrum that light could see; 1 mm is no roughness any more.
  constexpr NumberRange kCorrelation{.min = 10, .max = 1e6};
  // At 2 the spectrum has no finite roughness; steeper than 16 it is all but a Gaussian.
  constexpr NumberRange kExponent{.min = 2.1, .max = 16};
  MicroRoughness micro;
  micro.rms_nm = static_cast<Float>(json.require("rms_nm").number(0, kRms));
  micro.correlation_nm =
      static_cast<Float>(json.require("correlation_nm").number(micro.correlation_nm, kCorrelation));
  micro.exponent = static_cast<Float>(json.get("exponent").number(micro.exponent, kExponent));
  json.reject_unknown_keys();
  return micro;
}

Diffractive parse_diffractive(const JsonValue& json) {
  Diffractive diffractive;
  if (const JsonValue reflectance = json.get("reflectance"); reflectance.exists()) {
    diffractive.reflectance = parse_texture(reflectance);
  }
  diffractive.fresnel = parse_fresnel(json);
  diffractive.ggx = parse_roughness(json.require("roughness"));
  diffractive.micro = parse_micro_roughness(json.require("micro_roughness"));
  parse_scales(json, 1, diffractive.specular_scale, diffractive.diffuse_scale);
  return diffractive;
}

PlasticDesc parse_plastic(const JsonValue& json) {
  Texture reflectance = parse_texture(json.require("reflectance"));
  const JsonValue json_eta = json.require("eta");
  Spectrum eta = parse_optical_constant(json_eta, kPositive);
  if (constexpr NumberRange kCoat{.min = 1, .max = kMaxCoatEta};
      !kCoat.contains(min_over(eta, {})) || !kCoat.contains(eta.max_over({}))) {
    json_eta.error("must be " + kCoat.text() + " at every visible wavelength");
  }
  const JsonValue roughness = json.get("roughness");
  const double alpha = is_smooth(roughness) ? 0 : roughness.number(0, kAlphaRange);
  return {std::move(reflectance), std::move(eta), static_cast<Float>(alpha)};
}

SeparatedDesc parse_separated(const JsonValue& json) {
  SeparatedDesc separated{.file = json.require("file").path()};
  const std::string model = json.get("model").choice(
      "richest", {"richest", "auto", "sun", "fresnel", "diffraction", "residual", "analytic"});
  separated.model = separation_model_named(model);
  separated.analytic = model == "analytic";
  const JsonValue tolerance = json.get("tolerance");
  if (model == "auto") {
    separated.tolerance = tolerance.number(kDefaultTolerance, {.min = 0, .max = 1});
  } else if (tolerance.exists()) {
    tolerance.error("only the model \"auto\" has one");
  }
  return separated;
}

MaterialDesc parse_part(const JsonValue& json);

template <typename Desc>
Desc parse_parts(const JsonValue& json) {
  Desc desc;
  for (const char* key : Desc::kKeys) {
    const JsonValue part = json.require(key);
    desc.parts.push_back(parse_part(part));
    if (!part.is_object()) continue;
    if (const JsonValue name = part.get("name"); name.is_string() && desc.parts.back().name.empty()) {
      name.error("expected a name, got an empty string");
    }
  }
  return desc;
}

MixDesc parse_mix(const JsonValue& json) {
  auto mix = parse_parts<MixDesc>(json);
  mix.weight = parse_scalar_texture(json.require("weight"));
  return mix;
}

MaskedDesc parse_mask(const JsonValue& json) {
  auto masked = parse_parts<MaskedDesc>(json);
  masked.opacity = parse_scalar_texture(json.require("opacity"));
  return masked;
}

NormalMappedDesc parse_normal_map(const JsonValue& json) {
  auto mapped = parse_parts<NormalMappedDesc>(json);
  mapped.normals = parse_normal_texture(json.require("normals"));
  return mapped;
}

MeasuredDesc parse_measured(const JsonValue& json) {
  MeasuredDesc measured{.file = json.require("file").path()};
  const std::string albedo = json.get("albedo").choice("keep", {"keep", "clip", "scale"});
  if (albedo == "clip") measured.albedo = AlbedoLimit::kClip;
  if (albedo == "scale") measured.albedo = AlbedoLimit::kScale;
  return measured;
}

decltype(MaterialDesc::kind) parse_kind(const JsonValue& json, const std::string& type) {
  if (type == "conductor") return parse_conductor(json);
  if (type == "dielectric") return parse_dielectric(json);
  if (type == "glossy") return parse_glossy(json);
  if (type == "plastic") return parse_plastic(json);
  if (type == "diffractive") return parse_diffractive(json);
  if (type == "measured") return parse_measured(json);
  if (type == "separated") return parse_separated(json);
  if (type == "two_sided") return parse_parts<TwoSidedDesc>(json);
  if (type == "mix") return parse_mix(json);
  if (type == "mask") return parse_mask(json);
  if (type == "normal_map") return parse_normal_map(json);
  return Lambert{parse_texture(json.require("reflectance"))};
}

/// A material as part of another: it needs no name.
MaterialDesc parse_part(const JsonValue& json) {
  MaterialDesc material;
  if (!json.exists()) return material;  // recorded
  material.where = json.where();
  material.name = json.get("name").string();
  const std::string type = json.require("type").choice(
      "", {"lambert", "conductor", "dielectric", "glossy", "plastic", "diffractive", "measured", "separated",
           "two_sided", "mix", "mask", "normal_map"});
  if (type.empty()) return material;  // recorded; what the other keys should be is unknown
  material.kind = parse_kind(json, type);
  json.reject_unknown_keys();
  return material;
}

AnalyticBrdf build_analytic(const std::filesystem::path& file, const SeparatedSource& source) {
  return std::visit(
      [&](const auto& tables) {
        const std::size_t n = tables->axis.size();
        if (tables->analytic.empty()) {
          throw InputError(file.string(), {}, "has no analytic model: separate it again with --analytic");
        }
        for (std::size_t k = 0; k < n; ++k) {
          const float albedo = tables->analytic[k], f_0 = tables->analytic[2 * n + k],
                      alpha = tables->analytic[3 * n + k];
          if (!(albedo <= 1 && f_0 <= 1 && alpha >= float(kMinAlpha) && alpha <= 1)) {
            throw InputError(file.string(), "field \"analytic\"",
                             fmt::format("column {} lies outside the bounds of the model", k));
          }
        }
        return AnalyticBrdf(tables->axis, tables->analytic);
      },
      source);
}

/// The values themselves, or paired with the directions of a `.sep` file.
template <typename Values>
Material with_directions(Values values, const std::filesystem::path& directions) {
  if (directions.empty()) return values;
  const SeparatedSource source = read_separated_source(directions);
  return PairedBrdf(std::move(values),
                    SeparatedBrdf(source, std::min(richest_model(source), SeparationModel::kDiffraction)));
}

SeparationModel model_of(const SeparatedDesc& s, const SeparatedSource& source, SeparationModel richest) {
  if (s.model) return *s.model;
  return s.tolerance ? choose_model(source, *s.tolerance).model : richest;
}

struct Builder {
  template <typename Desc>
  static NestedMaterial part(const Desc& desc, std::size_t i) {
    return nest(build_material(desc.parts.at(i)));
  }
  Material operator()(const MeasuredDesc& m) const {
    MeasuredTables tables = read_measured(m.file);
    limit_albedo(tables, m.albedo);
    return with_directions(MeasuredBrdf(tables), m.directions);
  }
  Material operator()(const SeparatedDesc& s) const {
    const SeparatedSource source = read_separated_source(s.file);
    if (s.analytic) return with_directions(build_analytic(s.file, source), s.directions);
    const SeparationModel richest = richest_model(source), model = model_of(s, source, richest);
    if (model > richest) {
      throw InputError(s.file.string(), {},
                       fmt::format("has no tables for the model {}, only up to {}: separate it again with "
                                   "--model {}",
                                   name_of(model), name_of(richest), name_of(model)));
    }
    return with_directions(SeparatedBrdf(source, model), s.directions);
  }
  Material operator()(const TwoSidedDesc& t) const { return TwoSided(part(t, 0), part(t, 1)); }
  Material operator()(const MixDesc& m) const { return Mix(part(m, 0), part(m, 1), m.weight); }
  Material operator()(const MaskedDesc& m) const { return Masked(part(m, 0), m.opacity); }
  Material operator()(const NormalMappedDesc& m) const { return NormalMapped(part(m, 0), m.normals); }
  Material operator()(const PlasticDesc& p) const { return Plastic(p.reflectance, p.eta, p.alpha); }
  template <typename Analytic>
  Material operator()(const Analytic& material) const {
    return material;
  }
};

}  // namespace

MaterialDesc parse_material(const JsonValue& json) {
  (void)json.require("name");
  return parse_part(json);
}

MaterialDesc load_material(const std::filesystem::path& file) {
  JsonDocument document = JsonDocument::load(file);
  MaterialDesc material = parse_material(document.root());
  document.throw_if_wrong();
  return material;
}

Material build_material(const MaterialDesc& description) { return std::visit(Builder{}, description.kind); }

}  // namespace spectrace

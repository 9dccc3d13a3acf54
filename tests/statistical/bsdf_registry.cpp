// SPDX-License-Identifier: Apache-2.0
#include "tests/statistical/bsdf_registry.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "core/base/progress.h"
#include "materials/acquisition.h"
#include "materials/half_difference.h"
#include "separation/compact.h"
#include "separation/separate.h"
#include "separation/tabulate.h"
#include "tests/support/test_data.h"

namespace spectrace::test {

namespace {

Spectrum ramp(Float at_400_nm, Float at_700_nm) {
  return TabulatedSpectrum({400, 700}, {at_400_nm, at_700_nm});
}

// Optical constants of a gold-like metal: absorbing, and different at every wavelength.
ConductorFresnel gold_like() {
  return {.eta = ramp(Float(1.5), Float(0.15)), .k = ramp(Float(1.9), Float(4)), .film = {}};
}

ConductorFresnel film_on_gold() {
  ConductorFresnel fresnel = gold_like();
  fresnel.film = ThinFilm{.eta = Spectrum::constant(Float(1.8)), .thickness_nm = 450};
  return fresnel;
}

Glossy plastic(Float alpha) {
  return {.reflectance = ramp(Float(0.2), Float(0.8)),
          .fresnel = SchlickFresnel{Spectrum::constant(Float(0.04))},
          .ggx = {alpha, alpha},
          .diffuse_scale = Float(0.5),
          .specular_scale = Float(0.5)};
}

/// Half of its green light diffracted at normal incidence, over the diffuse lobe of `plastic`.
Diffractive diffractive(Float alpha, Float rms_nm, Float correlation_nm) {
  return {.reflectance = ramp(Float(0.2), Float(0.8)),
          .fresnel = gold_like(),
          .ggx = {alpha, alpha},
          .micro = {.rms_nm = rms_nm, .correlation_nm = correlation_nm, .exponent = Float(2.5)},
          .diffuse_scale = Float(0.4),
          .specular_scale = Float(0.6)};
}

Material built_in(const std::string& name) {
  return build_material(
      load_material(std::filesystem::path(SPECTRACE_SOURCE_DIR) / "scenes/materials" / (name + ".json")));
}

MeasuredTables acquire_for_test(const Material& material, int azimuths = 1, int symmetry = 1) {
  AcquisitionOptions options;
  options.azimuths = azimuths;
  options.symmetry = symmetry;
  options.lambda_nm = {400, 450, 500, 550, 600, 650, 700};
  SilentProgress progress;
  return acquire(material, options, progress);
}

/// What separation itself makes of an acquired material, on a coarse grid. Made once a program.
std::shared_ptr<const SeparatedTables> separate_for_test(const std::string& name) {
  static std::map<std::string, std::shared_ptr<const SeparatedTables>> made;
  std::shared_ptr<const SeparatedTables>& tables = made[name];
  if (tables) return tables;
  SeparationOptions options;
  options.grid = {.n_theta_h = 45, .n_theta_d = 30, .n_phi_d = 36};
  options.residual_rank = 3;
  options.analytic = true;
  SilentProgress progress;
  tables = std::make_shared<const SeparatedTables>(
      separate(MeasuredBrdf(acquire_for_test(built_in(name))), options, progress).tables);
  return tables;
}

/// A specular table with one GGX lobe, and colours that differ in every model.
std::shared_ptr<const SeparatedTables> separated_tables(Float alpha) {
  SeparatedTables t;
  t.grid = {.n_theta_h = 45, .n_theta_d = 30, .n_phi_d = 36};
  t.axis = SpectralAxis::wavelengths({400, 500, 600, 700});
  t.c_d = {0.1F, 0.3F, 0.2F, 0.4F};
  t.s_sun = {0.5F, 0.4F, 0.3F, 0.6F};
  const Ggx ggx{alpha, alpha};
  for (int h = 0; h < t.grid.n_theta_h; ++h) {
    for (int d = 0; d < t.grid.n_theta_d; ++d) {
      const double theta_h = t.grid.theta_h(h), theta_d = t.grid.theta_d(d);
      for (std::size_t l = 0; l < t.axis.size(); ++l) {
        const double phase = double(l) + 4 * theta_d;
        if (h == 0) t.s_fresnel.push_back(static_cast<float>(0.4 + 0.2 * std::sin(phase)));
        t.s_diffraction.push_back(static_cast<float>(0.4 + 0.2 * std::sin(phase + 3 * theta_h)));
      }
      for (int p = 0; p < t.grid.n_phi_d; ++p) {
        DirectionPair pair = from_half_difference({theta_h, theta_d, t.grid.phi_d(p)});
        pair.wo.z = std::max(pair.wo.z, Float(0.02));  // pairs below the horizon need some value
        pair.wi.z = std::max(pair.wi.z, Float(0.02));
        const Ggx::Reflection r = ggx.reflect(normalize(pair.wo), normalize(pair.wi));
        t.rho_s.push_back(static_cast<float>(r.value_cos / pair.wi.z * (pair.wo.z + pair.wi.z)));
      }
    }
  }
  // A residual of either sign that leaves something at every wavelength: steps are told relative to the rest.
  t.residual = {.basis = {1, -1, 0.5F, 1.5F, 0.2F, 1, -1, 0.3F},
                .ratio = std::vector<std::int8_t>(2 * t.grid.size()),
                .step = 1.0F / 64,
                .rank = 2,
                .axis_size = 4};
  for (std::size_t i = 0; i < t.residual.ratio.size(); ++i) {
    const std::size_t group =
        i / 2 / std::size_t(t.grid.n_phi_d);  // even over phi_d: continuous at the poles
    t.residual.ratio[i] = static_cast<std::int8_t>(
        25 * std::sin(0.1 * double(group % 30) + 0.01 * double(group / 30) + double(i % 2)));
  }
  t.source_name = "made for tests";
  return std::make_shared<const SeparatedTables>(std::move(t));
}

void add_analytic(std::vector<BsdfCase>& cases) {
  const auto add = [&cases](std::string name, std::function<std::optional<Material>()> make) {
    cases.push_back({.name = std::move(name),
                     .make = std::move(make),
                     .is_reciprocal = true,
                     .conserves_energy = true,
                     .specular_step = 1e-5});
  };
  add("Lambert", [] { return Lambert{ramp(Float(0.1), Float(1))}; });
  add("RoughConductorAlpha005", [] { return RoughConductor{gold_like(), {Float(0.05), Float(0.05)}}; });
  add("RoughConductorAlpha025", [] { return RoughConductor{gold_like(), {Float(0.25), Float(0.25)}}; });
  add("RoughConductorAlpha08", [] { return RoughConductor{gold_like(), {Float(0.8), Float(0.8)}}; });
  add("RoughConductorAnisotropic", [] { return RoughConductor{gold_like(), {Float(0.08), Float(0.4)}}; });
  add("RoughConductorThinFilm", [] { return RoughConductor{film_on_gold(), {Float(0.25), Float(0.25)}}; });
  add("GlossyPlastic", [] { return plastic(Float(0.1)); });
  add("GlossyNarrow", [] { return plastic(Float(0.005)); });  // as narrow as real paints (hard case H11)
  add("GlossySpecularOnly", [] {                              // an empty lobe is never chosen (hard case H9)
    Glossy g = plastic(Float(0.3));
    g.diffuse_scale = 0;
    return g;
  });
  add("GlossyDiffuseOnly", [] {
    Glossy g = plastic(Float(0.3));
    g.specular_scale = 0;
    return g;
  });
  add("Diffractive", [] { return diffractive(Float(0.1), 40, 2000); });
  add("DiffractiveNarrow", [] { return diffractive(Float(0.3), 40, 20'000); });
  add("DiffractiveWide", [] { return diffractive(Float(0.05), 100, 500); });
  add("DiffractiveThroughAndThrough", [] {  // nothing left to mirror, nor a diffuse lobe
    Diffractive d = diffractive(Float(0.05), 5000, 2000);
    d.diffuse_scale = 0;
    d.specular_scale = 1;
    return d;
  });
  add("DiffractiveSmooth", [] { return diffractive(Float(0.1), 0, 2000); });  // never diffracts
  add("BuiltInDiffractive", [] { return built_in("diffractive_flakes"); });
  add("BuiltInGlossy", [] { return built_in("glossy"); });
  add("BuiltInGold", [] { return built_in("gold"); });
  add("BuiltInPearlescent", [] { return built_in("pearlescent"); });
}

void add_plastic(std::vector<BsdfCase>& cases) {
  const auto add = [&cases](std::string name, Spectrum base, Spectrum eta, Float alpha) {
    cases.push_back({.name = "Plastic" + std::move(name),
                     .make = [base, eta, alpha] { return Plastic(base, eta, alpha); },
                     .is_reciprocal = true,
                     .conserves_energy = true,
                     .specular_step = 1e-5});
  };
  const Spectrum glass = Spectrum::constant(Float(1.5));
  add("Smooth", ramp(Float(0.2), Float(0.8)), glass, 0);
  add("Narrow", ramp(Float(0.2), Float(0.8)), ramp(Float(1.55), Float(1.45)), Float(0.02));
  add("Rough", ramp(Float(0.2), Float(0.8)), glass, Float(0.4));
  add("WhiteRough", Spectrum::constant(1), ramp(Float(1.9), Float(1.3)), 1);
  add("White", Spectrum::constant(1), Spectrum::constant(3), Float(0.1));
  add("Black", Spectrum::constant(0), glass, Float(0.2));  // its diffuse lobe is never chosen
  add("Uncoated", ramp(Float(0.2), Float(0.8)), Spectrum::constant(1), Float(0.2));
}

void add_rough_glass(std::vector<BsdfCase>& cases) {
  const auto add = [&cases](std::string name, Spectrum eta, Ggx ggx, std::optional<ThinFilm> film = {}) {
    cases.push_back({.name = "RoughGlass" + std::move(name),
                     .make = [eta, ggx, film] { return RoughDielectric(eta, ggx, film); },
                     .is_reciprocal = true,
                     .conserves_energy = true,
                     .specular_step = 1e-5,
                     .interior_eta = eta,
                     .is_two_sided = true});
  };
  const Spectrum glass = Spectrum::constant(Float(1.5));
  // SCHOTT N-SF11 (catalogue, 2017): the lanes' lobes lie apart by as much as they are wide at alpha 0.02.
  const SellmeierSpectrum flint{.b = {Float(1.73759695), Float(0.313747346), Float(1.89878101)},
                                .c_um2 = {Float(0.013188707), Float(0.0623068142), Float(155.23629)}};
  add("Alpha002", glass, {Float(0.02), Float(0.02)});
  add("Alpha03", glass, {Float(0.3), Float(0.3)});
  add("Alpha1", glass, {1, 1});
  add("Anisotropic", glass, {Float(0.08), Float(0.4)});
  add("Bubble", Spectrum::constant(Float(0.75)), {Float(0.2), Float(0.2)});
  add("DispersiveNarrow", flint, {Float(0.02), Float(0.02)});
  add("DispersiveWide", flint, {Float(0.3), Float(0.3)});
  add("ThinFilm", glass, {Float(0.2), Float(0.2)},
      ThinFilm{.eta = Spectrum::constant(Float(2.2)), .thickness_nm = 300});
}

NormalTexture tilted_normals() {
  Image image(1, 1, {"R", "G", "B"});
  image.data = {0.62F, 0.44F, 0.97F};
  return NormalTexture(CachedImage(image));
}

/// Materials made of others. `interior_eta` of the glass among them.
void add_nested(std::vector<BsdfCase>& cases) {
  const auto add = [&cases](std::string name, std::function<std::optional<Material>()> make,
                            bool is_reciprocal, Float interior_eta = 1) {
    cases.push_back({.name = std::move(name),
                     .make = std::move(make),
                     .is_reciprocal = is_reciprocal,
                     .conserves_energy = true,
                     .interior_eta = Spectrum::constant(interior_eta),
                     .is_two_sided = true});
  };
  const auto grey = [] { return nest(Lambert{ramp(Float(0.1), Float(1))}); };
  const auto brushed = [] { return nest(RoughConductor{gold_like(), {Float(0.08), Float(0.4)}}); };
  const auto mirror = [] { return nest(SmoothConductor{gold_like()}); };
  const auto rough_glass = [] {
    return nest(RoughDielectric(Spectrum::constant(Float(1.5)), {Float(0.3), Float(0.3)}));
  };
  add(
      "TwoSided", [=] { return TwoSided(grey(), brushed()); }, true);
  add(
      "TwoSidedWithGlassBehind", [=] { return TwoSided(grey(), rough_glass()); }, false, Float(1.5));
  add(
      "Mix", [=] { return Mix(grey(), brushed(), Float(0.3)); }, true);
  add(
      "MixWithMirror", [=] { return Mix(grey(), mirror(), Float(0.7)); }, true);
  add(
      "MixWithGlass", [=] { return Mix(grey(), rough_glass(), Float(0.5)); }, true, Float(1.5));
  add(
      "MixOfMixes",
      [=] { return Mix(nest(Mix(grey(), brushed(), Float(0.5))), nest(plastic(Float(0.1))), Float(0.2)); },
      true);
  add(
      "Masked", [=] { return Masked(brushed(), Float(0.6)); }, true);
  add(
      "MaskedMix", [=] { return Mix(nest(Masked(grey(), Float(0.25))), brushed(), Float(0.3)); }, true);
  add(
      "NormalMappedLambert", [=] { return NormalMapped(grey(), tilted_normals()); }, false);
  add(
      "NormalMappedMetal", [=] { return NormalMapped(brushed(), tilted_normals()); }, false);
  add(
      "NormalMappedGlass", [=] { return NormalMapped(rough_glass(), tilted_normals()); }, false, Float(1.5));
}

/// Linear in sqrt(theta_h): 1e-6 rad is a twentieth of the first cell of these coarse grids.
constexpr double kSeparatedStep = 1e-4;

void add_separated(std::vector<BsdfCase>& cases) {
  for (const SeparationModel model : {SeparationModel::kSun, SeparationModel::kFresnel,
                                      SeparationModel::kDiffraction, SeparationModel::kResidual}) {
    for (const Float alpha : {Float(0.1), Float(0.4)}) {
      const std::string name = "Separated_" + name_of(model) + (alpha < Float(0.2) ? "_narrow" : "_wide");
      cases.push_back({.name = name,
                       .make = [model, alpha] { return SeparatedBrdf(separated_tables(alpha), model); },
                       .is_reciprocal = true,
                       .conserves_energy = false,
                       .specular_step = kSeparatedStep});
    }
    cases.push_back({.name = "Separated_" + name_of(model) + "_of_pearlescent",
                     .make = [model] { return SeparatedBrdf(separate_for_test("pearlescent"), model); },
                     .is_reciprocal = model != SeparationModel::kResidual,  // the measurement is not
                     .conserves_energy = false,
                     .specular_step = kSeparatedStep});
  }
}

/// The other forms that separation makes of a measurement.
void add_forms_of_pearlescent(std::vector<BsdfCase>& cases) {
  const auto add = [&cases](std::string name, std::function<std::optional<Material>()> make,
                            bool is_reciprocal = true) {
    cases.push_back({.name = std::move(name),
                     .make = std::move(make),
                     .is_reciprocal = is_reciprocal,
                     .conserves_energy = false,
                     .specular_step = kSeparatedStep});
  };
  for (const SeparationModel model : {SeparationModel::kSun, SeparationModel::kFresnel,
                                      SeparationModel::kDiffraction, SeparationModel::kResidual}) {
    add(
        "Compact_" + name_of(model),
        [model] {
          return SeparatedBrdf(std::make_shared<const CompactTables>(
                                   compact(*separate_for_test("pearlescent"), kDefaultQuality).tables),
                               model);
        },
        model != SeparationModel::kResidual);
  }
  add("AnalyticPerWavelength", [] {
    const auto tables = separate_for_test("pearlescent");
    return AnalyticBrdf(tables->axis, tables->analytic);
  });
  const auto table = [](const auto& make) {
    SeparationOptions options;
    options.grid = {.n_theta_h = 45, .n_theta_d = 30, .n_phi_d = 36};
    return std::make_shared<const HalfDifferenceTable>(
        make(MeasuredBrdf(acquire_for_test(built_in("pearlescent"))), options));
  };
  add("TableX", [table] { return TabulatedBrdf(table(tabulate)); });
  add(
      "OrientedTable", [table] { return TabulatedBrdf(table(tabulate_oriented)); }, false);
  const auto add_paired = [&cases](std::string name, std::function<PairedBrdf::Values()> values) {
    cases.push_back({.name = std::move(name), .make = [values] {
                       return PairedBrdf(values(), SeparatedBrdf(separate_for_test("pearlescent"),
                                                                 SeparationModel::kDiffraction));
                     }});
  };
  add_paired("PairedMeasurement", [] { return MeasuredBrdf(acquire_for_test(built_in("pearlescent"))); });
  add_paired("PairedPlainTable", [table] { return PlainTableBrdf(table(tabulate_plain)); });
}

void add_acquired(std::vector<BsdfCase>& cases) {
  const auto add = [&cases](std::string name, std::function<MeasuredTables()> measure) {
    cases.push_back(
        {.name = "Acquired" + std::move(name), .make = [measure] { return MeasuredBrdf(measure()); }});
  };
  add("Matte", [] { return acquire_for_test(built_in("matte")); });
  add("Pearlescent", [] { return acquire_for_test(built_in("pearlescent")); });
  add("NarrowPlastic", [] { return acquire_for_test(plastic(Float(0.02))); });
  const RoughConductor brushed{gold_like(), {Float(0.15), Float(0.4)}};
  add("Anisotropic", [brushed] { return acquire_for_test(brushed, 12); });
  add("AnisotropicHalf", [brushed] { return acquire_for_test(brushed, 8, 2); });
  add("AnisotropicQuarter", [brushed] { return acquire_for_test(brushed, 6, 4); });
}

void add_real(std::vector<BsdfCase>& cases) {
  const auto add = [&cases](const std::string& folder, const std::string& name) {
    cases.push_back({.name = "Measured_" + name, .make = [folder, name]() -> std::optional<Material> {
                       const std::filesystem::path file = data_folder() / folder / (name + ".bsdf");
                       if (!std::filesystem::exists(file)) return std::nullopt;
                       return MeasuredBrdf(read_measured(file));
                     }});
  };
  for (const char* name :
       {"acrylic_felt_green", "acrylic_felt_purple",  "acrylic_felt_white", "aurora_white",
        "cardboard",          "cc_green_malachite",   "cc_iris_purple_gem", "cc_nothern_aurora",
        "cg_sunflower",       "chm_light_blue",       "chm_mint",           "cm_military_green",
        "colodur_azure_4e",   "colodur_connemara_4c", "ilm_l3_37_matte",    "ilm_solo_m_68",
        "irid_flake_paint1",  "irid_flake_paint2",    "leaf_maple",         "paper_white",
        "satin_purple",       "vch_dragon_eye_red",   "vch_golden_yellow",  "vch_ultra_pink"}) {
    add("epfl_rgb", std::string(name) + "_rgb");
  }
  for (const char* name : {"aurora_white", "cc_nothern_aurora", "irid_flake_paint2", "paper_white"}) {
    add("epfl_uplifted", std::string(name) + "_spec");
  }
}

}  // namespace

const std::vector<BsdfCase>& bsdf_cases() {
  static const std::vector<BsdfCase> cases = [] {
    std::vector<BsdfCase> c;
    add_analytic(c);
    add_rough_glass(c);
    add_plastic(c);
    add_nested(c);
    add_separated(c);
    add_forms_of_pearlescent(c);
    add_acquired(c);
    add_real(c);
    return c;
  }();
  return cases;
}

const SampledWavelengths& test_wavelengths() {
  static const SampledWavelengths lambda = [] {
    std::array<Float, kLanes> nm{}, pdf{};
    for (int i = 0; i < kLanes; ++i)
      nm[std::size_t(i)] = Float(440) + Float(220) * Float(i) / Float(kLanes - 1);
    pdf.fill(1);
    return SampledWavelengths(nm, pdf);
  }();
  return lambda;
}

}  // namespace spectrace::test

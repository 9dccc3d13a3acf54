// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json.h"
#include "separation/separate.h"

namespace spectrace {
namespace {

constexpr std::string_view kFillRule =
    "below the horizon: nearest phi_d, then nearest theta_h; s_D drawn to s_F, s_F to s_sun where "
    "undetermined";

std::string_view text_of(CosineWeight weight) {
  return weight == CosineWeight::kProduct ? "product: max(cos_i cos_o, eps)"
                                          : "printed: max(cos_i, cos_o, eps)";
}
std::string_view spacing_of(const HalfDifferenceGrid& grid) {
  return grid.quadratic_theta_h ? "quadratic" : "uniform";
}

/// Root mean square over the axis.
double overall(const std::vector<double>& rms) {
  if (rms.empty()) return 0;
  double sum = 0;
  for (double x : rms) sum += x * x;
  return std::sqrt(sum / double(rms.size()));
}

double percent(std::size_t part, std::size_t whole) {
  return whole > 0 ? 100.0 * double(part) / double(whole) : 0.0;
}

void write_array(JsonWriter& json, std::string_view name, const std::vector<double>& values) {
  json.key(name);
  json.begin_array();
  for (double x : values) json.value(x);
  json.end_array();
}

void write_options(JsonWriter& json, const SeparationOptions& options) {
  json.key("options");
  json.begin_object();
  json.member("theta_h", options.grid.n_theta_h);
  json.member("theta_d", options.grid.n_theta_d);
  json.member("phi_d", options.grid.n_phi_d);
  json.member("theta_h_spacing", spacing_of(options.grid));
  json.member("weight", name_of(options.weight));
  json.member("epsilon", options.epsilon);
  json.member("colour", name_of(options.colour));
  json.member("diffuse", name_of(options.diffuse));
  json.member("residual", name_of(options.residual));
  json.member("starts", options.starts);
  json.member("diffraction_prior", options.diffraction_prior);
  json.member("residual_rank", options.residual_rank);
  json.member("reciprocal", options.reciprocal);
  json.end_object();
}

}  // namespace

std::string name_of(CosineWeight weight) { return weight == CosineWeight::kProduct ? "product" : "printed"; }
std::string name_of(DiffuseColour colour) { return colour == DiffuseColour::kDark ? "dark" : "printed"; }
std::string name_of(DiffuseForm form) { return form == DiffuseForm::kLambert ? "lambert" : "table"; }
std::string name_of(SpectralResidual residual) {
  return residual == SpectralResidual::kWhole ? "whole" : "printed";
}

std::string SeparationReport::brief() const {
  if (!usable) return verdict;
  return fmt::format("{}; rms log residual sun {:.4f}, fresnel {:.4f}, diffraction {:.4f}; {:.1f} s", verdict,
                     overall(rms_sun), overall(rms_fresnel), overall(rms_diffraction),
                     seconds_table + seconds_step1 + seconds_step2 + seconds_step3);
}

std::string SeparationReport::full() const {
  std::string text = fmt::format("{}\n", verdict);
  const auto line = [&text](std::string_view name, const std::string& value) {
    text += fmt::format("  {:<22}{}\n", name, value);
  };
  const auto cell_line = [&](std::string_view name, std::size_t n) {
    line(name, fmt::format("{:>9} ({:.1f} %)", n, percent(n, cells)));
  };
  if (source.samples > 0) {
    line("source", fmt::format("{}: {} samples, {} of them invalid; cells near none are filled, and count as "
                               "invalid",
                               source.format, source.samples, source.invalid_samples));
  }
  line("cells", fmt::format("{:>9}, theta_h {}", cells, spacing_of(options.grid)));
  cell_line("  measured", measured);
  cell_line("  extrapolated", extrapolated);
  cell_line("  invalid", invalid);
  cell_line("  below horizon", below_horizon);
  line("negative values", fmt::format("{:>9} of the file, clamped to 0", negative_values));
  line("fill rule", std::string(kFillRule));
  line("weight", std::string(text_of(options.weight)));
  if (!usable) return text;
  line("analytic fit", fmt::format("alpha_d {:.4f}, rho_0 {:.4g}, F_0 {:.4f}, a {:.4f}", fit.albedo_d,
                                   fit.rho_0, fit.f_0, fit.alpha));
  if (matte) line("matte", "Lambert alone explains the measurement: no specular lobe");
  line("step 1", fmt::format("cost {:.6g} -> {:.6g} in {} iterations, gradient {:.1e} per cell",
                             step1_initial_cost, step1_final_cost, step1_iterations, step1_gradient_max));
  line("diffuse colour",
       fmt::format("mean {:.4f}, {}{}", albedo_d,
                   dark_colour ? "read where the specular lobe is weakest" : "of eqs. 7 and 18",
                   albedo_scale < 1 ? fmt::format(", lowered to {:.1f} %: the measurement supports no more",
                                                  100 * albedo_scale)
                                    : std::string()));
  line("step 2", fmt::format("cost {:.6g}; {:.2f} % of the reflected light is specular", step2_cost,
                             100 * specular_share));
  line("diffuse lobe", fmt::format("{}; an exact Lambert lobe has {:.2f} % of the reflected light too much",
                                   name_of(options.diffuse), 100 * lambert_cost));
  line("step 3", fmt::format("rms log residual: sun {:.4f}, fresnel {:.4f}, diffraction {:.4f}",
                             overall(rms_sun), overall(rms_fresnel), overall(rms_diffraction)));
  if (unfinished > 0) {
    line("  unfinished", fmt::format("{} of its unknowns, at the iterations' limit", unfinished));
  }
  if (options.residual_rank > 0) {
    line("residual model",
         fmt::format("{:.1f} % of what the diffraction model leaves; clamped: {:.3f} % of it, {:.3f} % of "
                     "its odd part",
                     100 * residual_explained, 100 * residual_clamped_share,
                     100 * residual_odd_clamped_share));
  }
  line("eqs. 19 and 20", options.residual == SpectralResidual::kWhole
                             ? "whole: they compare the whole BRDF, as eq. 18 does"
                             : "printed: they compare what the diffuse lobe leaves, clamped at 0");
  return text;
}

std::string SeparationReport::costs() const {
  return fmt::format(
      "  {:<22}read {:.2f}, table {:.2f}, step 1 {:.2f}, step 2 {:.2f}, step 3 {:.2f}, analytic {:.2f}, "
      "residual {:.2f}, store {:.2f}\n  {:<22}{:.0f} MB at most\n",
      "seconds", seconds_read, seconds_table, seconds_step1, seconds_step2, seconds_step3, seconds_analytic,
      seconds_residual, seconds_store, "memory", double(peak_memory_bytes) * 1e-6);
}

std::string SeparationReport::json(bool with_timings) const {
  JsonWriter json;
  json.begin_object();
  json.member("usable", usable);
  json.member("verdict", verdict);
  write_options(json, options);
  json.key("source");
  json.begin_object();
  json.member("format", source.format);
  json.member("samples", source.samples);
  json.member("invalid_samples", source.invalid_samples);
  json.member("filled_cells", source.filled_cells);
  json.end_object();
  json.member("fill_rule", kFillRule);
  json.key("cells");
  json.begin_object();
  json.member("total", cells);
  json.member("measured", measured);
  json.member("extrapolated", extrapolated);
  json.member("invalid", invalid);
  json.member("below_horizon", below_horizon);
  json.end_object();
  json.member("negative_values", negative_values);
  json.key("analytic_fit");
  json.begin_object();
  json.member("matte", matte);
  json.member("albedo_d", fit.albedo_d);
  json.member("rho_0", fit.rho_0);
  json.member("f_0", fit.f_0);
  json.member("alpha", fit.alpha);
  json.end_object();
  json.member("step1_initial_cost", step1_initial_cost);
  json.member("step1_final_cost", step1_final_cost);
  json.member("step1_gradient_max", step1_gradient_max);
  json.member("step1_iterations", step1_iterations);
  json.member("dark_colour", dark_colour);
  json.member("albedo_scale", albedo_scale);
  json.member("albedo_d_mean", albedo_d);
  json.member("step2_cost", step2_cost);
  json.member("specular_share", specular_share);
  json.member("lambert_cost", lambert_cost);
  json.member("step3_unfinished", unfinished);
  write_array(json, "rms_sun", rms_sun);
  write_array(json, "rms_fresnel", rms_fresnel);
  write_array(json, "rms_diffraction", rms_diffraction);
  if (options.residual_rank > 0) {
    json.member("residual_explained", residual_explained);
    json.member("residual_clamped_share", residual_clamped_share);
    json.member("residual_odd_clamped_share", residual_odd_clamped_share);
  }
  if (with_timings) {
    json.key("seconds");
    json.begin_object();
    json.member("read", seconds_read);
    json.member("table", seconds_table);
    json.member("step1", seconds_step1);
    json.member("step2", seconds_step2);
    json.member("step3", seconds_step3);
    json.member("analytic", seconds_analytic);
    json.member("residual", seconds_residual);
    json.member("store", seconds_store);
    json.end_object();
    json.member("peak_memory_bytes", peak_memory_bytes);
  }
  json.end_object();
  return json.text();
}

}  // namespace spectrace

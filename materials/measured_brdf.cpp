// SPDX-License-Identifier: Apache-2.0
// Dupuy & Jakob 2018, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering". What
// the file calls incident, the direction its slices are indexed by, is our wo.
#include "materials/measured_brdf.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/math/math.h"
#include "materials/normal_square.h"

namespace spectrace {

namespace {

/// Least u · sin θm of the half vector's density: at u = sqrt(2 θm / π) it is π/2 u³, and single precision
/// does not tell half vectors of θm < 6e-8 (u < 2e-4) from the normal.
constexpr Float kLeastPole = Float(1e-11);

/// |wo + wi| below which the sum is the rounding of two unit vectors: wi = -wo (hard case H4).
constexpr Float kLeastSum = Float(0x1p-22);

/// Least density of sampling a cell, relative to its mean over the spectral axis. The stored luminance is
/// that of the eye, 0 for what reflects only in the infrared; the mean bounds the weights there too.
constexpr float kSamplingFloor = 0.125f;

/// Rotations by half a turn and mirrors: a sign for x and one for y, their own inverse.
struct Flip {
  Float x = 1, y = 1;
  [[nodiscard]] Vec3 operator()(Vec3 w) const { return {w.x * x, w.y * y, w.z}; }
};

struct AzimuthRange {
  Float middle = 0;   ///< of the stored phi_i [rad]
  Vec2 towards;       ///< its cos and sin
  int reduction = 1;  ///< they span 2π / reduction

  explicit AzimuthRange(const MeasuredTables& tables)
      : middle((tables.phi_i.front() + tables.phi_i.back()) / 2),
        towards{std::cos(middle), std::sin(middle)},
        reduction(tables.symmetry_reduction()) {}

  /// What brings wo, and wi with it, into the stored range.
  [[nodiscard]] Flip flip_into(Vec3 wo) const {
    const Float x = wo.x * towards.x, y = wo.y * towards.y;
    if (reduction == 4) return {x < 0 ? Float(-1) : Float(1), y < 0 ? Float(-1) : Float(1)};
    return reduction == 2 && x + y < 0 ? Flip{-1, -1} : Flip{};
  }
  /// `phi` plus whole turns, as near to the middle as can be.
  [[nodiscard]] Float wrap(Float phi) const { return phi - 2 * kPi * std::round((phi - middle) / (2 * kPi)); }
};

/// wo, flipped into the stored range, in the coordinates of the tables.
struct Incident {
  Flip flip;
  Vec3 wo;
  Vec2 azimuth{1, 0};  ///< cos and sin of its azimuth
  Float theta = 0;
  Float half_over_sigma = 0;  ///< 1 / (4 sigma), or 1 where the tables hold f·cos itself; 0 where sigma is 0
  Warp2D::Blend slices;
};

/// The half vector in the tables' coordinates.
struct Half {
  Vec2 u;
  Float density = 0;  ///< unit-square area per solid angle of wi [1/sr]
};

/// Densities over the unit square of `u` become densities over wi by the Jacobians of the polar coordinates,
/// 2π² u sin θm, and of reflection, 4 wo·wm (Walter et al. 2007, eq. 14).
Float unit_area_per_solid_angle(Float u, Float sin_theta_m, Float wo_dot_wm) {
  return 1 / (2 * sqr(kPi) * std::max(u * sin_theta_m, kLeastPole) * 4 * wo_dot_wm);
}

/// [slice][axis][cell] to [slice][cell][axis]: a lookup then reads one short run a cell.
std::vector<float> axis_last(const MeasuredTables& tables) {
  const std::size_t axis = tables.axis.size(), cells = std::size_t(tables.table_size) * tables.table_size;
  SPECTRACE_CHECK(tables.spectra.size() == tables.slices() * axis * cells);
  std::vector<float> out(tables.spectra.size());
  for (std::size_t s = 0; s < tables.slices(); ++s) {
    for (std::size_t k = 0; k < axis; ++k) {
      const float* const from = tables.spectra.data() + (s * axis + k) * cells;
      float* const to = out.data() + s * cells * axis + k;
      for (std::size_t i = 0; i < cells; ++i) to[i * axis] = from[i];
    }
  }
  return out;
}

/// The stored luminance, raised where it says too little of the spectra (`rows`: axis last).
std::vector<Float> sampling_table(const MeasuredTables& tables, const std::vector<float>& rows) {
  const std::size_t axis = tables.axis.size();
  std::vector<Float> out(tables.luminance.begin(), tables.luminance.end());
  for (std::size_t i = 0; i < out.size(); ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < axis; ++k) sum += rows[i * axis + k];
    out[i] = std::max(out[i], Float(kSamplingFloor * sum / double(axis)));
  }
  return out;
}

MeasuredTables without_spectra(MeasuredTables tables) {
  tables.spectra.clear();
  tables.spectra.shrink_to_fit();
  return tables;
}

std::vector<Float> to_floats(const std::vector<float>& values) { return {values.begin(), values.end()}; }

}  // namespace

struct MeasuredBrdf::Data {
  MeasuredTables tables;
  Float last_measured_theta_i;
  AzimuthRange range;
  std::vector<float> rows;  // [phi_i][theta_i][y][x][axis]
  Warp2D ndf, sigma, vndf, sampling;

  explicit Data(const MeasuredTables& t);
  [[nodiscard]] Incident incident(Vec3 wo) const;
  /// nullopt for wi = -wo.
  [[nodiscard]] std::optional<Half> half(const Incident& in, Vec3 wi_unflipped) const;
  [[nodiscard]] Vec3 half_vector(const Incident& in, UnitPoint u) const;
  [[nodiscard]] Footprint footprint(const Incident& in, UnitPoint u, UnitPoint s) const;
  [[nodiscard]] SampledSpectrum apply(const Footprint& at, const SampledWavelengths& lambda) const;
};

MeasuredBrdf::Data::Data(const MeasuredTables& t)
    : tables(without_spectra(t)),
      last_measured_theta_i(t.last_measured_theta_i()),
      range(t),
      rows(axis_last(t)) {
  const std::vector<Float> phi = to_floats(t.phi_i), theta = to_floats(t.theta_i), none{0};
  ndf = Warp2D(none, none, t.ndf_width, t.ndf_height, to_floats(t.ndf), false);
  sigma = Warp2D(none, none, t.ndf_width, t.ndf_height, to_floats(t.sigma), false);
  vndf = Warp2D(phi, theta, t.warp_size, t.warp_size, to_floats(t.vndf), true);
  sampling = Warp2D(phi, theta, t.table_size, t.table_size, sampling_table(t, rows), true);
}

Incident MeasuredBrdf::Data::incident(Vec3 wo) const {
  Incident in;
  in.flip = range.flip_into(wo);
  in.wo = in.flip(wo);
  const Float sin_theta = std::sqrt(sqr(wo.x) + sqr(wo.y));
  // Not acos: it loses half the digits near the normal.
  in.theta = std::atan2(sin_theta, wo.z);
  if (sin_theta > 0) in.azimuth = {in.wo.x / sin_theta, in.wo.y / sin_theta};
  const Float phi = std::atan2(in.azimuth.y, in.azimuth.x);
  const Vec2 u{polar_coordinate(in.theta), azimuth_coordinate(phi)};
  in.half_over_sigma = tables.jacobian ? safe_div(1, 4 * sigma.eval(u)) : Float(1);
  in.slices = vndf.blend({range.wrap(phi), in.theta});
  return in;
}

std::optional<Half> MeasuredBrdf::Data::half(const Incident& in, Vec3 wi_unflipped) const {
  const Vec3 h = in.wo + in.flip(wi_unflipped);
  const Float along = std::sqrt(sqr(h.x) + sqr(h.y)), norm = length(h);
  if (!(norm >= kLeastSum)) return std::nullopt;
  Half out;
  out.u = {polar_coordinate(std::atan2(along, h.z)), Float(0.5)};  // at the pole: a fixed azimuth
  if (along > 0) {
    // Isotropic: the azimuth from that of wo, as one angle, so that it does not change when both are turned.
    const Float phi = tables.is_isotropic() ? std::atan2(h.y * in.azimuth.x - h.x * in.azimuth.y,
                                                         h.x * in.azimuth.x + h.y * in.azimuth.y)
                                            : std::atan2(h.y, h.x);
    out.u.y = azimuth_coordinate(phi);
  }
  out.density = unit_area_per_solid_angle(out.u.x, along / norm, norm / 2);  // |wo + wi| = 2 wo·wm
  return out;
}

/// Of the flipped frame; the inverse of half().
Vec3 MeasuredBrdf::Data::half_vector(const Incident& in, UnitPoint u) const {
  const Float theta = polar_angle(Float(u.x)), phi = azimuth_angle(Float(u.y));
  const Float x = std::sin(theta) * std::cos(phi), y = std::sin(theta) * std::sin(phi), z = std::cos(theta);
  if (!tables.is_isotropic()) return {x, y, z};
  return {x * in.azimuth.x - y * in.azimuth.y, x * in.azimuth.y + y * in.azimuth.x, z};
}

MeasuredBrdf::Footprint MeasuredBrdf::Data::footprint(const Incident& in, UnitPoint u, UnitPoint s) const {
  const Float scale = in.half_over_sigma * (tables.jacobian ? ndf.eval(u) : Float(1));
  const int m = tables.table_size;
  const Warp2D::Cell column = Warp2D::cell_at(s.x, m), row = Warp2D::cell_at(s.y, m);
  const std::array<double, 2> along_x{1 - column.fraction, column.fraction},
      along_y{1 - row.fraction, row.fraction};
  Footprint out;
  out.extrapolated = in.theta > last_measured_theta_i;
  for (int k = 0; k < in.slices.count; ++k) {
    const std::size_t first =
        in.slices.slice[k] * std::size_t(m) * m + std::size_t(row.index) * m + column.index;
    for (int y = 0; y < 2; ++y) {
      for (int x = 0; x < 2; ++x) {
        out.row[out.count] = static_cast<std::uint32_t>(first + std::size_t(y) * m + x);
        out.weight[out.count] = static_cast<float>(scale * in.slices.weight[k] * along_y[y] * along_x[x]);
        ++out.count;
      }
    }
  }
  return out;
}

SampledSpectrum MeasuredBrdf::Data::apply(const Footprint& at, const SampledWavelengths& lambda) const {
  const SpectralAxis::Lookup lookup = tables.axis.lookup(lambda);
  if (tables.axis.is_rgb()) {
    std::array<float, 3> rgb{};  // linear: three channels added up first are cheaper than kLanes
    for (int i = 0; i < at.count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) rgb[k] += at.weight[i] * rows[at.row[i] * std::size_t(3) + k];
    }
    return lookup.apply(rgb.data());
  }
  SampledSpectrum out;
  for (int i = 0; i < at.count; ++i) {
    out += lookup.apply(rows.data() + at.row[i] * tables.axis.size()) * Float(at.weight[i]);
  }
  return out;
}

MeasuredBrdf::MeasuredBrdf(const MeasuredTables& tables) : data_(std::make_shared<const Data>(tables)) {}

BsdfValue MeasuredBrdf::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (!(wo.z > 0 && wi.z > 0)) return {};
  const Data& d = *data_;
  const Incident in = d.incident(wo);
  const std::optional<Half> half = d.half(in, wi);
  if (!half) return {};
  const Warp2D::Sample s = d.vndf.invert(half->u, in.slices);
  return {.value_cos = d.apply(d.footprint(in, half->u, s.position), at.lambda),
          .pdf = d.sampling.eval(s.position, in.slices) * s.pdf * half->density};
}

LobeValues MeasuredBrdf::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  return {.diffuse = {}, .fresnel = evaluate(wo, wi, at).value_cos, .diffraction = {}};
}

std::optional<BsdfSample> MeasuredBrdf::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  if (!(wo.z > 0)) return std::nullopt;
  const Data& d = *data_;
  const Incident in = d.incident(wo);
  const Warp2D::Sample s = d.sampling.sample(u.direction, in.slices);
  const Warp2D::Sample m = d.vndf.sample(s.position, in.slices);
  const Vec3 wm = d.half_vector(in, m.position);
  const Float wo_dot_wm = dot(in.wo, wm);
  if (!(2 * wo_dot_wm >= kLeastSum)) return std::nullopt;  // or the half vector faces away
  const Vec3 wi = in.flip(wm * (2 * wo_dot_wm) - in.wo);
  const Float sin_theta_m = std::sqrt(sqr(wm.x) + sqr(wm.y));
  const Float pdf = s.pdf * m.pdf * unit_area_per_solid_angle(Float(m.position.x), sin_theta_m, wo_dot_wm);
  if (!(wi.z > 0 && pdf > 0)) return std::nullopt;
  const SampledSpectrum value_cos = d.apply(d.footprint(in, m.position, s.position), at.lambda);
  return BsdfSample{.wi = wi, .weight = value_cos / pdf, .pdf = pdf, .lobe = Lobe::kSpecular};
}

std::optional<MeasuredBrdf::Footprint> MeasuredBrdf::footprint(Vec3 wo, Vec3 wi) const {
  if (!(wo.z > 0 && wi.z > 0)) return std::nullopt;
  const Data& d = *data_;
  const Incident in = d.incident(wo);
  const std::optional<Half> half = d.half(in, wi);
  if (!half) return std::nullopt;
  Footprint out = d.footprint(in, half->u, d.vndf.invert(half->u, in.slices).position);
  float all = 0, measured = 0;
  for (int i = 0; i < out.count; ++i) {
    all += out.weight[i];
    if (d.tables.valid.empty() || d.tables.valid[out.row[i]] != 0) measured += out.weight[i];
  }
  out.measured = !out.extrapolated && all > 0 && measured >= all / 2;
  return out;
}

const float* MeasuredBrdf::spectrum(std::uint32_t row) const {
  return data_->rows.data() + row * data_->tables.axis.size();
}

const SpectralAxis& MeasuredBrdf::axis() const { return data_->tables.axis; }

float MeasuredBrdf::last_measured_theta_i() const { return data_->last_measured_theta_i; }
const MeasuredTables& MeasuredBrdf::tables() const { return data_->tables; }

}  // namespace spectrace

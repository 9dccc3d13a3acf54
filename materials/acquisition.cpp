// SPDX-License-Identifier: Apache-2.0
#include "materials/acquisition.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "core/base/error.h"
#include "core/base/memory.h"
#include "core/math/math.h"
#include "core/math/warp2d.h"
#include "core/spectra/color.h"
#include "materials/backscatter_ndf.h"
#include "materials/normal_square.h"

namespace spectrace {

namespace {

/// The weight of a wavelength in `luminance`, which drives sampling: the observer's, and a floor so that what
/// reflects only outside the visible is still drawn.
constexpr double kInvisibleWeight = 0.01;

/// Table nodes lie on the border of the unit square, where the density of visible normals is 0 and the warp
/// leads to an arbitrary point beyond the last visible one: measure this far inside instead.
constexpr Float kBorder = Float(1e-4);

class MaterialSource final : public BrdfSource {
 public:
  MaterialSource(const Material& material, const std::vector<float>& lambda_nm)
      : material_(material), axis_(SpectralAxis::wavelengths(lambda_nm)) {
    for (std::size_t i = 0; i < lambda_nm.size(); i += kLanes) {
      std::array<Float, kLanes> lambda{}, pdf{};
      for (std::size_t j = 0; j < kLanes; ++j) lambda[j] = lambda_nm[std::min(i + j, lambda_nm.size() - 1)];
      pdf.fill(1);
      chunks_.emplace_back(lambda, pdf);
    }
  }

  [[nodiscard]] const SpectralAxis& axis() const override { return axis_; }
  bool read(Vec3 wo, Vec3 wi, std::span<float> value_cos) const override {
    for (std::size_t i = 0; i < value_cos.size(); i += kLanes) {
      const BsdfValue v = evaluate(material_, wo, wi, {.lambda = chunks_[i / kLanes]});
      for (std::size_t j = i; j < std::min(i + kLanes, value_cos.size()); ++j) {
        value_cos[j] = static_cast<float>(v.value_cos[int(j - i)]);
      }
    }
    return true;
  }

 private:
  const Material& material_;
  SpectralAxis axis_;
  std::vector<SampledWavelengths> chunks_;
};

/// All of a source's axis at one direction pair.
class Detector {
 public:
  explicit Detector(const BrdfSource& source) : source_(source), value_cos_(source.axis().size()) {
    if (source.axis().is_rgb()) {
      weight_ = {0.2126, 0.7152, 0.0722};  // of linear sRGB: Rec. ITU-R BT.709
    } else {
      for (const float l : source.axis().lambda_nm()) weight_.push_back(cie_xyz_bar(l)[1] + kInvisibleWeight);
    }
    const double sum = std::accumulate(weight_.begin(), weight_.end(), 0.0);
    for (double& w : weight_) w /= sum;
  }

  /// f cosθi over the axis; valid until the next call.
  const std::vector<float>& measure(Vec3 wo, Vec3 wi) {
    is_known_ = source_.read(wo, wi, value_cos_);
    return value_cos_;
  }
  /// Of the last measurement: BrdfSource::read()'s answer.
  [[nodiscard]] bool is_known() const { return is_known_; }
  [[nodiscard]] double luminance(const std::vector<float>& spectrum) const {
    return std::inner_product(weight_.begin(), weight_.end(), spectrum.begin(), 0.0);
  }

 private:
  const BrdfSource& source_;
  std::vector<double> weight_;
  std::vector<float> value_cos_;
  bool is_known_ = false;
};

std::vector<Float> to_axis(const std::vector<float>& v) { return {v.begin(), v.end()}; }

Vec3 spherical(Float theta, Float phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// The tables' grid without their values.
MeasuredTables empty_tables(const AcquisitionOptions& options, const SpectralAxis& axis) {
  MeasuredTables t;
  t.file_name = options.description;
  t.description = options.description;
  const double last_cos = std::cos(options.last_elevation_deg * kPi64 / 180);
  const int measured = options.elevations - 1;
  for (int i = 0; i < measured; ++i) {
    t.theta_i.push_back(static_cast<float>(std::acos(1 - (1 - last_cos) * i / (measured - 1))));
  }
  t.theta_i.push_back(static_cast<float>(kPi64 / 2));
  if (options.azimuths == 1) {
    t.phi_i = {0};
  } else {
    for (int i = 0; i < options.azimuths; ++i) {
      t.phi_i.push_back(
          static_cast<float>(-kPi64 + 2 * kPi64 / options.symmetry * i / (options.azimuths - 1)));
    }
  }
  t.warp_size = options.warp_size;
  t.table_size = options.table_size;
  t.axis = axis;
  return t;
}

/// Where the normals are looked up for a slice: isotropic tables turn with the incident azimuth, which is 0.
struct Slice {
  std::size_t index;
  Vec3 wo;
  WarpParams params;
};

std::vector<Slice> slices_of(const MeasuredTables& t) {
  std::vector<Slice> slices;
  for (const float phi : t.phi_i) {
    for (const float theta : t.theta_i)
      slices.push_back({slices.size(), spherical(theta, phi), {phi, theta}});
  }
  return slices;
}

/// D(ωm) max(0, ωo·ωm) / σ(ωo) and the square's Jacobian, scaled as the database does: each slice sums to 1.
void fill_visible_normals(MeasuredTables& t, const Warp2D& ndf, const std::vector<Slice>& slices) {
  const int n = t.warp_size;
  for (const Slice& slice : slices) {
    std::vector<double> density;
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        const Vec2 s{Float(x) / Float(n - 1), Float(y) / Float(n - 1)};
        const double visible = std::max(dot(slice.wo, square_to_normal(s)), Float(0));
        density.push_back(double(ndf.eval(s)) * visible * double(normal_square_jacobian(s)));
      }
    }
    const double sum = std::accumulate(density.begin(), density.end(), 0.0);
    for (const double d : density) t.vndf.push_back(static_cast<float>(sum > 0 ? d / sum : 0));
  }
}

/// One slice: at each node of the unit square the warp of visible normals gives ωm, mirroring gives ωi, and
/// f cosθi = spectra · D / (4 σ) (Dupuy & Jakob 2018, eq. 5) is solved for `spectra`.
void measure_slice(MeasuredTables& t, const Slice& slice, const Warp2D& vndf, const Warp2D& ndf, Float sigma,
                   Detector& detector) {
  const auto m = static_cast<std::size_t>(t.table_size), cells = m * m;
  for (std::size_t i = 0; i < cells; ++i) {
    const auto inside = [m](std::size_t node) {
      return std::clamp(Float(node) / Float(m - 1), kBorder, 1 - kBorder);
    };
    const Vec2 position = vndf.sample({inside(i % m), inside(i / m)}, slice.params).position;
    const Vec3 wm = square_to_normal(position);
    const Float cos_half = dot(slice.wo, wm), density = ndf.eval(position);
    const Vec3 wi = wm * (2 * cos_half) - slice.wo;
    if (cos_half <= 0 || wi.z <= 0 || density <= 0) continue;
    const std::vector<float>& value_cos = detector.measure(slice.wo, wi);
    const Float scale = 4 * sigma / density;
    for (std::size_t l = 0; l < value_cos.size(); ++l) {
      t.spectra[(slice.index * t.axis.size() + l) * cells + i] = value_cos[l] * static_cast<float>(scale);
    }
    t.luminance[slice.index * cells + i] = static_cast<float>(detector.luminance(value_cos) * double(scale));
    t.valid[slice.index * cells + i] = detector.is_known() ? 1 : 0;
    if (!detector.is_known()) ++t.source.filled_cells;
  }
}

/// The database's 90-degree slices repeat the last measured ones, flags included (hard case H1).
void repeat_last_measured(MeasuredTables& t) {
  const std::size_t elevations = t.theta_i.size(),
                    table = std::size_t(t.table_size) * std::size_t(t.table_size);
  const auto repeat = [elevations](auto& v, std::size_t slice_size, std::size_t last) {
    const auto to = v.begin() + static_cast<std::ptrdiff_t>((last + elevations - 1) * slice_size);
    std::copy(to - static_cast<std::ptrdiff_t>(slice_size), to, to);
  };
  for (std::size_t first = 0; first < t.slices(); first += elevations) {
    repeat(t.spectra, table * t.axis.size(), first);
    repeat(t.luminance, table, first);
    repeat(t.valid, table, first);
  }
}

/// Is f the same after turning both directions? Three pairs a third of a turn apart.
bool looks_anisotropic(Detector& detector) {
  constexpr double kSame = 1e-3;  // single precision and thin highlights
  const double reference = detector.luminance(detector.measure(spherical(1, 0), spherical(Float(0.7), 2)));
  for (const Float turn : {Float(0.6), Float(1.3), Float(2.9)}) {
    const double l =
        detector.luminance(detector.measure(spherical(1, turn), spherical(Float(0.7), 2 + turn)));
    if (std::abs(l - reference) > kSame * std::max(l, reference)) return true;
  }
  return false;
}

}  // namespace

std::vector<float> AcquisitionOptions::epfl_wavelengths_nm() {
  constexpr int kCount = 195;
  constexpr double kFirst = 358.63, kLast = 1001.89;
  std::vector<float> lambda_nm;
  for (int i = 0; i < kCount; ++i)
    lambda_nm.push_back(static_cast<float>(kFirst + (kLast - kFirst) * i / (kCount - 1)));
  return lambda_nm;
}

std::string AcquisitionOptions::problem() const {
  const auto within = [](int x, int min, int max) { return x >= min && x <= max; };
  if (!within(elevations, 3, 64)) return "elevations must lie in [3, 64]";
  if (!(last_elevation_deg > 0 && last_elevation_deg < 90)) return "last_elevation_deg must lie in (0, 90)";
  if (azimuths != 1 && !within(azimuths, 4, 64)) return "azimuths must be 1 or lie in [4, 64]";
  if (symmetry != 1 && symmetry != 2 && symmetry != 4) return "symmetry must be 1, 2 or 4";
  if (azimuths == 1 && symmetry != 1) return "symmetry needs more than one azimuth";
  if (!within(ndf_size, 8, 256)) return "ndf_size must lie in [8, 256]";
  if (!within(ndf_azimuths, 5, 65)) return "ndf_azimuths must lie in [5, 65]";
  if (!within(warp_size, 8, 512)) return "warp_size must lie in [8, 512]";
  if (!within(table_size, 4, 256)) return "table_size must lie in [4, 256]";
  if (lambda_nm.empty() ||
      std::adjacent_find(lambda_nm.begin(), lambda_nm.end(), std::greater_equal<>()) != lambda_nm.end()) {
    return "lambda_nm must increase";
  }
  return "";
}

MeasuredTables acquire(const Material& material, const AcquisitionOptions& options, Progress& progress) {
  if (has_delta_lobe(material)) {
    throw InputError(options.description, "", "a mirror, and a hole, has no finite BRDF to measure");
  }
  if (is_transmissive(material)) {
    throw InputError(options.description, "", "light passes through this material: no BRDF holds all of it");
  }
  if (const std::string problem = options.problem(); !problem.empty()) {
    throw InputError(options.description, "", problem);
  }
  return acquire(MaterialSource(material, options.lambda_nm), options, progress);
}

MeasuredTables acquire(const BrdfSource& source, const AcquisitionOptions& options, Progress& progress) {
  if (const std::string problem = options.problem(); !problem.empty()) {
    throw InputError(options.description, "", problem);
  }
  // Three copies of the spectra: as tables, as fields of the file, and as its bytes.
  require_memory(3 * sizeof(float) * std::uint64_t(options.azimuths) * std::uint64_t(options.elevations) *
                     source.axis().size() * std::uint64_t(options.table_size) *
                     std::uint64_t(options.table_size),
                 options.description, "", "a measurement of so many directions");
  Detector detector(source);
  const bool is_isotropic = options.azimuths == 1;
  if (is_isotropic && looks_anisotropic(detector)) {
    progress.note("the material changes with azimuth, but is measured as isotropic, at azimuth 0");
  }
  MeasuredTables t = empty_tables(options, source.axis());
  NormalDistribution normals =
      ndf_from_backscatter([&](Vec3 w) { return detector.luminance(detector.measure(w, w)); },
                           options.ndf_size, is_isotropic ? 2 : options.ndf_azimuths);
  t.ndf_width = normals.width;
  t.ndf_height = normals.height;
  t.ndf = std::move(normals.ndf);
  t.sigma = std::move(normals.sigma);
  if (*std::max_element(t.ndf.begin(), t.ndf.end()) <= 0) {
    throw InputError(options.description, "", "the material scatters nothing back: it cannot be measured");
  }

  const std::array<Float, 1> one{0};
  const Warp2D ndf(one, one, t.ndf_width, t.ndf_height, to_axis(t.ndf), false);
  const Warp2D sigma(one, one, t.ndf_width, t.ndf_height, to_axis(t.sigma), false);
  const std::vector<Slice> slices = slices_of(t);
  fill_visible_normals(t, ndf, slices);
  const Warp2D vndf(to_axis(t.phi_i), to_axis(t.theta_i), t.warp_size, t.warp_size, to_axis(t.vndf), true);

  const std::size_t table = std::size_t(t.table_size) * std::size_t(t.table_size);
  t.spectra.assign(slices.size() * t.axis.size() * table, 0);
  t.luminance.assign(slices.size() * table, 0);
  t.valid.assign(slices.size() * table, 0);
  const std::size_t elevations = t.theta_i.size();
  for (const Slice& slice : slices) {
    progress.update("acquire", double(slice.index), double(slices.size()));
    if (slice.index % elevations == elevations - 1) continue;  // 90 degrees: not measurable
    measure_slice(t, slice, vndf, ndf, sigma.eval(normal_to_square(slice.wo)), detector);
  }
  repeat_last_measured(t);
  progress.update("acquire", 1, 1);
  return t;
}

}  // namespace spectrace

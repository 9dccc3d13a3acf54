// SPDX-License-Identifier: Apache-2.0
// Separated materials of any shape, written and read again, are what they were: in both forms of `.sep`.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "materials/compact_tables.h"
#include "materials/separated_tables.h"

namespace spectrace::test {
namespace {

std::vector<float> values(std::size_t count) {
  return *rc::gen::container<std::vector<float>>(
      count, rc::gen::map(rc::gen::inRange(0, 1 << 20), [](int i) { return float(i) / 4096; }));
}

std::vector<float> shares(std::size_t count) {
  return *rc::gen::container<std::vector<float>>(
      count, rc::gen::map(rc::gen::inRange(0, 257), [](int i) { return float(i) / 256; }));
}

std::string text() { return *rc::gen::container<std::string>(rc::gen::inRange<char>(' ', '\x7f')); }

template <typename Byte>
std::vector<Byte> bytes(std::size_t count) {
  return *rc::gen::container<std::vector<Byte>>(
      count, rc::gen::map(rc::gen::inRange(-127, 128), [](int i) { return static_cast<Byte>(i); }));
}

SpectralAxis random_axis() {
  if (*rc::gen::arbitrary<bool>()) return SpectralAxis::rgb();
  std::vector<float> nm(std::size_t(*rc::gen::inRange(1, 6)));
  float at = 360;
  for (float& x : nm) x = at += float(*rc::gen::inRange(1, 100));
  return SpectralAxis::wavelengths(nm);
}

HalfDifferenceGrid random_grid() {
  return {.n_theta_h = *rc::gen::inRange(2, 5),
          .n_theta_d = *rc::gen::inRange(2, 5),
          .n_phi_d = *rc::gen::inRange(2, 5),
          .quadratic_theta_h = *rc::gen::arbitrary<bool>()};
}

/// A ratio's byte is its value over `step`.
ResidualTable random_residual(const HalfDifferenceGrid& grid, std::size_t axis) {
  ResidualTable residual;
  residual.rank = std::size_t(*rc::gen::inRange(0, 3));
  if (residual.rank == 0) return residual;
  residual.axis_size = axis;
  residual.step = 1.0F / 64;
  residual.basis = values(residual.rank * axis);
  residual.ratio = bytes<std::int8_t>(grid.size() * residual.rank);
  if (*rc::gen::arbitrary<bool>()) residual.odd = bytes<std::int8_t>(grid.size() * residual.rank);
  return residual;
}

std::vector<float> random_analytic(std::size_t axis) {
  if (*rc::gen::arbitrary<bool>()) return {};
  std::vector<float> all = shares(3 * axis);  // albedo, rho_0 and f_0 may be 0, alpha may not
  all.insert(all.end(), axis, 0.25F);
  return all;
}

template <typename Tables>
void expect_same_frame(const Tables& a, const Tables& b) {
  RC_ASSERT(a.grid.n_theta_h == b.grid.n_theta_h && a.grid.n_theta_d == b.grid.n_theta_d);
  RC_ASSERT(a.grid.n_phi_d == b.grid.n_phi_d);
  RC_ASSERT(a.grid.quadratic_theta_h == b.grid.quadratic_theta_h);
  RC_ASSERT(a.axis.is_rgb() == b.axis.is_rgb());
  const auto nm_a = a.axis.lambda_nm(), nm_b = b.axis.lambda_nm();
  RC_ASSERT(std::vector<float>(nm_a.begin(), nm_a.end()) == std::vector<float>(nm_b.begin(), nm_b.end()));
  RC_ASSERT(a.c_d == b.c_d && a.diffuse_shape == b.diffuse_shape && a.s_sun == b.s_sun);
  RC_ASSERT(a.s_fresnel == b.s_fresnel && a.s_diffraction == b.s_diffraction && a.analytic == b.analytic);
  RC_ASSERT(a.residual.rank == b.residual.rank && a.residual.basis == b.residual.basis);
  RC_ASSERT(a.residual.ratio == b.residual.ratio && a.residual.odd == b.residual.odd);
  RC_ASSERT(a.residual.is_empty() || a.residual.step == b.residual.step);
  RC_ASSERT(a.source_name == b.source_name && a.source_sha256 == b.source_sha256);
  RC_ASSERT(a.report_json == b.report_json);
}

RC_GTEST_PROP(SeparatedRoundTrip, OfPlainTablesIsExact, ()) {
  SeparatedTables tables;
  tables.grid = random_grid();
  tables.axis = random_axis();
  const std::size_t n = tables.axis.size();
  tables.c_d = shares(n);
  if (*rc::gen::arbitrary<bool>()) tables.diffuse_shape = shares(tables.grid.size());
  tables.rho_s = values(tables.grid.size());
  tables.s_sun = values(n);
  tables.s_fresnel = values(std::size_t(tables.grid.n_theta_d) * n);
  tables.s_diffraction = values(tables.grid.angular_size() * n);
  tables.analytic = random_analytic(n);
  tables.residual = random_residual(tables.grid, n);
  tables.source_name = text(), tables.source_sha256 = text(), tables.report_json = text();

  const std::vector<std::byte> file = separated_to_tensors(tables).serialize();
  const SeparatedTables read = separated_from_tensors(TensorFile::parse(file, "x.sep"));
  expect_same_frame(tables, read);
  RC_ASSERT(tables.rho_s == read.rho_s);
  RC_ASSERT(separated_to_tensors(read).serialize() == file);
}

RC_GTEST_PROP(SeparatedRoundTrip, OfCompactTablesIsExact, ()) {
  CompactTables tables;
  tables.grid = random_grid();
  tables.axis = random_axis();
  const std::size_t n = tables.axis.size();
  tables.octaves_per_code = 1.0F / float(1 << *rc::gen::inRange(1, 8));
  tables.rho_s = LogCodes::encode(values(tables.grid.size()), tables.octaves_per_code);
  tables.c_d = shares(n);
  tables.s_sun = values(n);
  tables.rank = std::size_t(*rc::gen::inRange(1, 4));
  tables.basis = values(tables.rank * n);
  tables.s_fresnel = values(std::size_t(tables.grid.n_theta_d) * tables.rank);
  tables.s_diffraction = values(tables.grid.angular_size() * tables.rank);
  if (*rc::gen::arbitrary<bool>()) tables.diffuse_shape = bytes<std::uint8_t>(tables.grid.size());
  tables.analytic = random_analytic(n);
  tables.residual = random_residual(tables.grid, n);
  tables.source_name = text(), tables.source_sha256 = text(), tables.report_json = text();

  const std::vector<std::byte> file = compact_to_tensors(tables).serialize();
  const CompactTables read = compact_from_tensors(TensorFile::parse(file, "x.sep"));
  RC_ASSERT(read.rank == tables.rank);
  RC_ASSERT(read.octaves_per_code == tables.octaves_per_code);
  RC_ASSERT(read.rho_s.code == tables.rho_s.code && read.rho_s.level == tables.rho_s.level);
  // Some of its tables are kept in fewer bits: what was read once is what is read ever after.
  RC_ASSERT(compact_to_tensors(read).serialize() == file);
  const CompactTables again =
      compact_from_tensors(TensorFile::parse(compact_to_tensors(read).serialize(), "x.sep"));
  expect_same_frame(read, again);
}

}  // namespace
}  // namespace spectrace::test

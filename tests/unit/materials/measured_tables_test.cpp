// SPDX-License-Identifier: Apache-2.0
#include "materials/measured_tables.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include "core/base/error.h"
#include "core/base/file.h"
#include "tests/support/synthetic_measured.h"
#include "tests/support/test_data.h"

namespace spectrace {
namespace {

using test::data_folder;
using test::make_measured;
using test::measured_files;
using test::SyntheticMeasured;

/// A copy of the file with one field changed; `change` may return false to leave the field out.
TensorFile altered(const TensorFile& file, std::string_view name,
                   const std::function<bool(Tensor&)>& change) {
  TensorFile out;
  for (Tensor tensor : file.tensors()) {
    if (tensor.name != name || change(tensor)) out.add(std::move(tensor));
  }
  return out;
}

void set_float(Tensor& tensor, std::size_t index, float value) {
  std::memcpy(tensor.bytes.data() + index * sizeof value, &value, sizeof value);
}

std::string message_of(const TensorFile& file) {
  try {
    (void)measured_from_tensors(file);
  } catch (const InputError& e) {
    return e.diagnostics()[0].text();
  }
  return "(no error)";
}

#define EXPECT_MENTIONS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

void expect_same(const MeasuredTables& a, const MeasuredTables& b) {
  EXPECT_EQ(a.description, b.description);
  EXPECT_EQ(a.phi_i, b.phi_i);
  EXPECT_EQ(a.theta_i, b.theta_i);
  EXPECT_EQ(a.ndf_width, b.ndf_width);
  EXPECT_EQ(a.ndf_height, b.ndf_height);
  EXPECT_EQ(a.ndf, b.ndf);
  EXPECT_EQ(a.sigma, b.sigma);
  EXPECT_EQ(a.warp_size, b.warp_size);
  EXPECT_EQ(a.vndf, b.vndf);
  EXPECT_EQ(a.table_size, b.table_size);
  EXPECT_EQ(a.luminance, b.luminance);
  EXPECT_EQ(a.axis.is_rgb(), b.axis.is_rgb());
  EXPECT_TRUE(std::ranges::equal(a.axis.lambda_nm(), b.axis.lambda_nm()));
  EXPECT_EQ(a.spectra, b.spectra);
  EXPECT_EQ(a.valid, b.valid);
  EXPECT_EQ(a.jacobian, b.jacobian);
}

TEST(MeasuredTables, ReadingInvertsWriting) {
  for (const bool rgb : {false, true}) {
    for (const int symmetry : {0, 1, 2, 4}) {
      const MeasuredTables made = make_measured({.isotropic = symmetry == 0,
                                                 .symmetry = std::max(symmetry, 1),
                                                 .stored_reduction = std::max(symmetry, 1),
                                                 .rgb = rgb,
                                                 .jacobian = symmetry != 2});
      const auto bytes = measured_to_tensors(made).serialize();
      const MeasuredTables back = measured_from_tensors(TensorFile::parse(bytes, "a.bsdf"));
      expect_same(made, back);
      EXPECT_EQ(back.is_isotropic(), symmetry == 0);
      EXPECT_EQ(back.symmetry_reduction(), std::max(symmetry, 1));
      EXPECT_FALSE(back.valid_was_inverted);
    }
  }
}

TEST(MeasuredTables, NoFlippedByteOfTheHeaderGoesUnnoticed) {
  for (const bool rgb : {false, true}) {
    TensorFile file = measured_to_tensors(make_measured({.rgb = rgb}));
    const std::array<std::uint32_t, 2> version{1, 0};  // as the database's own files have it
    Tensor tensor{.name = "version", .type = TensorType::kU32, .shape = {2}, .bytes = {}};
    const auto raw = std::as_bytes(std::span(version));
    tensor.bytes.assign(raw.begin(), raw.end());
    file.add(std::move(tensor));
    std::vector<std::byte> bytes = file.serialize();
    const TensorFile whole = TensorFile::parse(bytes, "a.bsdf");
    const MeasuredTables tables = measured_from_tensors(whole);
    std::size_t passed = 0;
    for (std::size_t at = 0; at < whole.tensors().front().offset; ++at) {
      for (const unsigned flip : {0x01, 0x02, 0x04, 0x08, 0x10, 0x20, 0x40, 0x80, 0xff}) {
        SCOPED_TRACE(testing::Message() << "byte " << at << " flipped by " << flip);
        bytes[at] ^= std::byte(flip);
        try {
          expect_same(measured_from_tensors(TensorFile::parse(bytes, "a.bsdf")), tables);
          ++passed;
        } catch (const InputError& e) {
          EXPECT_EQ(e.diagnostics().size(), 1U);
        }
        bytes[at] ^= std::byte(flip);
      }
    }
    // Of what nothing is read from: the type of `version`; padding that description may as well hold.
    EXPECT_LE(passed, 12U);
  }
}

TEST(MeasuredTables, OptionalFieldsUnderAnotherNameAreNoticed) {
  const TensorFile good = measured_to_tensors(make_measured({}));
  const auto renamed = [&](std::string_view from, const std::string& to) {
    return message_of(altered(good, from, [&](Tensor& t) {
      t.name = to;
      return true;
    }));
  };
  EXPECT_MENTIONS(renamed("valid", "valjd"),
                  "field \"valjd\": is no field of a measurement; did you mean \"valid\"?");
  EXPECT_MENTIONS(renamed("valid", "verson"), "did you mean \"version\"?");
  // What another program adds is its own business.
  EXPECT_EQ(renamed("valid", "measured_by"), "(no error)");
}

TEST(MeasuredTables, LastSliceThatCopiesTheOneBeforeIsNotMeasured) {
  MeasuredTables tables = make_measured({});
  EXPECT_EQ(tables.last_measured_theta_i(), 1.3f);
  tables.spectra.back() = std::nextafter(tables.spectra.back(), 1.0f);
  EXPECT_EQ(tables.last_measured_theta_i(), 1.5707963f);
}

TEST(MeasuredTables, NegativeValuesAreClampedAndCounted) {
  const TensorFile good = measured_to_tensors(make_measured({.rgb = true}));
  const TensorFile file = altered(good, "rgb", [](Tensor& t) {
    set_float(t, 3, -0.25f);
    set_float(t, 9, -0.5f);
    return true;
  });
  const MeasuredTables tables = measured_from_tensors(file);
  EXPECT_EQ(tables.negative_values, 2u);
  EXPECT_EQ(tables.most_negative, -0.5f);
  EXPECT_EQ(tables.spectra[3], 0);
  EXPECT_EQ(tables.spectra[9], 0);
}

TEST(MeasuredTables, ValidBitsAreReadInEitherPolarity) {
  const MeasuredTables made = make_measured({});
  const TensorFile inverted = altered(measured_to_tensors(made), "valid", [](Tensor& t) {
    for (std::byte& b : t.bytes) b = ~b;
    return true;
  });
  const MeasuredTables back = measured_from_tensors(inverted);
  EXPECT_TRUE(back.valid_was_inverted);
  EXPECT_EQ(back.valid, made.valid);
  const TensorFile plain = altered(measured_to_tensors(made), "valid", [&](Tensor& t) {
    t.shape = {made.valid.size()};
    t.bytes.resize(made.valid.size());
    std::memcpy(t.bytes.data(), made.valid.data(), made.valid.size());
    return true;
  });
  EXPECT_EQ(measured_from_tensors(plain).valid, made.valid);

  MeasuredTables black = made;
  std::fill(black.luminance.begin(), black.luminance.end(), 0.0f);
  EXPECT_EQ(measured_from_tensors(measured_to_tensors(black)).valid, made.valid) << "dark is not unmeasured";
}

TEST(MeasuredTables, EveryMissingFieldIsNamed) {
  const TensorFile good = measured_to_tensors(make_measured({}));
  for (const Tensor& tensor : good.tensors()) {
    const std::string message = message_of(altered(good, tensor.name, [](Tensor&) { return false; }));
    if (tensor.name == "valid") {
      EXPECT_EQ(message, "(no error)");
    } else {
      EXPECT_MENTIONS(message, '"' + tensor.name + '"');
    }
  }
}

TEST(MeasuredTables, NamesTheFieldAndTheRule) {
  const TensorFile good = measured_to_tensors(make_measured({}));
  const auto message = [&](std::string_view name, auto change) {
    return message_of(altered(good, name, [&](Tensor& t) { return change(t), true; }));
  };
  EXPECT_MENTIONS(message("theta_i", [](Tensor& t) { set_float(t, 1, 0); }),
                  "\"theta_i\": entry 1 is 0 after 0");
  EXPECT_MENTIONS(message("theta_i", [](Tensor& t) { set_float(t, 4, 1.6f); }),
                  "expected values in [0, pi/2]");
  EXPECT_MENTIONS(message("theta_i", [](Tensor& t) { set_float(t, 0, -0.1f); }),
                  "expected values in [0, pi/2]");
  EXPECT_MENTIONS(message("ndf", [](Tensor& t) { set_float(t, 35, NAN); }), "\"ndf\": value nan at [1,2]");
  EXPECT_MENTIONS(message("sigma", [](Tensor& t) { set_float(t, 0, -1); }), "\"sigma\": value -1 at [0,0]");
  EXPECT_MENTIONS(message("vndf", [](Tensor& t) { set_float(t, 17 * 17, -1); }),
                  "\"vndf\": value -1 at [0,1,0,0]");
  EXPECT_MENTIONS(message("luminance", [](Tensor& t) { set_float(t, 0, INFINITY); }),
                  "\"luminance\": value inf");
  EXPECT_MENTIONS(message("spectra", [](Tensor& t) { set_float(t, 0, NAN); }), "\"spectra\": value nan");
  EXPECT_MENTIONS(message("wavelengths", [](Tensor& t) { set_float(t, 6, 650); }),
                  "\"wavelengths\": entry 6 is 650");
  EXPECT_MENTIONS(message("wavelengths", [](Tensor& t) { set_float(t, 0, -5); }), "positive");
  EXPECT_MENTIONS(message("vndf", [](Tensor& t) { t.shape = {1, 5, 1, 17 * 17}; }), "last two must be equal");
  EXPECT_MENTIONS(message("vndf", [](Tensor& t) { t.shape = {5, 1, 17, 17}; }), "expected [1,5,any,any]");
  EXPECT_MENTIONS(message("spectra", [](Tensor& t) { t.shape = {1, 7, 5, 9, 9}; }), "expected [1,5,7,9,9]");
  EXPECT_MENTIONS(message("valid", [](Tensor& t) { t.shape = {1}, t.bytes.resize(1); }),
                  "\"valid\": 1 bytes for 405");
  EXPECT_MENTIONS(message("jacobian", [](Tensor& t) { t.shape = {2}, t.bytes.resize(2); }),
                  "\"jacobian\": shape [2]");
  EXPECT_MENTIONS(message("phi_i", [](Tensor& t) { t.type = TensorType::kU32; }),
                  "\"phi_i\": element type u32");
  EXPECT_MENTIONS(message("description", [](Tensor& t) { t.name = "ndf2"; }), "\"description\": missing");
  EXPECT_MENTIONS(message("luminance", [](Tensor& t) { t.name = "rgb"; }), "\"luminance\": missing");
}

TEST(MeasuredTables, AzimuthsMustSpanAWholeHalfOrQuarterTurn) {
  const auto message = [](SyntheticMeasured options, float scale, float shift) {
    const TensorFile good = measured_to_tensors(make_measured(options));
    return message_of(altered(good, "phi_i", [&](Tensor& t) {
      const std::vector<float> phi = t.floats();
      for (std::size_t i = 0; i < phi.size(); ++i) set_float(t, i, phi[i] * scale + shift);
      return true;
    }));
  };
  const SyntheticMeasured half{.isotropic = false, .symmetry = 2, .stored_reduction = 2};
  const SyntheticMeasured quarter{.isotropic = false, .symmetry = 4, .stored_reduction = 4};
  EXPECT_EQ(message(half, 1, 0), "(no error)");
  EXPECT_EQ(message(half, 1, 0.3f), "(no error)");
  EXPECT_MENTIONS(message(half, 0.9f, 0), "\"phi_i\": spans");
  EXPECT_EQ(message(quarter, 1, 1.5707963f), "(no error)");
  EXPECT_MENTIONS(message(quarter, 1, 0.3f), "begin on an axis");
}

TEST(MeasuredTables, HostileDescriptionsBecomeOneLine) {
  const TensorFile file = altered(measured_to_tensors(make_measured({})), "description", [](Tensor& t) {
    t = Tensor::from_text("description", "a\nb\x1b[31m\xff");
    return true;
  });
  EXPECT_EQ(measured_from_tensors(file).description, "a b [31m?");
}

TEST(MeasuredTables, ReadsEveryFileOfTheDatabase) {
  const auto rgb = measured_files("epfl_rgb"), spectral = measured_files("epfl_uplifted");
  if (rgb.empty() || spectral.empty()) GTEST_SKIP() << "needs epfl_rgb, epfl_uplifted in " << data_folder();
  for (const auto& files : {rgb, spectral}) {
    for (const auto& file : files) {
      const MeasuredTables tables = read_measured(file);
      EXPECT_TRUE(tables.is_isotropic());
      EXPECT_TRUE(tables.jacobian);
      EXPECT_EQ(tables.theta_i.size(), 8u);
      EXPECT_EQ(tables.axis.size(), tables.axis.is_rgb() ? 3u : 195u);
      // Hard case H1: measured to 78.4 to 85.0 degrees.
      EXPECT_EQ(tables.last_measured_theta_i(), tables.theta_i[6]) << file;
      // Whichever way its bits are meant: most cells were measured, and nearly all of those saw light.
      std::size_t invalid = 0, lit = 0;
      for (std::size_t i = 0; i < tables.valid.size(); ++i) {
        invalid += tables.valid[i] == 0 ? 1 : 0;
        lit += tables.valid[i] != 0 && tables.luminance[i] > 0 ? 1 : 0;
      }
      const std::size_t cells = tables.valid.size();
      ASSERT_EQ(cells, tables.luminance.size());
      EXPECT_LT(invalid, cells / 5) << file;
      EXPECT_GT(double(lit), 0.99 * double(cells - invalid)) << file;
      expect_same(tables, measured_from_tensors(measured_to_tensors(tables)));
    }
  }
}

TEST(MeasuredTables, LuminanceOfRgbFilesIsThatOfTheirColours) {
  // Holds cell by cell only if both tables' axes are read in the same order.
  const auto file = data_folder() / "epfl_rgb/satin_purple_rgb.bsdf";
  SPECTRACE_SKIP_WITHOUT(file);
  const MeasuredTables tables = read_measured(file);
  ASSERT_EQ(tables.negative_values, 0u);
  const std::size_t cells = std::size_t(tables.table_size) * tables.table_size;
  for (std::size_t slice = 0; slice < tables.slices(); ++slice) {
    for (std::size_t i = 0; i < cells; ++i) {
      const float* const rgb = tables.spectra.data() + slice * 3 * cells + i;
      const double y = 0.2126 * rgb[0] + 0.7152 * rgb[cells] + 0.0722 * rgb[2 * cells];  // ITU-R BT.709
      EXPECT_NEAR(tables.luminance[slice * cells + i], y, 1e-3 * y + 1e-6);  // coefficients of four digits
    }
  }
}

TEST(MeasuredTables, PolarAxisOfTheWarpIsTheLastOne) {
  // At the pole, coordinate 0 of the polar axis, visible normals have no density at any azimuth.
  const auto files = measured_files("epfl_rgb");
  if (files.empty()) GTEST_SKIP() << "needs epfl_rgb in " << data_folder();
  for (const auto& file : files) {
    const MeasuredTables tables = read_measured(file);
    double pole = 0, first_azimuth = 0;
    for (std::size_t i = 0; i < tables.vndf.size(); ++i) {
      if (i % tables.warp_size == 0) pole += tables.vndf[i];
      if (i / tables.warp_size % tables.warp_size == 0) first_azimuth += tables.vndf[i];
    }
    EXPECT_EQ(pole, 0) << file;
    EXPECT_GT(first_azimuth, 0) << file;
  }
}

TEST(MeasuredTables, DamagedFilesGiveAnErrorOrLoad) {
  const auto file = data_folder() / "epfl_rgb/paper_white_rgb.bsdf";
  SPECTRACE_SKIP_WITHOUT(file);
  const std::vector<std::byte> good = read_file(file);
  const std::size_t header = TensorFile::parse(good, "").tensors().front().offset;
  std::mt19937 random(11);
  for (int trial = 0; trial < 20; ++trial) {
    const std::size_t size = random() % good.size();
    EXPECT_THROW((void)measured_from_tensors(TensorFile::parse(std::span(good).first(size), "a.bsdf")),
                 InputError);
  }
  int refused = 0;
  for (int trial = 0; trial < 200; ++trial) {
    auto bytes = good;
    bytes[random() % header] ^= std::byte(1 + random() % 255);
    try {
      (void)measured_from_tensors(TensorFile::parse(bytes, "a.bsdf"));
    } catch (const InputError& e) {
      ++refused;
      EXPECT_EQ(e.diagnostics()[0].text().find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(refused, 100);  // most of the header matters
}

}  // namespace
}  // namespace spectrace

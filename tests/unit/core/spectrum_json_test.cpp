// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/spectra/color.h"
#include "core/spectra/spectrum.h"
#include "tests/support/temporary_folder.h"

namespace spectrace {
namespace {

struct Parsed {
  Spectrum spectrum;
  std::vector<std::string> problems;  // "line:column: pointer: problem"
};

Parsed parse(const std::string& spectrum, SpectrumRole role, const std::string& file = "s.json") {
  JsonDocument document = JsonDocument::parse("{\"s\": " + spectrum + "}", file);
  Parsed p;
  p.spectrum = parse_spectrum(document.root().require("s"), role, Spectrum::constant(-7));
  for (const Diagnostic& d : document.diagnostics()) p.problems.push_back(d.where + ": " + d.problem);
  return p;
}

Float value_at(const std::string& spectrum, SpectrumRole role, Float nm) {
  const Parsed p = parse(spectrum, role);
  for (const std::string& problem : p.problems) ADD_FAILURE() << spectrum << ": " << problem;
  return p.spectrum.at(nm);
}

TEST(SpectrumJson, EveryFormIsRead) {
  const auto reflectance = SpectrumRole::kReflectance, emission = SpectrumRole::kEmission,
             unbounded = SpectrumRole::kUnbounded;
  EXPECT_EQ(value_at("0.25", reflectance, 500), 0.25f);
  EXPECT_EQ(value_at("-2", unbounded, 500), -2);
  EXPECT_EQ(value_at(R"({"wavelengths_nm": [400, 500], "values": [0, 1]})", reflectance, 450), 0.5f);
  EXPECT_EQ(
      value_at(R"({"wavelengths_nm": [400, 500], "values": [0, 100], "scale": 0.01})", reflectance, 500), 1);
  EXPECT_NEAR(value_at(R"({"rgb": [0.5, 0.5, 0.5]})", reflectance, 777), 0.5, 1e-6);
  EXPECT_EQ(value_at(R"({"rgb": [0, 0, 0], "scale": 3})", emission, 500), 0);
  EXPECT_EQ(value_at(R"({"blackbody_K": 5000, "scale": 2})", emission, 500),
            (BlackbodySpectrum{5000, 2}.at(500)));
  EXPECT_NEAR(value_at(R"({"illuminant": "D65", "scale": 3})", emission, 460), 3 * illuminant_d65(460), 1e-6);
  EXPECT_EQ(value_at(R"({"illuminant": "E"})", emission, 460), 1);
  for (const Float nm : {360.f, 560.f, 830.f}) {
    EXPECT_NEAR(value_at(R"({"illuminant": "A"})", emission, nm) / illuminant_a(nm), 1, 1e-6) << nm;
  }
  EXPECT_NEAR(value_at(R"({"sellmeier": {"b": [1.03961212, 0.231792344, 1.01046945],
                                         "c_um2": [0.00600069867, 0.0200179144, 103.560653]}})",
                       unbounded, 587.5618f),
              1.5168, 5e-6);
  EXPECT_EQ(value_at(R"({"cauchy": {"a": 1.5, "b_um2": 0.25}})", unbounded, 500), 2.5f);
  EXPECT_EQ(value_at(R"({"cauchy": {"a": 1.5, "c_um4": 0.0625, "b_um2": 0}, "scale": 2})", unbounded, 500),
            5);
}

TEST(SpectrumJson, EmissionOfRgbHasThatColour) {
  const Parsed p = parse(R"({"rgb": [10, 2, 0.5], "scale": 2})", SpectrumRole::kEmission);
  const Rgb rgb = xyz_to_rgb(spectrum_to_xyz(p.spectrum));
  EXPECT_NEAR(rgb[0], 20, 2e-5);
  EXPECT_NEAR(rgb[1], 4, 2e-5);
  EXPECT_NEAR(rgb[2], 1, 2e-5);
}

TEST(SpectrumJson, AbsentIsTheFallback) {
  JsonDocument document = JsonDocument::parse("{}", "s.json");
  EXPECT_EQ(
      parse_spectrum(document.root().get("s"), SpectrumRole::kReflectance, Spectrum::constant(4)).at(500), 4);
  EXPECT_TRUE(document.diagnostics().empty());
}

TEST(SpectrumJson, FilesAreFoundBesideTheDocument) {
  const test::TemporaryFolder folder;
  test::write_text(folder.path() / "a.spd", "400 0.1 0.3\n500 0.2 0.4\n");
  const std::string scene = (folder.path() / "s.json").string();
  const Parsed p = parse(R"({"file": "a.spd", "column": 2})", SpectrumRole::kReflectance, scene);
  EXPECT_TRUE(p.problems.empty());
  EXPECT_EQ(p.spectrum.at(500), 0.4f);

  test::write_text(folder.path() / "a.spd", "400 0.1\n500 1.2\n");
  const Parsed beyond = parse(R"({"file": "a.spd"})", SpectrumRole::kReflectance, scene);
  ASSERT_EQ(beyond.problems.size(), 1u);
  EXPECT_NE(beyond.problems[0].find("the value 1.2 at 500 nm is not in [0, 1]"), std::string::npos);

  test::write_text(folder.path() / "a.spd", "400 0.1\n400 0.2\n");
  const Parsed bad = parse(R"({"file": "a.spd"})", SpectrumRole::kReflectance, scene);
  ASSERT_EQ(bad.problems.size(), 1u);
  EXPECT_NE(bad.problems[0].find("1:16: /s/file: "), std::string::npos) << bad.problems[0];
  EXPECT_NE(bad.problems[0].find("a.spd:2:1: wavelengths must increase"), std::string::npos)
      << bad.problems[0];

  EXPECT_EQ(parse(R"({"file": "none.spd"})", SpectrumRole::kReflectance, scene).problems.size(), 1u);
}

TEST(SpectrumJson, MistakesAreNamedAtTheirPlace) {  // hard case H13 among them
  const auto reflectance = SpectrumRole::kReflectance, emission = SpectrumRole::kEmission,
             unbounded = SpectrumRole::kUnbounded;
  const struct {
    const char* text;
    SpectrumRole role;
    const char* problem;
  } cases[] = {
      {R"({"wavelengths_nm": [500, 400], "values": [0, 0]})", reflectance,
       "1:32: /s/wavelengths_nm/1: wavelengths must increase: 400 nm follows 500 nm"},
      {R"({"wavelengths_nm": [400, 500, 500], "values": [0, 0, 0]})", reflectance,
       "1:37: /s/wavelengths_nm/2: wavelengths must increase: 500 nm follows 500 nm"},
      {"{\"wavelengths_nm\": [400, 500],\n \"values\": [0]}", reflectance,
       "2:12: /s/values: expected 2 values, one for each wavelength, got 1"},
      {R"({"wavelengths_nm": [400]})", reflectance, "1:7: /s: missing required key \"values\""},
      {R"({"wavelengths_nm": [400, 500], "values": [0.5, 1.5]})", reflectance,
       "1:54: /s/values/1: expected a number in [0, 1], got 1.5"},
      {"1.5", reflectance, "1:7: /s: expected a number in [0, 1], got 1.5"},
      {"-1", emission, "1:7: /s: expected a number in [0, 1e+30], got -1"},
      {R"({"rgb": [1, -0.5, 0]})", emission, "1:19: /s/rgb/1: expected a number in [0, 1e+30], got -0.5"},
      {R"({"rgb": [0.1, 0.2]})", reflectance,
       "1:15: /s/rgb: expected an array of 3 numbers, got an array of 2"},
      {R"({"rgb": [1, 1, 1]})", unbounded,
       "1:15: /s/rgb: a colour has no meaning here: give a number, \"wavelengths_nm\" and \"values\", or a "
       "\"file\""},
      {R"({"illuminant": "D65"})", reflectance,
       "1:22: /s/illuminant: is the spectrum of a light, which has no meaning here"},
      {R"({"sellmeier": {"b": [0, 0, 0], "c_um2": [0, 0, 0]}})", emission,
       "1:21: /s/sellmeier: is a refractive index, which has no meaning here"},
      {R"({"illuminant": "D66"})", emission,
       "1:22: /s/illuminant: expected one of \"D65\", \"D50\", \"D55\", \"D75\", \"A\", \"E\", "
       "\"F2\", \"F7\", \"F11\", got \"D66\"; did you mean \"D65\"?"},
      {R"({"blackbody_K": 0})", emission,
       "1:23: /s/blackbody_K: expected a number in (0, 1000000000], got 0"},
      {R"({"rgb": [1, 1, 1], "file": "x"})", reflectance,
       "1:34: /s/file: \"rgb\" already gives the spectrum"},
      {R"({"rgb": [1, 1, 1], "colum": 2})", reflectance, "1:26: /s/colum: unknown key"},
      {R"({"rgb": [0.5, 0.5, 0.5], "scale": 1e30})", emission, ""},
      {R"({"rgb": [1e30, 0, 0], "scale": 1e30})", emission,
       "1:7: /s: reaches values beyond what a number can hold"},
      {R"("red")", reflectance, "1:7: /s: expected a number or an object that gives a spectrum"},
      {R"({"rbg": [1, 1, 1]})", reflectance, "1:8: /s/rbg: unknown key \"rbg\"; did you mean \"rgb\"?"},
      {R"({"values": [1]})", reflectance, "1:7: /s: missing required key \"wavelengths_nm\""},
      {R"({"scale": 2})", reflectance, "1:7: /s: expected one of \"rgb\""},
      {"{}", reflectance, "1:7: /s: expected one of \"rgb\""},
  };
  for (const auto& c : cases) {
    const Parsed p = parse(c.text, c.role);
    if (*c.problem == '\0') {
      EXPECT_TRUE(p.problems.empty()) << c.text << "\n" << p.problems[0];
      continue;
    }
    ASSERT_EQ(p.problems.size(), 1u) << c.text;
    EXPECT_EQ(p.problems[0].substr(0, std::string(c.problem).size()), c.problem) << c.text;
    // An unknown key leaves the rest readable; anything else gives the fallback.
    if (p.problems[0].find("unknown key") == std::string::npos) {
      EXPECT_EQ(p.spectrum.at(500), -7) << c.text;
    }
  }
}

}  // namespace
}  // namespace spectrace

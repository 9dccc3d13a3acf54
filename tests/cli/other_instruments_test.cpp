// SPDX-License-Identifier: Apache-2.0
// Measurements of other instruments go every way that one of the EPFL database does.
#include <fstream>

#include "materials/tensor_file.h"
#include "tests/cli/program.h"
#include "tests/support/foreign_files.h"

namespace spectrace::test {
namespace {

class OtherInstruments : public Program {
 protected:
  void write_scattered(const std::string& name) const {
    const auto brdf = [](Vec3 wo, Vec3 wi, double lambda_nm) {
      const Vec3 h = normalize(wo + wi);
      return 0.05 + 2e-4 * (lambda_nm - 400) + 0.3 * std::pow(double(h.z), 40);
    };
    write_text(folder_ / name, scattered_text(brdf, 600, {450, 550, 650}));
  }
  void write_merl(const std::string& name) const {
    const std::vector<std::byte> bytes = merl_file([](Vec3 wo, Vec3 wi) {
      const double lobe = 0.3 * std::pow(double(normalize(wo + wi).z), 40);
      return std::array{0.1 + lobe, 0.05 + lobe, 0.02 + lobe};
    });
    std::ofstream out(folder_ / name, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  }
  /// separate, inspect both files, render.
  void expect_every_way(const std::string& file, const std::string& format, std::size_t axis) const {
    const ProgramResult separated = separate(file, "m.sep", {"--report", "m.json"});
    ASSERT_EQ(separated.exit_code, 0) << separated.output << separated.errors;
    EXPECT_TRUE(separated.says(format)) << separated.output;
    EXPECT_NE(read_text(folder_ / "m.json").find("\"format\""), std::string::npos);
    const TensorFile sep = TensorFile::read(folder_ / "m.sep");
    ASSERT_NE(sep.find("c_d"), nullptr);
    EXPECT_EQ(sep.find("c_d")->count(), axis);
    const ProgramResult inspected = run({"inspect", file});
    EXPECT_EQ(inspected.exit_code, 0) << inspected.errors;
    EXPECT_TRUE(inspected.says(format) && inspected.says("filled_cells")) << inspected.output;
    EXPECT_EQ(run({"inspect", "m.sep"}).exit_code, 0);
    write_scene("scene.json", R"({"name": "m", "type": "measured", "file": ")" + file + "\"}");
    EXPECT_EQ(run({"scene.json", "-o", "raw.exr", "--strict"}).exit_code, 0);
  }
};

TEST_F(OtherInstruments, CornellsScatteredTextGoesEveryWay) {
  write_scattered("m.brdf");
  expect_every_way("m.brdf", "Cornell text", 3);
  const ProgramResult rendered = run({"scene.json", "-o", "model.exr", "--separate", "fresnel", "--cache",
                                      "cache", "--strict", "--grid", "24x20x30"});
  EXPECT_EQ(rendered.exit_code, 0) << rendered.errors;
}

TEST_F(OtherInstruments, MerlsBinaryGoesEveryWay) {
  write_merl("m.binary");
  expect_every_way("m.binary", "MERL binary", 3);
}

TEST_F(OtherInstruments, WhatIsWrongIsNamedOnOneLine) {
  write_text(folder_ / "short.brdf", "2\n400 500\n0.1 0 0.2 0 1\n");
  write_text(folder_ / "degrees.brdf", "2\n400 500\n45 0 0.2 0 1 1\n");
  write_text(folder_ / "text.binary", "not a table");
  write_text(folder_ / "text.brdf", "{\"name\": 1}");
  for (const std::string command : {"separate", "inspect"}) {
    const auto arguments = [&](const std::string& file) {
      return command == "inspect" ? std::vector<std::string>{command, file}
                                  : std::vector<std::string>{command, file, "-o", "out.sep"};
    };
    expect_bad_input(arguments("short.brdf"), "short.brdf:3:13: 5 numbers on the line of a sample");
    expect_bad_input(arguments("degrees.brdf"), "degrees.brdf:3:1: theta_i is 45, expected radians");
    expect_bad_input(arguments("text.binary"), "text.binary:byte 0: field \"dims\": expected 90 x 90 x 180");
    expect_bad_input(arguments("text.brdf"), "text.brdf:1:1: expected a finite number");
  }
  write_scene("scene.json", R"({"name": "m", "type": "measured", "file": "short.brdf"})");
  const ProgramResult rendered = run({"scene.json", "-o", "out.exr"});
  EXPECT_EQ(rendered.exit_code, 3);
  EXPECT_NE(rendered.errors.find("short.brdf:3:13:"), std::string::npos) << rendered.errors;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.exr"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.sep"));
}

}  // namespace
}  // namespace spectrace::test

// SPDX-License-Identifier: Apache-2.0
// `spectrace reproduce`: a folder of materials becomes a report, whatever one of them is like.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "core/image/image.h"
#include "tests/cli/program.h"

namespace spectrace::test {
namespace {

class Reproduce : public Program {
 protected:
  Reproduce() { std::filesystem::create_directory(folder_ / "in"); }
  [[nodiscard]] ProgramResult reproduce(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"reproduce", "in",       "-o", "report", "--spp",
                                       "1",         "--height", "16", "--grid", "30x20x24"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  [[nodiscard]] std::string report(const std::string& name) const {
    return read_text(folder_ / "report" / name);
  }
};

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST_F(Reproduce, ReportsOnGoodFilesAndNamesTheBadOne) {
  write_measured("in/paint.bsdf");
  write_text(folder_ / "in/broken.bsdf", "junk");
  write_text(folder_ / "in/notes.txt", "not a material");
  const ProgramResult first = reproduce();
  EXPECT_EQ(first.exit_code, 3) << first.errors;
  EXPECT_NE(first.errors.find("broken.bsdf:byte 0: expected a tensor file"), std::string::npos)
      << first.errors;

  const std::string csv = report("results.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "material,reference,model,psnr,ssim,mape,relmse,seconds,bytes");
  // analytic, sun, fresnel, diffraction, residual with and without odd terms; and three tables
  EXPECT_EQ(count(csv, "paint,tabulated,"), 6U) << csv;
  EXPECT_EQ(count(csv, "paint,raw,"), 9U) << csv;
  EXPECT_EQ(count(csv, "broken"), 0U) << csv;
  EXPECT_EQ(count(csv, "nan"), 0U) << csv;

  const std::string page = report("index.html");
  EXPECT_NE(page.find("broken.bsdf"), std::string::npos);
  EXPECT_EQ(count(page, "src=\"data:image/jpeg;base64,"), 1U);
  EXPECT_EQ(count(page, "src=\""), 1U) << "the page must open without other files";
  EXPECT_NE(page.find("<svg"), std::string::npos);

  const Image sheet = read_image(folder_ / "report/sheets/paint.png");
  EXPECT_GT(*std::max_element(sheet.data.begin(), sheet.data.end()), 0.5F);
  for (const char* model : {"raw", "plain_table", "tabulated", "oriented_table", "analytic", "sun", "fresnel",
                            "diffraction", "residual"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "report/pictures/paint" / (std::string(model) + ".exr")))
        << model;
  }

  // Again: what is done is not done again, and the figures are the same.
  const auto done_at = std::filesystem::last_write_time(folder_ / "report/materials/paint.json");
  std::filesystem::remove(folder_ / "in/broken.bsdf");
  const ProgramResult second = reproduce();
  EXPECT_EQ(second.exit_code, 0) << second.errors;
  EXPECT_NE(second.errors.find("1 of 1 materials were done before"), std::string::npos) << second.errors;
  EXPECT_EQ(std::filesystem::last_write_time(folder_ / "report/materials/paint.json"), done_at);
  EXPECT_EQ(report("results.csv"), csv);

  // A record cut short is made anew.
  write_text(folder_ / "report/materials/paint.json", report("materials/paint.json").substr(0, 200));
  EXPECT_EQ(reproduce().exit_code, 0);
  EXPECT_NE(report("materials/paint.json").find("\"rows\""), std::string::npos);
  // So is one of other samples.
  const ProgramResult other = reproduce({"--seed", "7"});
  EXPECT_EQ(other.exit_code, 0) << other.errors;
  EXPECT_EQ(other.errors.find("done before"), std::string::npos) << other.errors;
  const auto psnr_of_sun = [](const std::string& text) {
    const std::string begin = "paint,raw,sun,";
    return text.substr(text.find(begin), text.find(',', text.find(begin) + begin.size()) - text.find(begin));
  };
  EXPECT_NE(psnr_of_sun(report("results.csv")), psnr_of_sun(csv));
}

TEST_F(Reproduce, FindsTheSameFiguresOnAnyNumberOfThreads) {
  write_measured("in/paint.bsdf");
  ASSERT_EQ(reproduce({"--threads", "1"}).exit_code, 0);
  const Image one = read_image(folder_ / "report/pictures/paint/residual.exr");
  std::filesystem::remove_all(folder_ / "report");
  ASSERT_EQ(reproduce({"--threads", "3"}).exit_code, 0);
  EXPECT_EQ(read_image(folder_ / "report/pictures/paint/residual.exr").data, one.data);
}

TEST_F(Reproduce, RefusesAFolderWithoutMaterials) {
  expect_bad_input({"reproduce", "in", "-o", "report"}, "in: holds no .bsdf, .brdf, .binary or .json file");
  expect_bad_input({"reproduce", "nowhere", "-o", "report"}, "nowhere: cannot be read as a folder");
  expect_usage_error({"reproduce", "in"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "report"));
}

}  // namespace
}  // namespace spectrace::test

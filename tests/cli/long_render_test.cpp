// SPDX-License-Identifier: Apache-2.0
// Renders that are stopped, killed, gone on with, split and joined: the same bits in the end.
#include <csignal>
#include <random>

#include "core/image/image.h"
#include "tests/cli/program.h"

namespace spectrace::test {
namespace {

class LongRender : public Program {
 protected:
  LongRender() {
    write_text(folder_ / "scene.json",
               R"({"camera": {"origin": [0, -4, 1], "target": [0, 0, 0], "up": [0, 0, 1]},
"film": {"width": 40, "height": 36, "spectral": {"bins": 12}}, "sampler": {"spp": 96}, "aovs": "denoise",
"materials": [{"name": "m", "type": "plastic", "reflectance": {"rgb": [0.7, 0.3, 0.1]}, "roughness": 0.3,
  "eta": 1.5}],
"shapes": [{"type": "sphere", "material": "m"}, {"type": "quad", "material": "m", "corner": [-3, -3, -1],
  "edge_u": [6, 0, 0], "edge_v": [0, 6, 0]}],
"lights": [{"type": "environment", "radiance": 1}, {"type": "point", "position": [1, -2, 3], "intensity": 9}]})");
  }
  ProgramResult render(const std::string& output, std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {"scene.json", "-o", output});
    return run(options);
  }
  void expect_same_images(const std::string& a, const std::string& b) const {
    for (const char* ending : {".exr", ".spectral.exr", ".diffuse.spectral.exr", ".specular.spectral.exr"}) {
      const Image first = read_image(folder_ / (a + ending)), second = read_image(folder_ / (b + ending));
      EXPECT_EQ(first.channels, second.channels);
      EXPECT_EQ(first.data, second.data) << a << " and " << b << ending;
    }
  }
};

TEST_F(LongRender, GoesOnAfterBeingKilledToTheIdenticalImage) {
  const std::vector<std::string> spp{"--spp", "512"};
  ASSERT_EQ(render("whole.exr", spp).exit_code, 0);
  const double seconds = std::get<double>(read_metadata(folder_ / "whole.exr").at("spectrace:seconds"));
  std::mt19937 random(7);
  std::uniform_int_distribution<int> milliseconds(0, int(1000 * seconds));
  int gone_on = 0;
  for (int i = 0; i < 10; ++i) {
    std::filesystem::remove(folder_ / "part.partial");
    // The first dies wherever it is, the others with something to go on with.
    const ProgramResult first = run_program(
        SPECTRACE_BINARY, {"scene.json", "-o", "part.exr", "--spp", "512", "--checkpoint", "0.01"},
        folder_.path(), {},
        {SIGKILL, milliseconds(random), i == 0 ? std::filesystem::path() : folder_ / "part.partial"});
    const ProgramResult second = render("part.exr", {"--spp", "512", "--resume"});
    ASSERT_EQ(second.exit_code, 0) << second.errors;
    if (first.signal == SIGKILL && second.complains("going on after")) ++gone_on;
    expect_same_images("part", "whole");
  }
  EXPECT_GE(gone_on, 5) << "the others had ended before";
}

TEST_F(LongRender, WritesWhatIsThereWhenInterruptedAndGoesOn) {
  ASSERT_EQ(render("whole.exr", {"--spp", "1024"}).exit_code, 0);
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove(folder_ / "part.partial");
    // Its first checkpoint says that it renders.
    const ProgramResult first = run_program(
        SPECTRACE_BINARY, {"scene.json", "-o", "part.exr", "--spp", "1024", "--checkpoint", "0.2"},
        folder_.path(), {}, {signal, 0, folder_ / "part.partial"});
    ASSERT_EQ(first.exit_code, 5) << first.output << first.errors;
    EXPECT_TRUE(first.says("interrupted")) << first.output;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "part.exr"));
    ASSERT_EQ(render("part.exr", {"--spp", "1024", "--resume"}).exit_code, 0);
    expect_same_images("part", "whole");
  }
}

TEST_F(LongRender, ShardsMergeInAnyOrderWhateverTheirThreads) {
  ASSERT_EQ(render("whole.exr").exit_code, 0);
  ASSERT_EQ(render("a.exr", {"--samples", "0:24", "--threads", "1"}).exit_code, 0);
  ASSERT_EQ(render("b.exr", {"--samples", "24:32", "--threads", "2"}).exit_code, 0);
  ASSERT_EQ(render("c.exr", {"--samples", "32:72", "--threads", "7"}).exit_code, 0);
  ASSERT_EQ(render("d.exr", {"--samples", "72:96"}).exit_code, 0);
  ASSERT_EQ(run({"merge", "d.partial", "b.partial", "a.partial", "c.partial", "-o", "merged.exr"}).exit_code,
            0);
  expect_same_images("merged", "whole");
  ASSERT_EQ(run({"merge", "b.partial", "a.partial", "-o", "ab.partial"}).exit_code, 0);
  ASSERT_EQ(run({"merge", "c.partial", "d.partial", "ab.partial", "-o", "twice.exr"}).exit_code, 0);
  expect_same_images("twice", "whole");
  EXPECT_EQ(std::get<std::string>(read_metadata(folder_ / "merged.exr").at("spectrace:sampleRange")), "0:96");
}

TEST_F(LongRender, HeadersOfJoinedAndResumedImagesAreThoseOfTheWhole) {
  write_measured("m.bsdf");
  write_scene("scene.json", R"({"name": "m", "type": "measured", "file": "m.bsdf"})");
  const auto header = [&](const char* file) { return read_metadata(folder_ / file); };
  const auto number = [](const Metadata& of, const char* name) { return std::get<double>(of.at(name)); };
  const std::vector<std::string> separated{"--separate", "fresnel", "--grid",  "24x20x30",
                                           "--cache",    "kept",    "--paired"};
  for (const bool is_separated : {false, true}) {
    const auto part = [&](const std::string& name, std::vector<std::string> options) {
      if (is_separated) options.insert(options.end(), separated.begin(), separated.end());
      ASSERT_EQ(render(name, options).exit_code, 0);
    };
    std::filesystem::remove(folder_ / "resumed.partial");
    part("whole.exr", {"--spp", "32"});
    part("a.exr", {"--samples", "0:8", "--threads", "1"});
    part("b.exr", {"--samples", "8:32", "--threads", "2"});
    const double seconds =
        number(header("a.exr"), "spectrace:seconds") + number(header("b.exr"), "spectrace:seconds");
    ASSERT_EQ(run({"merge", "b.partial", "a.partial", "-o", "merged.exr"}).exit_code, 0);
    part("resumed.exr", {"--spp", "8", "--checkpoint", "60"});
    const double before = number(header("resumed.exr"), "spectrace:seconds");
    part("resumed.exr", {"--spp", "32", "--resume"});
    const Metadata whole = header("whole.exr");
    EXPECT_EQ(whole.contains("spectrace:separation"), is_separated);
    for (const char* file : {"merged.exr", "resumed.exr"}) {
      const Metadata joined = header(file);
      for (const auto& [name, value] : whole) {
        ASSERT_TRUE(joined.contains(name)) << file << ": " << name;
        EXPECT_EQ(joined.at(name).index(), value.index()) << file << ": " << name << " has another type";
        if (name == "spectrace:seconds" || name == "spectrace:threads" ||
            name == "spectrace:extrapolatedShare") {
          continue;
        }
        EXPECT_EQ(joined.at(name), value) << file << ": " << name;
      }
      // Of counts that are the same; shares were rounded before they were joined.
      EXPECT_NEAR(number(joined, "spectrace:extrapolatedShare"), number(whole, "spectrace:extrapolatedShare"),
                  1e-12);
    }
    // A separated material has values up to the horizon.
    EXPECT_EQ(number(whole, "spectrace:extrapolatedShare") > 0, !is_separated);
    EXPECT_EQ(std::get<std::int64_t>(header("merged.exr").at("spectrace:threads")), 2);
    EXPECT_DOUBLE_EQ(number(header("merged.exr"), "spectrace:seconds"), seconds);
    EXPECT_GT(number(header("resumed.exr"), "spectrace:seconds"), before);
  }
}

TEST_F(LongRender, MergeRefusesWhatIsNotOneImage) {
  ASSERT_EQ(render("a.exr", {"--samples", "0:16"}).exit_code, 0);
  ASSERT_EQ(render("b.exr", {"--samples", "8:24"}).exit_code, 0);
  ASSERT_EQ(render("seed.exr", {"--samples", "16:24", "--seed", "3"}).exit_code, 0);
  std::string other = read_text(folder_ / "scene.json");
  other.replace(other.find("1.5}"), 3, "1.6");
  write_text(folder_ / "other.json", other);
  ASSERT_EQ(run({"other.json", "-o", "other.exr", "--samples", "16:24"}).exit_code, 0);
  write_text(folder_ / "whole.exr", "what was there");
  expect_bad_input({"merge", "a.partial", "b.partial", "-o", "whole.exr"}, "b.partial: samples 8:24 overlap");
  expect_bad_input({"merge", "a.partial", "seed.partial", "-o", "whole.exr"}, "seed.partial: is of seed 3");
  expect_bad_input({"merge", "a.partial", "other.partial", "-o", "whole.exr"},
                   "other.partial: is of another scene");
  expect_bad_input({"merge", "a.partial", "scene.json", "-o", "whole.exr"}, "scene.json");
  EXPECT_EQ(read_text(folder_ / "whole.exr"), "what was there");
}

/// A file that the scene names, before and after a change that the renderer reads.
struct ChangedFile {
  const char* file;
  std::string before, after;
  const char* material;
  const char* shape;
};

TEST_F(LongRender, MergeAndResumeRefuseFilesThatHaveChanged) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", red = "400 0.1\n700 0.5\n";
  const std::vector<ChangedFile> cases{
      {"mesh.obj", triangle, "v 0 0 0.1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", R"("reflectance": 0.5)",
       R"({"type": "mesh", "file": "mesh.obj", "material": "m"})"},
      {"red.spd", red, "400 0.2\n700 0.5\n", R"("reflectance": {"file": "red.spd"})",
       R"({"type": "sphere", "material": "m"})"},
  };
  for (const ChangedFile& c : cases) {
    write_text(folder_ / "scene.json", std::string(R"({"camera": {"origin": [0, -4, 1], "target": [0, 0, 0]},
      "film": {"width": 8, "height": 6}, "materials": [{"name": "m", "type": "lambert", )") +
                                           c.material + R"(}], "shapes": [)" + c.shape +
                                           R"(], "lights": [{"type": "environment", "radiance": 1}]})");
    write_text(folder_ / c.file, c.before);
    ASSERT_EQ(render("a.exr", {"--samples", "0:8"}).exit_code, 0) << c.file;
    ASSERT_EQ(render("part.exr", {"--spp", "8", "--checkpoint", "60"}).exit_code, 0);
    write_text(folder_ / c.file, c.after);
    ASSERT_EQ(render("b.exr", {"--samples", "8:16"}).exit_code, 0);
    const std::string problem = std::string("is of another ") + c.file;
    expect_bad_input({"merge", "a.partial", "b.partial", "-o", "whole.exr"}, "b.partial: " + problem);
    expect_bad_input({"scene.json", "-o", "part.exr", "--spp", "16", "--resume"}, "part.partial: " + problem);
  }
}

TEST_F(LongRender, MergeAndResumeRefuseAnotherModel) {
  write_measured("measured.bsdf");
  write_text(folder_ / "scene.json", R"({"camera": {"origin": [0, -4, 1], "target": [0, 0, 0]},
    "film": {"width": 8, "height": 6}, "materials": [{"name": "m", "type": "measured", "file": "measured.bsdf"}],
    "shapes": [{"type": "sphere", "material": "m"}], "lights": [{"type": "environment", "radiance": 1}]})");
  const auto by = [](const char* samples, const char* model) {
    return std::vector<std::string>{"--samples", samples,    "--separate", model,
                                    "--grid",    "24x20x30", "--cache",    "cache"};
  };
  ASSERT_EQ(render("sun.exr", by("0:8", "sun")).exit_code, 0);
  ASSERT_EQ(render("fresnel.exr", by("8:16", "fresnel")).exit_code, 0);
  ASSERT_EQ(render("same.exr", by("8:16", "sun")).exit_code, 0);
  expect_bad_input({"merge", "sun.partial", "fresnel.partial", "-o", "whole.exr"},
                   "fresnel.partial: is of other materials or models");
  EXPECT_EQ(run({"merge", "sun.partial", "same.partial", "-o", "whole.exr"}).exit_code, 0);
}

TEST_F(LongRender, ResumesToMoreSamplesButNotInAnotherScene) {
  ASSERT_EQ(render("whole.exr").exit_code, 0);
  ASSERT_EQ(render("part.exr", {"--spp", "32", "--checkpoint", "60"}).exit_code, 0);
  ASSERT_EQ(render("part.exr", {"--resume"}).exit_code, 0);
  expect_same_images("part", "whole");
  expect_bad_input({"scene.json", "-o", "part.exr", "--resume", "--seed", "1"}, "part.partial: is of seed 0");
  expect_bad_input({"scene.json", "-o", "part.exr", "--resume", "--aovs", "none"},
                   "part.partial: holds other AOVs");
  expect_bad_input({"scene.json", "-o", "part.exr", "--resume", "--spp", "64"},
                   "part.partial: holds samples");
  write_lambert_scene("scene.json");
  expect_bad_input({"scene.json", "-o", "part.exr", "--resume"}, "part.partial: is of another scene");
}

TEST_F(LongRender, StopsWhenTheErrorIsSmallEnough) {
  const ProgramResult result = render("noise.exr", {"--noise", "0.05"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const Metadata header = read_metadata(folder_ / "noise.exr");
  const auto spp = std::get<std::int64_t>(header.at("spectrace:spp"));
  const ProgramResult half = render("half.exr", {"--spp", std::to_string(spp / 2)});
  const auto error_of = [](const ProgramResult& r) {
    const std::string key = "relative error: ";
    const std::size_t at = r.output.find(key);
    EXPECT_NE(at, std::string::npos) << r.output;
    return std::stod(r.output.substr(at + key.size()));
  };
  EXPECT_LE(error_of(result), 0.05);
  EXPECT_GT(error_of(half), 0.05) << "it would have been enough";
}

TEST_F(LongRender, TakesTheTimeItIsGiven) {
  ASSERT_EQ(render("time.exr", {"--time", "0.5"}).exit_code, 0);
  const Metadata header = read_metadata(folder_ / "time.exr");
  EXPECT_GT(std::get<std::int64_t>(header.at("spectrace:spp")), 8);
  EXPECT_LT(std::get<double>(header.at("spectrace:seconds")), 5)
      << "ten times what it was given: a busy machine";
  const Image image = read_image(folder_ / "time.exr");
  const std::size_t samples = image.find_channel("samples.Z").value();
  for (std::size_t i = samples; i < image.data.size(); i += image.channels.size()) {
    ASSERT_EQ(image.data[i], image.data[samples]) << "all pixels alike";
  }
}

TEST_F(LongRender, ExplainsWhatSamplesMayBe) {
  for (const char* samples : {"8", "8:8", "16:8", "4:8", "a:b", ":8", "0:"}) {
    expect_usage_error({"scene.json", "-o", "x.exr", "--samples", samples});
  }
  expect_usage_error({"scene.json", "-o", "x.exr", "--samples", "0:8", "--spp", "8"});
  expect_usage_error({"scene.json", "-o", "x.exr", "--aovs", "diffus"});
}

TEST_F(LongRender, ExplainsWhatNumbersAndNamesMayBe) {
  // What none of them may be: CLI11 lets NaN pass.
  for (const char* option : {"--time", "--noise", "--checkpoint", "--exposure", "--tolerance"}) {
    for (const char* value : {"nan", "inf", "-1", "x"}) {
      const ProgramResult result = run({"scene.json", "-o", "x.exr", option, value});
      EXPECT_EQ(result.exit_code, 2) << option << ' ' << value;
      EXPECT_TRUE(result.errors.starts_with(std::string(option) + ": " + value + " is not "))
          << result.errors;
    }
  }
  for (const char* option : {"--time", "--checkpoint"}) {
    EXPECT_TRUE(run({"scene.json", "-o", "x.exr", option, "1e300"}).complains("at most 1e+09"));
  }
  EXPECT_TRUE(
      run({"scene.json", "--aov-names", "x"}).complains("--aov-names: x not in {arnold,blender,kpcn}"));
  EXPECT_TRUE(
      run({"scene.json", "--sampler", "x"}).complains("--sampler: x not in {independent,owen-sobol}"));
  EXPECT_TRUE(run({"scene.json", "--aovs", "diffuse_a"}).complains("\"diffuse_a\"; \"halves\" has it"));
  EXPECT_TRUE(run({"scene.json", "--aovs", "beauty_variance"}).complains("; \"variance\" has it"));
  EXPECT_TRUE(run({"scene.json", "--aovs", "normal_variance"}).complains("; \"feature_variance\" has it"));
  EXPECT_TRUE(run({"scene.json", "--aovs", "norml"}).complains("did you mean \"normal\"?"));
}

TEST_F(LongRender, NamesChannelsAsOthersDo) {
  ASSERT_EQ(render("blender.exr", {"--spp", "8", "--aov-names", "blender"}).exit_code, 0);
  const Image blender = read_image(folder_ / "blender.exr");
  for (const char* channel : {"ViewLayer.Combined.R", "ViewLayer.DiffDir.G", "ViewLayer.GlossCol.B",
                              "ViewLayer.Normal.X", "ViewLayer.Depth.Z"}) {
    EXPECT_TRUE(blender.find_channel(channel)) << channel;
  }
  // Light times colour is the light that was there, as Blender's compositor multiplies it.
  ASSERT_EQ(render("own.exr", {"--spp", "8"}).exit_code, 0);
  const Image own = read_image(folder_ / "own.exr");
  const auto at = [](const Image& image, const char* channel) {
    return double(image.at(20, 18, image.find_channel(channel).value()));
  };
  EXPECT_NEAR(at(blender, "ViewLayer.DiffDir.G") * at(blender, "ViewLayer.DiffCol.G"),
              at(own, "diffuse_direct.G"), 1e-5 * at(own, "diffuse_direct.G"));
  ASSERT_EQ(render("kpcn.exr", {"--spp", "8", "--aov-names", "kpcn"}).exit_code, 0);
  const Image kpcn = read_image(folder_ / "kpcn.exr");
  // Every buffer of Bako et al. 2017 and its variance.
  for (const std::string buffer : {"diffuse", "specular", "albedo", "normal", "depth"}) {
    const std::string first = buffer == "normal" ? ".X" : buffer == "depth" ? ".Z" : ".R";
    EXPECT_TRUE(kpcn.find_channel(buffer + first)) << buffer;
    EXPECT_TRUE(kpcn.find_channel(buffer + "Variance" + first)) << buffer;
    EXPECT_FALSE(kpcn.find_channel(buffer + "_variance" + first)) << buffer;
  }
  ASSERT_EQ(render("arnold.exr", {"--spp", "8", "--aov-names", "arnold"}).exit_code, 0);
  EXPECT_EQ(read_image(folder_ / "arnold.exr").channels, own.channels) << "the names that are ours";
}

}  // namespace
}  // namespace spectrace::test

// SPDX-License-Identifier: Apache-2.0
#include "renderer/partial_render.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/base/error.h"
#include "core/base/file.h"
#include "renderer/render.h"
#include "tests/support/render_scenes.h"
#include "tests/support/temporary_folder.h"

namespace spectrace::test {
namespace {

class PartialRenders : public testing::Test {
 protected:
  PartialRenders() {
    description_ = empty_scene();
    description_.sha256 = "of a test";
    description_.materials = {lambert("grey", Float(0.5))};
    description_.shapes = {sphere({0, 0, 0}, 1, "grey")};
    description_.lights = {sky(1)};
    description_.film = {20, 18};
    description_.film.spectral = SpectralFilmDesc{.bins = {.range = {360, 830}, .count = 7}};
  }
  PartialRender part(std::uint64_t first, int spp, std::uint64_t seed = 0) {
    scene_.emplace(build_scene(description_, progress_));
    RenderSession session(*scene_, {.spp = spp, .seed = seed, .aovs = kAllAovs, .first = first});
    session.finish(progress_);
    // Each type that a header has; 360.0 must not come back as an integer.
    Metadata header{{"spectrace:kernel", session.report().kernel},
                    {"spectrace:threads", std::int64_t(2)},
                    {"spectrace:lambdaMinNm", 360.0}};
    return {identity_of(*scene_, seed), std::move(header), session.film()};
  }
  std::filesystem::path written(const std::string& name, const PartialRender& partial) {
    write_partial(folder_ / name, partial);
    return folder_ / name;
  }
  std::string refusal(const std::vector<std::filesystem::path>& files) {
    try {
      (void)merge_partials(files);
    } catch (const InputError& e) {
      return e.diagnostics().front().text();
    }
    return "";
  }

  TemporaryFolder folder_;
  SilentProgress progress_;
  SceneDesc description_;
  std::optional<Scene> scene_;
};

void expect_same(const Film& a, const Film& b) {
  EXPECT_EQ(a.resolve().channels, b.resolve().channels);
  EXPECT_EQ(a.resolve().data, b.resolve().data);
  EXPECT_EQ(a.resolve_spectral(Layer::kSpecular).data, b.resolve_spectral(Layer::kSpecular).data);
}

TEST_F(PartialRenders, EndNoSoonerForATimeThatNeverComes) {
  scene_.emplace(build_scene(description_, progress_));
  RenderSession session(*scene_, {.spp = 64, .seconds = 1e300});
  session.finish(progress_);
  EXPECT_EQ(session.report().samples.last, 64U);
}

TEST_F(PartialRenders, ComeBackAsTheyWereWritten) {
  const PartialRender partial = part(8, 24, 5);
  const PartialRender read = read_partial(written("a.partial", partial));
  EXPECT_EQ(read.identity.seed, 5U);
  EXPECT_EQ(read.identity.sampler, SamplerKind::kOwenSobol);
  EXPECT_EQ(read.identity.scene_sha256, "of a test");
  EXPECT_EQ(read.identity.program, partial.identity.program);
  EXPECT_EQ(read.metadata, partial.metadata);
  EXPECT_EQ(read.film.layout(), partial.film.layout());
  EXPECT_EQ(read.film.target(), partial.film.target());
  expect_same(read.film, partial.film);
}

TEST_F(PartialRenders, MergeInAnyOrderToTheBitsOfOneRender) {
  const PartialRender whole = part(0, 44);
  const auto a = written("a.partial", part(0, 8)), b = written("b.partial", part(8, 16)),
             c = written("c.partial", part(24, 20));
  for (const auto& files : std::vector<std::vector<std::filesystem::path>>{{a, b, c}, {c, a, b}, {b, c, a}}) {
    expect_same(merge_partials(files).film, whole.film);
  }
}

TEST_F(PartialRenders, OfAnEmptySceneHoldNoCounts) {
  description_.shapes.clear();
  const PartialRender partial = part(0, 8);
  EXPECT_TRUE(partial.film.matte_counts(Matte::kObject).empty());
  expect_same(read_partial(written("a.partial", partial)).film, partial.film);
}

TEST_F(PartialRenders, AreNotMergedWhereTheyAreNotPartsOfOneImage) {
  const auto a = written("a.partial", part(0, 16)), overlap = written("overlap.partial", part(8, 16)),
             gap = written("gap.partial", part(24, 8)), seed = written("seed.partial", part(16, 8, 1));
  EXPECT_NE(refusal({a, overlap}).find("overlap"), std::string::npos) << refusal({a, overlap});
  EXPECT_NE(refusal({a, gap}).find("samples 16:24 are missing"), std::string::npos) << refusal({a, gap});
  EXPECT_NE(refusal({a, seed}).find("seed"), std::string::npos) << refusal({a, seed});
  EXPECT_NE(refusal({a, a}).find("overlap"), std::string::npos);
  description_.sha256 = "of another";
  const auto other = written("other.partial", part(16, 8));
  EXPECT_NE(refusal({a, other}).find("another scene"), std::string::npos) << refusal({a, other});
  description_.sha256 = "of a test";
  description_.sampler = SamplerKind::kIndependent;
  const auto sampler = written("sampler.partial", part(16, 8));
  EXPECT_NE(refusal({a, sampler}).find("sampler independent, not owen-sobol"), std::string::npos)
      << refusal({a, sampler});
  description_.sampler = SamplerKind::kOwenSobol;
  description_.film.spectral->bins.count = 8;
  const auto bins = written("bins.partial", part(16, 8));
  EXPECT_NE(refusal({a, bins}).find("wavelengths"), std::string::npos) << refusal({a, bins});
}

TEST_F(PartialRenders, DamageIsRefused) {
  const std::vector<std::byte> bytes = read_file(written("a.partial", part(0, 16)));
  const auto write = [&](const char* name, std::span<const std::byte> content) {
    std::ofstream(folder_ / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(content.data()), std::streamsize(content.size()));
  };
  for (std::size_t size = 0; size < bytes.size(); size += 997) {
    write("cut.partial", std::span(bytes).first(size));
    EXPECT_THROW((void)read_partial(folder_ / "cut.partial"), InputError) << size;
  }
  // A byte of the header changed, or of the sums: a wrong picture would look like a right one.
  for (std::size_t i = 0; i < bytes.size(); i += i < 4000 ? 7 : 4999) {
    std::vector<std::byte> damaged = bytes;
    damaged[i] ^= std::byte{0x15};
    write("flipped.partial", damaged);
    EXPECT_THROW((void)read_partial(folder_ / "flipped.partial"), InputError) << "byte " << i;
  }
}

}  // namespace
}  // namespace spectrace::test

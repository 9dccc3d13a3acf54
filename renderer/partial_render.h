// SPDX-License-Identifier: Apache-2.0
// A film on its way: what a checkpoint holds, and what one of several machines renders of an image. Layout:
// docs/file-formats.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "renderer/film.h"
#include "renderer/scene.h"

namespace spectrace {

/// What must be the same for two films to be parts of one image.
struct RenderIdentity {
  std::string program;  ///< version and commit
  std::string scene_sha256;
  std::vector<std::string> material_sha256s, file_sha256s;  ///< as a Scene's
  std::vector<std::string> approximations;
  std::uint64_t seed = 0;
  SamplerKind sampler = SamplerKind::kOwenSobol;
};
[[nodiscard]] RenderIdentity identity_of(const Scene& scene, std::uint64_t seed);

struct PartialRender {
  RenderIdentity identity;
  Metadata metadata;  ///< of the image it would make
  Film film;
};

/// Aside and renamed.
void write_partial(const std::filesystem::path& file, const PartialRender& partial);
/// Throws InputError naming the field that is wrong. Memory is bounded by the file's size.
[[nodiscard]] PartialRender read_partial(const std::filesystem::path& file);

/// Throws InputError, naming `file`, where it is of another scene, seed, sampler, program or layout than is
/// wanted.
void check_same_image(const PartialRender& partial, const std::filesystem::path& file,
                      const RenderIdentity& identity, int width, int height, const FilmLayout& layout);

/// Joins parts that follow one another to the very film that one machine gives. Throws InputError where they
/// are of different images, overlap, leave samples out or are not complete.
[[nodiscard]] PartialRender merge_partials(const std::vector<std::filesystem::path>& files);

}  // namespace spectrace

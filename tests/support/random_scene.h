// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "renderer/scene_desc.h"

namespace spectrace::test {

/// A valid scene, the same for the same seed: up to a dozen shapes of any kind, turned, stretched and through
/// one another, of any analytic material, rough or smooth, plain or nested; lamps and lights of powers that
/// span ten decades; a camera anywhere, inside things too. 12 x 10 pixels.
SceneDesc random_scene(std::uint64_t seed);

}  // namespace spectrace::test

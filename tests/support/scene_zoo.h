// SPDX-License-Identifier: Apache-2.0
// Small scenes that together use every effect: what must hold for every scene is tested on all of these.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "renderer/scene_desc.h"

namespace spectrace::test {

struct NamedScene {
  std::string name;
  SceneDesc scene;

  friend void PrintTo(const NamedScene& named, std::ostream* out) { *out << named.name; }  // for GoogleTest
};
std::vector<NamedScene> scene_zoo();

}  // namespace spectrace::test

// SPDX-License-Identifier: Apache-2.0
#include "renderer/light_bounds.h"

#include <algorithm>

#include "core/math/math.h"

namespace spectrace {

double LightBounds::agreement() const {
  const double squared = sqr(directed[0]) + sqr(directed[1]) + sqr(directed[2]);
  return facing > 0 ? std::min(squared / sqr(facing), 1.0) : 0;
}

LightBounds unite(const LightBounds& a, const LightBounds& b) {
  if (a.box.empty()) return b;
  if (b.box.empty()) return a;
  LightBounds all = a;
  all.box.add(b.box.min);
  all.box.add(b.box.max);
  const auto reach = [&](const LightBounds& part) {
    return double(length(part.center() - all.center())) + part.radius;
  };
  all.radius = std::min(double(all.box.radius()), std::max(reach(a), reach(b)));
  all.around += b.around;
  all.facing += b.facing;
  for (std::size_t i = 0; i < 3; ++i) all.directed[i] += b.directed[i];
  return all;
}

LightBounds bounds_around(const Box& box, double radius, double intensity) {
  return {.box = box, .radius = radius, .around = intensity};
}

LightBounds bounds_facing(const Box& box, Vec3 n, double intensity) {
  return {.box = box,
          .radius = double(box.radius()),
          .facing = intensity,
          .directed = {intensity * double(n.x), intensity * double(n.y), intensity * double(n.z)}};
}

}  // namespace spectrace

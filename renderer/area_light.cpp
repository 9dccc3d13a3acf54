// SPDX-License-Identifier: Apache-2.0
#include "renderer/area_light.h"

#include <cmath>

#include "core/math/concentric_disk.h"
#include "core/math/math.h"
#include "renderer/surface.h"

namespace spectrace {

namespace {

/// 1 - cosθ of the cone a sphere fills, without cancellation for distant spheres; nullopt from inside.
std::optional<Float> cone_size(const Sphere& sphere, Float distance) {
  if (!(distance > sphere.radius)) {
    return std::nullopt;
  }
  const Float sin_max = sphere.radius / distance;
  // 1 - sin² as a product: no cancellation near the surface.
  const Float cos_max = safe_sqrt((distance - sphere.radius) / distance * (1 + sin_max));
  return sin_max * sin_max / (1 + cos_max);
}

Float cone_pdf(Float one_minus_cos_max) { return 1 / (2 * kPi * one_minus_cos_max); }

std::optional<LightPoint> sample(const Sphere& sphere, Vec3 from, Vec2 u) {
  const Vec3 to_center = sphere.center - from;
  const Float distance = length(to_center);
  const std::optional<Float> size = cone_size(sphere, distance);
  if (!size || !(*size > 0)) {
    return std::nullopt;
  }
  const Float drop = u.x * *size;  // 1 - cosθ
  const Float cos_theta = 1 - drop;
  const Float sin2_theta = drop * (2 - drop);
  const Float phi = 2 * kPi * u.y;
  const Float sin_theta = safe_sqrt(sin2_theta);
  const Frame frame = Frame::from_normal(to_center / distance);
  const Vec3 wi = frame.to_world({sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta});
  const Float t = distance * cos_theta - safe_sqrt(sqr(sphere.radius) - sqr(distance) * sin2_theta);
  const Vec3 normal = detail::normalize_any(wi * t - to_center);
  const Float error = kOffsetSteps * kFloatRounding * (max_abs(sphere.center) + sphere.radius);
  return LightPoint{wi, sphere.center + normal * (sphere.radius + error), cone_pdf(*size)};
}

/// Density over the area turned into one over directions: distance² / (area · cosine).
Float area_pdf(Float area, Float distance_squared, Float cosine) {
  return distance_squared / (area * cosine);
}

std::optional<LightPoint> sample_flat(Vec3 point, Vec3 scaled_normal, Float magnitude, Vec3 from) {
  const Float area = length(scaled_normal);
  const Vec3 normal = scaled_normal / area;
  const Vec3 way = point - from;
  const Float distance_squared = length_squared(way);
  const Vec3 wi = way / std::sqrt(distance_squared);
  const Float cosine = -dot(wi, normal);
  if (!(cosine > 0) || !(distance_squared > 0)) {
    return std::nullopt;
  }
  const Float pdf = area_pdf(area, distance_squared, cosine);
  if (!std::isfinite(pdf)) {
    return std::nullopt;
  }
  return LightPoint{wi, point + normal * (kOffsetSteps * kFloatRounding * magnitude), pdf};
}

Vec3 scaled_normal(const TriangleLight& t) { return cross(t.edge_1, t.edge_2) * Float(0.5); }

std::optional<LightPoint> sample(const Quad& quad, Vec3 from, Vec2 u) {
  return sample_flat(quad.corner + quad.edge_u * u.x + quad.edge_v * u.y, quad.scaled_normal(),
                     largest_coordinate(quad), from);
}

std::optional<LightPoint> sample(const Disk& disk, Vec3 from, Vec2 u) {
  const Vec2 on_disk = concentric_disk(u);
  return sample_flat(disk.center + disk.edge_u * on_disk.x + disk.edge_v * on_disk.y, disk.scaled_normal(),
                     largest_coordinate(disk), from);
}

std::optional<LightPoint> sample(const TriangleLight& triangle, Vec3 from, Vec2 u) {
  // Square to triangle, area preserving: Turk 1990.
  const Float root = std::sqrt(u.x);
  const Vec3 point = triangle.p0 + triangle.edge_1 * (root * (1 - u.y)) + triangle.edge_2 * (root * u.y);
  return sample_flat(point, scaled_normal(triangle),
                     max_abs(triangle.p0) + max_abs(triangle.edge_1) + max_abs(triangle.edge_2), from);
}

double area(const Sphere& sphere) { return 4 * double(kPi) * sphere.radius * sphere.radius; }
double area(const Quad& quad) { return length(quad.scaled_normal()); }
double area(const Disk& disk) { return length(disk.scaled_normal()); }
double area(const TriangleLight& triangle) { return length(scaled_normal(triangle)); }

LightBounds bounds_of(const Sphere& sphere, double radiance) {
  return bounds_around(bounds(Shape{.geometry = sphere}), double(sphere.radius),
                       radiance * kPi64 * sqr(double(sphere.radius)));
}
LightBounds flat_bounds(const Box& box, Vec3 scaled_normal, double radiance) {
  return bounds_facing(box, detail::normalize_any(scaled_normal), radiance * double(length(scaled_normal)));
}
LightBounds bounds_of(const Quad& quad, double radiance) {
  return flat_bounds(bounds(Shape{.geometry = quad}), quad.scaled_normal(), radiance);
}
LightBounds bounds_of(const Disk& disk, double radiance) {
  return flat_bounds(bounds(Shape{.geometry = disk}), disk.scaled_normal(), radiance);
}
LightBounds bounds_of(const TriangleLight& t, double radiance) {
  Box box;
  for (Vec3 p : {t.p0, t.p0 + t.edge_1, t.p0 + t.edge_2}) box.add(p);
  return flat_bounds(box, scaled_normal(t), radiance);
}

}  // namespace

std::optional<LightPoint> sample_light(const LightShape& light, Vec3 from, Vec2 u) {
  return std::visit([&](const auto& shape) { return sample(shape, from, u); }, light);
}

Float light_pdf(const LightShape& light, Vec3 from, Vec3 wi, Vec3 position, Vec3 normal) {
  if (const auto* sphere = std::get_if<Sphere>(&light)) {
    const std::optional<Float> size = cone_size(*sphere, length(sphere->center - from));
    return size && *size > 0 ? cone_pdf(*size) : 0;
  }
  const Float cosine = -dot(wi, normal);
  if (!(cosine > 0)) {
    return 0;
  }
  const Float pdf = area_pdf(Float(light_area(light)), length_squared(position - from), cosine);
  return std::isfinite(pdf) ? pdf : 0;
}

double light_area(const LightShape& light) {
  return std::visit([](const auto& shape) { return area(shape); }, light);
}

LightBounds light_bounds(const LightShape& light, double radiance) {
  return std::visit([&](const auto& shape) { return bounds_of(shape, radiance); }, light);
}

}  // namespace spectrace

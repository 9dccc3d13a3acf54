// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/math/math.h"
#include "renderer/geometry.h"
#include "renderer/ray_cone.h"
#include "renderer/scene_desc.h"

namespace spectrace {

/// Pinhole, thin lens, or orthographic. Image x runs to the viewer's right, row 0 is at the top; looking
/// along +y with z up, +x is right.
class Camera {
 public:
  /// `target` must differ from `origin`, `up` must not lie along the view (checked by build_scene).
  Camera(const CameraDesc& camera, const FilmDesc& film)
      : origin_(camera.origin),
        width_(Float(film.width)),
        height_(Float(film.height)),
        is_orthographic_(camera.projection == Projection::kOrthographic),
        lens_radius_(camera.lens_radius),
        focus_distance_(camera.focus_distance > 0 ? camera.focus_distance
                                                  : length(camera.target - camera.origin)) {
    forward_ = normalize(camera.target - camera.origin);
    right_ = normalize(cross(forward_, camera.up));
    down_ = cross(forward_, right_);
    const Float size =
        is_orthographic_ ? camera.view_size : 2 * std::tan(degrees_to_radians(camera.fov_deg) / 2);
    pixel_ = size / std::min(width_, height_);
    step_x_ = right_ * pixel_;
    step_y_ = down_ * pixel_;
  }

  /// What a ray through the film stands for: as wide as a pixel's narrower side seen along the ray.
  [[nodiscard]] RayCone cone(const Ray& ray) const {
    if (is_orthographic_) return {pixel_, 0};
    return {0, pixel_ * sqr(dot(ray.direction, forward_))};
  }

  [[nodiscard]] bool has_lens() const { return lens_radius_ > 0; }

  /// Through the film at `position` [pixels], (0, 0) being the image's upper left corner, and the middle of
  /// the lens. Unit direction.
  [[nodiscard]] Ray ray(Vec2 position) const {
    const Vec3 off_axis = step_x_ * (position.x - width_ / 2) + step_y_ * (position.y - height_ / 2);
    if (is_orthographic_) return {origin_ + off_axis, forward_};
    return {origin_, normalize(forward_ + off_axis)};
  }

  /// Through the lens at `on_disk`, a point of the unit disk: all these rays meet in the plane of focus.
  [[nodiscard]] Ray ray(Vec2 position, Vec2 on_disk) const {
    const Ray central = ray(position);
    if (!has_lens()) return central;
    const Vec3 focus =
        central.origin + central.direction * (focus_distance_ / dot(central.direction, forward_));
    const Vec3 origin = central.origin + (right_ * on_disk.x + down_ * on_disk.y) * lens_radius_;
    return {origin, normalize(focus - origin)};
  }

 private:
  Vec3 origin_, forward_, right_, down_, step_x_, step_y_;
  Float width_, height_;
  bool is_orthographic_;
  Float lens_radius_, focus_distance_;
  Float pixel_ = 0;  // perspective: at distance 1
};

}  // namespace spectrace

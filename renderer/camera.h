// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/math/math.h"
#include "renderer/geometry.h"
#include "renderer/scene_desc.h"

namespace spectrace {

/// Pinhole. Image x runs to the viewer's right, row 0 is at the top; looking along +y with z up, +x is right.
class Camera {
 public:
  /// `target` must differ from `origin`, `up` must not lie along the view (checked by build_scene).
  Camera(const CameraDesc& camera, const FilmDesc& film)
      : origin_(camera.origin), width_(Float(film.width)), height_(Float(film.height)) {
    forward_ = normalize(camera.target - camera.origin);
    const Vec3 right = normalize(cross(forward_, camera.up));
    const Vec3 down = cross(forward_, right);
    const Float pixel = 2 * std::tan(degrees_to_radians(camera.fov_deg) / 2) / std::min(width_, height_);
    step_x_ = right * pixel;
    step_y_ = down * pixel;
  }

  /// Through the film at `position` [pixels], (0, 0) being the image's upper left corner. Unit direction.
  [[nodiscard]] Ray ray(Vec2 position) const {
    return {origin_,
            normalize(forward_ + step_x_ * (position.x - width_ / 2) + step_y_ * (position.y - height_ / 2))};
  }

 private:
  Vec3 origin_, forward_, step_x_, step_y_;
  Float width_, height_;
};

}  // namespace spectrace

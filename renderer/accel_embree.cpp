// SPDX-License-Identifier: Apache-2.0
#include "renderer/accel_embree.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace spectrace {

namespace {

RTCRay embree_ray(const Ray& ray) {
  RTCRay r{};
  r.org_x = float(ray.origin.x);
  r.org_y = float(ray.origin.y);
  r.org_z = float(ray.origin.z);
  r.dir_x = float(ray.direction.x);
  r.dir_y = float(ray.direction.y);
  r.dir_z = float(ray.direction.z);
  r.tnear = 0;
  r.tfar = float(ray.t_max);
  r.mask = ~0U;
  return r;
}

/// The first crossing within the ray's interval. tnear itself is excluded.
std::optional<float> sphere_hit(const RTCRay& r, const Sphere& sphere) {
  const Ray ray{{Float(r.org_x), Float(r.org_y), Float(r.org_z)},
                {Float(r.dir_x), Float(r.dir_y), Float(r.dir_z)}};
  const std::optional<SphereCrossings> crossings = intersect_sphere(sphere, ray);
  if (!crossings) {
    return std::nullopt;
  }
  for (double t : {crossings->near, crossings->far}) {
    if (t > double(r.tnear) && t < double(r.tfar)) {
      return float(t);
    }
  }
  return std::nullopt;
}

void sphere_bounds(const RTCBoundsFunctionArguments* args) {
  const Sphere& s = *static_cast<const Sphere*>(args->geometryUserPtr);
  // Outwards by some rounding steps of centre + radius, so that the box holds the sphere.
  constexpr float kRounding = 4 * 0x1p-24F;
  const float margin = kRounding * float(max_abs(s.center) + s.radius);
  RTCBounds& b = *args->bounds_o;
  b.lower_x = float(s.center.x - s.radius) - margin;
  b.lower_y = float(s.center.y - s.radius) - margin;
  b.lower_z = float(s.center.z - s.radius) - margin;
  b.upper_x = float(s.center.x + s.radius) + margin;
  b.upper_y = float(s.center.y + s.radius) + margin;
  b.upper_z = float(s.center.z + s.radius) + margin;
}

void sphere_intersect(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] == 0) {  // queries here are single rays: N == 1
    return;
  }
  const auto* sphere = static_cast<const Sphere*>(args->geometryUserPtr);
  auto* rayhit = reinterpret_cast<RTCRayHit*>(args->rayhit);
  if (const std::optional<float> t = sphere_hit(rayhit->ray, *sphere)) {
    rayhit->ray.tfar = *t;
    rayhit->hit.u = 0;
    rayhit->hit.v = 0;
    rayhit->hit.geomID = args->geomID;
    rayhit->hit.primID = args->primID;
    rayhit->hit.instID[0] = args->context->instID[0];
  }
}

void sphere_occluded(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] == 0) {
    return;
  }
  const auto* sphere = static_cast<const Sphere*>(args->geometryUserPtr);
  auto* ray = reinterpret_cast<RTCRay*>(args->ray);
  if (sphere_hit(*ray, *sphere)) {
    ray->tfar = -std::numeric_limits<float>::infinity();
  }
}

void disk_bounds(const RTCBoundsFunctionArguments* args) {
  const Disk& disk = *static_cast<const Disk*>(args->geometryUserPtr);
  const Vec3 half = disk.half_extent();
  // Some rounding steps, as around spheres.
  const float margin = 4 * 0x1p-24F * float(largest_coordinate(disk));
  RTCBounds& b = *args->bounds_o;
  b.lower_x = float(disk.center.x - half.x) - margin;
  b.lower_y = float(disk.center.y - half.y) - margin;
  b.lower_z = float(disk.center.z - half.z) - margin;
  b.upper_x = float(disk.center.x + half.x) + margin;
  b.upper_y = float(disk.center.y + half.y) + margin;
  b.upper_z = float(disk.center.z + half.z) + margin;
}

std::optional<DiskCrossing> disk_hit(const RTCRay& r, const Disk& disk) {
  const Ray ray{{Float(r.org_x), Float(r.org_y), Float(r.org_z)},
                {Float(r.dir_x), Float(r.dir_y), Float(r.dir_z)}};
  const std::optional<DiskCrossing> crossing = intersect_disk(disk, ray);
  return crossing && crossing->t > double(r.tnear) && crossing->t < double(r.tfar) ? crossing : std::nullopt;
}

void disk_intersect(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] == 0) {
    return;
  }
  auto* rayhit = reinterpret_cast<RTCRayHit*>(args->rayhit);
  if (const auto hit = disk_hit(rayhit->ray, *static_cast<const Disk*>(args->geometryUserPtr))) {
    rayhit->ray.tfar = float(hit->t);
    rayhit->hit.u = float(hit->x);
    rayhit->hit.v = float(hit->y);
    rayhit->hit.geomID = args->geomID;
    rayhit->hit.primID = args->primID;
    rayhit->hit.instID[0] = args->context->instID[0];
  }
}

void disk_occluded(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] == 0) {
    return;
  }
  auto* ray = reinterpret_cast<RTCRay*>(args->ray);
  if (disk_hit(*ray, *static_cast<const Disk*>(args->geometryUserPtr))) {
    ray->tfar = -std::numeric_limits<float>::infinity();
  }
}

}  // namespace

struct Accel::Impl {
  RTCDevice device = nullptr;
  RTCScene world = nullptr;
  std::vector<RTCScene> groups;
  std::vector<Sphere> spheres;  // never grows after the first sphere is attached
  std::vector<Disk> disks;      // likewise
  // Embree numbers the geometries of each of its scenes from 0: the shape is base + number.
  std::uint32_t world_base = 0;
  std::vector<std::uint32_t> group_base;      // by group
  std::vector<std::uint32_t> instance_group;  // by instance
  std::uint32_t first_instance_id = 0;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    rtcReleaseScene(world);
    for (RTCScene scene : groups) {
      rtcReleaseScene(scene);
    }
    rtcReleaseDevice(device);
  }

  void check() const {
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE) {
      throw InternalError("Embree reports error " + std::to_string(int(error)));
    }
  }
  [[nodiscard]] RTCScene new_scene() const {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);  // watertight: hard case H16
    return scene;
  }
  void attach(RTCScene scene, RTCGeometry geometry, std::uint32_t id) const {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
  }
  void attach_shape(RTCScene scene, const TriangleMesh& mesh, std::uint32_t id) const {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.triangles.size()));
    check();
    for (Vec3 p : mesh.positions) {
      *vertices++ = float(p.x);
      *vertices++ = float(p.y);
      *vertices++ = float(p.z);
    }
    for (const auto& triangle : mesh.triangles) {
      indices = std::copy(triangle.begin(), triangle.end(), indices);
    }
    attach(scene, geometry, id);
  }
  void attach_shape(RTCScene scene, const Quad& quad, std::uint32_t id) const {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                                 RTC_FORMAT_FLOAT3, 3 * sizeof(float), 4));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(std::uint32_t), 1));
    check();
    for (Vec3 p : {quad.corner, quad.corner + quad.edge_u, quad.corner + quad.edge_u + quad.edge_v,
                   quad.corner + quad.edge_v}) {
      *vertices++ = float(p.x);
      *vertices++ = float(p.y);
      *vertices++ = float(p.z);
    }
    for (std::uint32_t i = 0; i < 4; ++i) {
      indices[i] = i;
    }
    attach(scene, geometry, id);
  }
  void attach_shape(RTCScene scene, const Sphere& sphere, std::uint32_t id) {
    spheres.push_back(sphere);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, &spheres.back());
    rtcSetGeometryBoundsFunction(geometry, sphere_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, sphere_intersect);
    rtcSetGeometryOccludedFunction(geometry, sphere_occluded);
    attach(scene, geometry, id);
  }
  void attach_shape(RTCScene scene, const Disk& disk, std::uint32_t id) {
    disks.push_back(disk);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, &disks.back());
    rtcSetGeometryBoundsFunction(geometry, disk_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, disk_intersect);
    rtcSetGeometryOccludedFunction(geometry, disk_occluded);
    attach(scene, geometry, id);
  }
  void attach_shapes(RTCScene scene, const Geometry& geometry, ShapeRange range) {
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      const std::uint32_t id = i - range.begin;
      std::visit([&](const auto& shape) { attach_shape(scene, shape, id); }, geometry.shapes[i].geometry);
    }
  }
  void attach_instance(const Instance& instance, std::uint32_t id) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, groups[instance.group]);
    rtcSetGeometryTimeStepCount(geometry, 1);
    float rows[12];
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 4; ++c) {
        rows[r * 4 + c] = float(instance.to_world.m[r][c]);
      }
    }
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, rows);
    attach(world, geometry, id);
  }
};

Accel::Accel(const Geometry& geometry) : impl_(std::make_unique<Impl>()) {
  impl_->device = rtcNewDevice(nullptr);
  if (impl_->device == nullptr) {
    throw InternalError("Embree offers no device on this machine");
  }
  impl_->spheres.reserve(geometry.shapes.size());
  impl_->disks.reserve(geometry.shapes.size());
  for (const ShapeRange& range : geometry.groups) {
    RTCScene scene = impl_->new_scene();
    impl_->groups.push_back(scene);
    impl_->group_base.push_back(range.begin);
    impl_->attach_shapes(scene, geometry, range);
    rtcCommitScene(scene);
    impl_->check();
  }
  impl_->world = impl_->new_scene();
  impl_->attach_shapes(impl_->world, geometry, geometry.top);
  impl_->world_base = geometry.top.begin;
  impl_->first_instance_id = geometry.top.end - geometry.top.begin;
  for (std::uint32_t i = 0; i < geometry.instances.size(); ++i) {
    impl_->attach_instance(geometry.instances[i], impl_->first_instance_id + i);
    impl_->instance_group.push_back(geometry.instances[i].group);
  }
  rtcCommitScene(impl_->world);
  impl_->check();
}

Accel::Accel(Accel&&) noexcept = default;
Accel& Accel::operator=(Accel&&) noexcept = default;
Accel::~Accel() = default;

std::optional<Intersection> Accel::intersect(const Ray& ray) const {
  RTCRayHit rayhit{};
  rayhit.ray = embree_ray(ray);
  rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(impl_->world, &rayhit);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(impl_->world, &context, &rayhit);
#endif
  if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
    return std::nullopt;
  }
  Intersection hit{.t = rayhit.ray.tfar,
                   .u = rayhit.hit.u,
                   .v = rayhit.hit.v,
                   .shape = rayhit.hit.geomID,
                   .primitive = rayhit.hit.primID};
  if (rayhit.hit.instID[0] != RTC_INVALID_GEOMETRY_ID) {
    hit.instance = rayhit.hit.instID[0] - impl_->first_instance_id;
    hit.shape += impl_->group_base[impl_->instance_group[hit.instance]];
  } else {
    hit.shape += impl_->world_base;
  }
  return hit;
}

bool Accel::occluded(const Ray& ray) const {
  RTCRay r = embree_ray(ray);
#if RTC_VERSION_MAJOR >= 4
  rtcOccluded1(impl_->world, &r);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(impl_->world, &context, &r);
#endif
  return r.tfar < 0;  // Embree's sign of a hit: -inf
}

#if defined(__SSE2__)
namespace {
constexpr unsigned kFlushBits = 0x8040;  // MXCSR: flush to zero (15), denormals are zero (6)
}
FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | kFlushBits); }
FlushDenormals::~FlushDenormals() { _mm_setcsr(saved_); }
#else
FlushDenormals::FlushDenormals() : saved_(0) {}
FlushDenormals::~FlushDenormals() = default;
#endif

}  // namespace spectrace

// SPDX-License-Identifier: Apache-2.0
#include "renderer/accel_embree.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
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

/// The box centre ± half, outwards by some rounding steps of the largest coordinate, so that it holds the
/// primitive.
RTCBounds box_around(Vec3 center, Vec3 half, Float largest) {
  const float margin = 4 * 0x1p-24F * float(largest);
  const Vec3 low = center - half, high = center + half;
  RTCBounds b{};
  b.lower_x = float(low.x) - margin;
  b.lower_y = float(low.y) - margin;
  b.lower_z = float(low.z) - margin;
  b.upper_x = float(high.x) + margin;
  b.upper_y = float(high.y) + margin;
  b.upper_z = float(high.z) + margin;
  return b;
}

void sphere_bounds(const RTCBoundsFunctionArguments* args) {
  const Sphere& s = *static_cast<const Sphere*>(args->geometryUserPtr);
  *args->bounds_o = box_around(s.center, {s.radius, s.radius, s.radius}, max_abs(s.center) + s.radius);
}

void disk_bounds(const RTCBoundsFunctionArguments* args) {
  const Disk& disk = *static_cast<const Disk*>(args->geometryUserPtr);
  *args->bounds_o = box_around(disk.center, disk.half_extent(), largest_coordinate(disk));
}

/// What a primitive of ours tells Embree of a crossing.
struct UserHit {
  float t = 0, u = 0, v = 0;
};

/// The first crossing with t in (near, far). u: what is left of t beyond its float (hard case H15).
std::optional<UserHit> user_hit(const Sphere& sphere, const Ray& ray, float near, float far) {
  const std::optional<SphereCrossings> crossings = intersect_sphere(sphere, ray);
  if (!crossings) return std::nullopt;
  for (double t : {crossings->near, crossings->far}) {
    if (t > double(near) && t < double(far)) return UserHit{float(t), float(t - double(float(t))), 0};
  }
  return std::nullopt;
}

std::optional<UserHit> user_hit(const Disk& disk, const Ray& ray, float near, float far) {
  const std::optional<DiskCrossing> crossing = intersect_disk(disk, ray);
  if (!crossing || !(crossing->t > double(near) && crossing->t < double(far))) return std::nullopt;
  return UserHit{float(crossing->t), float(crossing->x), float(crossing->y)};
}

Ray ray_of(RTCRayN* rays, unsigned n, unsigned i) {
  return {
      {Float(RTCRayN_org_x(rays, n, i)), Float(RTCRayN_org_y(rays, n, i)), Float(RTCRayN_org_z(rays, n, i))},
      {Float(RTCRayN_dir_x(rays, n, i)), Float(RTCRayN_dir_y(rays, n, i)), Float(RTCRayN_dir_z(rays, n, i))}};
}

template <typename Primitive>
void intersect_user(const RTCIntersectFunctionNArguments* args) {
  const unsigned n = args->N;
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, n);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, n);
  for (unsigned i = 0; i < n; ++i) {
    if (args->valid[i] == 0) continue;
    const std::optional<UserHit> hit =
        user_hit(*static_cast<const Primitive*>(args->geometryUserPtr), ray_of(rays, n, i),
                 RTCRayN_tnear(rays, n, i), RTCRayN_tfar(rays, n, i));
    if (!hit) continue;
    RTCRayN_tfar(rays, n, i) = hit->t;
    RTCHitN_u(hits, n, i) = hit->u;
    RTCHitN_v(hits, n, i) = hit->v;
    RTCHitN_geomID(hits, n, i) = args->geomID;
    RTCHitN_primID(hits, n, i) = args->primID;
    RTCHitN_instID(hits, n, i, 0) = args->context->instID[0];
  }
}

template <typename Primitive>
void occlude_user(const RTCOccludedFunctionNArguments* args) {
  const unsigned n = args->N;
  for (unsigned i = 0; i < n; ++i) {
    if (args->valid[i] == 0) continue;
    if (user_hit(*static_cast<const Primitive*>(args->geometryUserPtr), ray_of(args->ray, n, i),
                 RTCRayN_tnear(args->ray, n, i), RTCRayN_tfar(args->ray, n, i))) {
      RTCRayN_tfar(args->ray, n, i) = -std::numeric_limits<float>::infinity();
    }
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
  std::vector<bool> is_quad;  // by shape

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
  /// Two triangles, u and v of each along the quad's edges from opposite corners: Embree keeps a tree for
  /// each kind of geometry, and a ray that need not walk a second one is the faster.
  void attach_shape(RTCScene scene, const Quad& quad, std::uint32_t id) const {
    const Vec3 a = quad.corner, b = a + quad.edge_u, c = b + quad.edge_v, d = a + quad.edge_v;
    attach_shape(scene, TriangleMesh{{a, b, c, d}, {{0, 1, 3}, {2, 3, 1}}, {}, {}}, id);
  }
  void attach_shape(RTCScene scene, const Sphere& sphere, std::uint32_t id) {
    attach_user(scene, spheres.emplace_back(sphere), sphere_bounds, id);
  }
  void attach_shape(RTCScene scene, const Disk& disk, std::uint32_t id) {
    attach_user(scene, disks.emplace_back(disk), disk_bounds, id);
  }
  template <typename Primitive>
  void attach_user(RTCScene scene, Primitive& primitive, RTCBoundsFunction bounds, std::uint32_t id) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, &primitive);
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_user<Primitive>);
    rtcSetGeometryOccludedFunction(geometry, occlude_user<Primitive>);
    attach(scene, geometry, id);
  }
  void attach_shapes(RTCScene scene, const Geometry& geometry, ShapeRange range) {
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      const std::uint32_t id = i - range.begin;
      std::visit([&](const auto& shape) { attach_shape(scene, shape, id); }, geometry.shapes[i].geometry);
    }
  }
  /// `hit` with its shape and instance, or that nothing was hit.
  [[nodiscard]] std::optional<Intersection> found(unsigned geometry, unsigned instance,
                                                  Intersection hit) const;

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
  for (const Shape& shape : geometry.shapes) {
    impl_->is_quad.push_back(std::holds_alternative<Quad>(shape.geometry));
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

namespace {

#if RTC_VERSION_MAJOR >= 4
template <typename Arguments>
Arguments query_arguments(bool coherent) {
  Arguments arguments;
  if constexpr (std::is_same_v<Arguments, RTCIntersectArguments>)
    rtcInitIntersectArguments(&arguments);
  else
    rtcInitOccludedArguments(&arguments);
  arguments.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  return arguments;
}
#else
RTCIntersectContext query_context(bool coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}
#endif

/// Embree's own masks: all bits set is "on".
using Mask8 = std::array<int, kPacket>;
Mask8 embree_mask(PacketMask active) {
  Mask8 mask{};
  for (int i = 0; i < kPacket; ++i) mask[std::size_t(i)] = active >> i & 1U ? -1 : 0;
  return mask;
}

void set_rays(RTCRay8& out, const RayPacket& rays) {
  for (std::size_t i = 0; i < kPacket; ++i) {
    const Ray& ray = rays[i];
    out.org_x[i] = float(ray.origin.x);
    out.org_y[i] = float(ray.origin.y);
    out.org_z[i] = float(ray.origin.z);
    out.dir_x[i] = float(ray.direction.x);
    out.dir_y[i] = float(ray.direction.y);
    out.dir_z[i] = float(ray.direction.z);
    out.tfar[i] = float(ray.t_max);
    out.tnear[i] = 0;
    out.time[i] = 0;
    out.mask[i] = ~0U;
    out.flags[i] = 0;
  }
}

}  // namespace

std::optional<Intersection> Accel::Impl::found(unsigned geometry, unsigned instance, Intersection hit) const {
  if (geometry == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  if (instance != RTC_INVALID_GEOMETRY_ID) {
    hit.instance = instance - first_instance_id;
    hit.shape = geometry + group_base[instance_group[hit.instance]];
  } else {
    hit.shape = geometry + world_base;
  }
  if (is_quad[hit.shape]) {
    if (hit.primitive == 1) hit.u = 1 - hit.u, hit.v = 1 - hit.v;
    hit.primitive = 0;
  }
  return hit;
}

std::optional<Intersection> Accel::intersect(const Ray& ray) const {
  RTCRayHit query{};
  query.ray = embree_ray(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(impl_->world, &query);
#else
  RTCIntersectContext context = query_context(false);
  rtcIntersect1(impl_->world, &context, &query);
#endif
  return impl_->found(
      query.hit.geomID, query.hit.instID[0],
      {.t = query.ray.tfar, .u = query.hit.u, .v = query.hit.v, .primitive = query.hit.primID});
}

bool Accel::occluded(const Ray& ray) const {
  RTCRay r = embree_ray(ray);
#if RTC_VERSION_MAJOR >= 4
  rtcOccluded1(impl_->world, &r);
#else
  RTCIntersectContext context = query_context(false);
  rtcOccluded1(impl_->world, &context, &r);
#endif
  return r.tfar < 0;  // Embree's sign of a hit: -inf
}

void Accel::intersect(const RayPacket& rays, PacketMask active, bool coherent, HitPacket& hits) const {
  RTCRayHit8 query;
  set_rays(query.ray, rays);
  std::fill(std::begin(query.hit.geomID), std::end(query.hit.geomID), RTC_INVALID_GEOMETRY_ID);
  std::fill(std::begin(query.hit.instID[0]), std::end(query.hit.instID[0]), RTC_INVALID_GEOMETRY_ID);
  alignas(32) const Mask8 mask = embree_mask(active);
#if RTC_VERSION_MAJOR >= 4
  auto arguments = query_arguments<RTCIntersectArguments>(coherent);
  rtcIntersect8(mask.data(), impl_->world, &query, &arguments);
#else
  RTCIntersectContext context = query_context(coherent);
  rtcIntersect8(mask.data(), impl_->world, &context, &query);
#endif
  for (PacketMask left = active; left != 0; left &= left - 1) {
    const auto i = std::size_t(std::countr_zero(left));
    hits[i] = impl_->found(
        query.hit.geomID[i], query.hit.instID[0][i],
        {.t = query.ray.tfar[i], .u = query.hit.u[i], .v = query.hit.v[i], .primitive = query.hit.primID[i]});
  }
}

PacketMask Accel::occluded(const RayPacket& rays, PacketMask active, bool coherent) const {
  RTCRay8 query;
  set_rays(query, rays);
  alignas(32) const Mask8 mask = embree_mask(active);
#if RTC_VERSION_MAJOR >= 4
  auto arguments = query_arguments<RTCOccludedArguments>(coherent);
  rtcOccluded8(mask.data(), impl_->world, &query, &arguments);
#else
  RTCIntersectContext context = query_context(coherent);
  rtcOccluded8(mask.data(), impl_->world, &context, &query);
#endif
  PacketMask blocked = 0;
  for (std::size_t i = 0; i < kPacket; ++i) {
    if (query.tfar[i] < 0) blocked |= PacketMask(1) << i;
  }
  return blocked & active;
}

}  // namespace spectrace

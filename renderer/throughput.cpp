// SPDX-License-Identifier: Apache-2.0
#include "renderer/throughput.h"

#include <algorithm>
#include <bit>
#include <variant>
#include <vector>

#include "core/base/cost.h"
#include "core/math/sampler.h"
#include "renderer/flush_denormals.h"
#include "renderer/kernels.h"
#include "renderer/render.h"

namespace spectrace {

namespace {

/// Ample for a rate to a percent, and 500 MB of packets at the most.
constexpr std::size_t kLoggedPackets = std::size_t(1) << 20;
constexpr int kLogTile = 8;  // pixels
constexpr std::uint64_t kLogSamples = 16;

struct Logged {
  TraceLog packets;
  std::uint64_t rays = 0, paths = 0;
};

/// Tiles spread over the picture until there are enough packets.
Logged log_rays(const Scene& scene, const Kernel& kernel, const AovSet& aovs, std::uint64_t samples) {
  const CropWindow window = scene.film.window();
  const RenderJob job{.scene = scene,
                      .seed = 0,
                      .albedos = nullptr,
                      .kept_slots = film_layout(scene, aovs).kept_slots(),
                      .layout = film_layout(scene, aovs)};
  TileSums sums;
  std::vector<Tile> tiles;
  for (int y = 0; y < window.height; y += kLogTile) {
    for (int x = 0; x < window.width; x += kLogTile) {
      tiles.push_back({x, y, std::min(x + kLogTile, window.width), std::min(y + kLogTile, window.height)});
    }
  }
  Logged logged;
  // Steps of a golden share of the tiles reach all of them in an order that is spread at every length.
  const auto step = std::size_t(double(tiles.size()) * 0.618033988749895) | 1U;
  for (std::size_t i = 0; i < tiles.size() && logged.packets.size() < kLoggedPackets; ++i) {
    const Tile& tile = tiles[i * step % tiles.size()];
    logged.rays += kernel.render_tile(job, {0, samples}, tile, sums, &logged.packets).rays;
    logged.paths += std::uint64_t(tile.x1 - tile.x0) * std::uint64_t(tile.y1 - tile.y0) * samples;
  }
  return logged;
}

/// Something that depends on all hits, so that no compiler leaves them out.
std::uint64_t trace_packets(const Accel& accel, const TraceLog& packets) {
  std::uint64_t hit_count = 0;
  HitPacket hits;
  for (const TracedPacket& packet : packets) {
    if (packet.is_shadow) {
      hit_count += std::uint64_t(std::popcount(accel.occluded(packet.rays, packet.active, packet.coherent)));
      continue;
    }
    accel.intersect(packet.rays, packet.active, packet.coherent, hits);
    for (PacketMask left = packet.active; left != 0; left &= left - 1) {
      hit_count += hits[std::size_t(std::countr_zero(left))] ? 1U : 0U;
    }
  }
  return hit_count;
}

std::uint64_t trace_singly(const Accel& accel, const TraceLog& packets) {
  std::uint64_t hit_count = 0;
  for (const TracedPacket& packet : packets) {
    for (PacketMask left = packet.active; left != 0; left &= left - 1) {
      const Ray& ray = packet.rays[std::size_t(std::countr_zero(left))];
      hit_count += packet.is_shadow ? accel.occluded(ray) : accel.intersect(ray).has_value();
    }
  }
  return hit_count;
}

/// Random numbers and wavelengths of as many paths, with as many vertices, as were logged.
double draw_numbers(const Scene& scene, const Logged& logged) {
  std::uint64_t vertices = 0;
  for (const TracedPacket& packet : logged.packets) {
    if (!packet.is_shadow) vertices += std::uint64_t(std::popcount(packet.active));
  }
  const std::uint64_t each = vertices / std::max<std::uint64_t>(1, logged.paths);
  double sum = 0;
  for (std::uint64_t path = 0; path < logged.paths; ++path) {
    const Sampler sampler(path / kLogSamples, path % kLogSamples, 0);
    sum += double(scene.wavelengths.sample(sampler.path().wavelength).lambda_nm(kLanes - 1));
    for (std::uint32_t vertex = 0; vertex < each; ++vertex) sum += double(sampler.vertex(vertex).bsdf.x);
  }
  return sum;
}

std::uint64_t triangles_of(const Scene& scene) {
  std::uint64_t count = 0;
  for (const Shape& shape : scene.geometry.shapes) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) count += mesh->triangles.size();
  }
  return count;
}

}  // namespace

double Throughput::raw_rays_per_second() const {
  return std::max(double(rays) / traversal, single_rays_per_second);
}

Throughput measure_throughput(const Scene& scene, const ThroughputOptions& options, Progress& progress) {
  RenderOptions render_options{.spp = options.spp, .threads = 1, .aovs = options.aovs};
  RenderSession session(scene, render_options);
  session.finish(progress);
  const RenderReport one = session.report();
  render_options.threads = options.threads;
  const RenderReport many = render(scene, render_options, progress).report;
  Throughput result{.kernel = one.kernel,
                    .paths = one.paths,
                    .rays = one.rays,
                    .triangles = triangles_of(scene),
                    .seconds = one.seconds,
                    .threads = many.threads,
                    .seconds_of_threads = many.seconds,
                    .peak_memory_bytes = peak_memory_bytes()};  // the log of rays is not a render's

  const FlushDenormals flush;
  const Kernel& kernel = choose_kernel(required_features(scene, options.aovs));
  const std::uint64_t log_samples = std::bit_floor(std::min(kLogSamples, std::uint64_t(options.spp)));
  const Logged logged = log_rays(scene, kernel, options.aovs, log_samples);
  volatile double sink = 0;  // what is computed must be computed
  const auto seconds = [&](const auto& work) { return seconds_of([&] { sink = double(work()); }); };
  const double packets = seconds([&] { return trace_packets(scene.accel, logged.packets); });
  const double singles = seconds([&] { return trace_singly(scene.accel, logged.packets); });
  const double numbers = seconds([&] { return draw_numbers(scene, logged); });
  const auto of_all = [](double time, std::uint64_t part, std::uint64_t all) {
    return part > 0 ? time * double(all) / double(part) : 0;
  };
  result.traversal = of_all(packets, logged.rays, result.rays);
  result.sampling = of_all(numbers, logged.paths, result.paths);
  result.single_rays_per_second = singles > 0 ? double(logged.rays) / singles : 0;
  result.film = seconds([&] { return session.film().resolve().data.size(); });
  return result;
}

}  // namespace spectrace

// SPDX-License-Identifier: Apache-2.0
#include "cli/compare/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cli/noise_note.h"
#include "core/base/error.h"

namespace spectrace::cli {

namespace {

/// One line a channel that has any; true where none has.
bool find_non_finite(const NamedImage& named, std::vector<std::string>& lines) {
  const Image& image = named.image;
  const std::size_t channels = image.channels.size();
  std::vector<std::size_t> counts(channels, 0), firsts(channels, 0);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    if (std::isfinite(image.data[i])) continue;
    if (counts[i % channels]++ == 0) firsts[i % channels] = i / channels;
  }
  const std::size_t width = static_cast<std::size_t>(image.width);
  bool is_finite = true;
  for (std::size_t c = 0; c < channels; ++c) {
    if (counts[c] == 0) continue;
    is_finite = false;
    lines.push_back(fmt::format("{}: channel {}: {} NaN or infinite values, the first at x = {}, y = {}",
                                named.file, image.channels[c], counts[c], firsts[c] % width,
                                firsts[c] / width));
  }
  return is_finite;
}

const ChannelGroup& require_group(const NamedImage& named, const std::string& layer) {
  if (const ChannelGroup* group = find_group(named.groups, layer)) return *group;
  std::vector<std::string> names;
  for (const ChannelGroup& group : named.groups) names.push_back(group.name);
  throw InputError(named.file, "",
                   fmt::format("has no layer \"{}\", only {}", layer, fmt::join(names, ", ")));
}

/// Layers that --layer, --max, --min or a file of limits name, each once.
std::vector<std::string> named_layers(const CompareSettings& settings) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const std::string& name : settings.layers) add(name);
  for (const Limit& limit : settings.limits) {
    if (!limit.layer.empty() && limit.layer != kEveryLayer) add(limit.layer);
  }
  return names;
}

/// Programs write wavelengths with more or fewer digits.
bool same_channels(const ChannelGroup& a, const ChannelGroup& b) {
  return a.kind == GroupKind::kSpectrum ? a.lambda_nm == b.lambda_nm : a.channels == b.channels;
}

void add_layer(const NamedImage& reference, const NamedImage& test, const std::string& name,
               Comparison& result) {
  const ChannelGroup &r = require_group(reference, name), &t = require_group(test, name);
  if (!same_channels(r, t)) {
    throw InputError(test.file, "",
                     fmt::format("layer \"{}\" has the channels {}, but in {} {}", name,
                                 fmt::join(t.channels, ", "), reference.file, fmt::join(r.channels, ", ")));
  }
  result.layers.push_back({.reference = r, .test = t, .is_named = true, .metrics = {}, .z_test = {}});
}

/// Colours and spectra that both have and nobody named; statistics only where they are named.
void add_common_layers(const NamedImage& reference, const NamedImage& test, Comparison& result) {
  const auto is_shown = [](const ChannelGroup& group, const NamedImage& image) {
    return group.kind != GroupKind::kNumbers && !is_statistic(group, image.groups);
  };
  const auto is_there = [&](const std::string& name) {
    return std::any_of(result.layers.begin(), result.layers.end(),
                       [&](const LayerResult& layer) { return layer.name() == name; });
  };
  for (const ChannelGroup& group : reference.groups) {
    if (!is_shown(group, reference) || is_there(group.name)) continue;
    const ChannelGroup* other = find_group(test.groups, group.name);
    if (other == nullptr) {
      result.not_compared.push_back(fmt::format("{} (only in {})", group.name, reference.file));
    } else if (!same_channels(group, *other)) {
      result.not_compared.push_back(fmt::format("{} (of different channels)", group.name));
    } else {
      result.layers.push_back(
          {.reference = group, .test = *other, .is_named = false, .metrics = {}, .z_test = {}});
    }
  }
  for (const ChannelGroup& group : test.groups) {
    if (is_shown(group, test) && find_group(reference.groups, group.name) == nullptr) {
      result.not_compared.push_back(fmt::format("{} (only in {})", group.name, test.file));
    }
  }
}

void choose_layers(const NamedImage& reference, const NamedImage& test, const CompareSettings& settings,
                   Comparison& result) {
  for (const std::string& name : named_layers(settings)) add_layer(reference, test, name, result);
  if (!settings.layers.empty()) return;
  add_common_layers(reference, test, result);
  // In the order of the image, whoever named them.
  std::stable_sort(result.layers.begin(), result.layers.end(),
                   [](const LayerResult& a, const LayerResult& b) {
                     return a.reference.indices.front() < b.reference.indices.front();
                   });
  if (result.layers.empty()) {
    throw InputError(test.file, "",
                     fmt::format("has no RGB or spectral layer in common with {}", reference.file));
  }
  const bool limits_beauty = std::any_of(settings.limits.begin(), settings.limits.end(),
                                         [](const Limit& limit) { return limit.layer.empty(); });
  const auto beauty = std::find_if(result.layers.begin(), result.layers.end(),
                                   [](const LayerResult& layer) { return layer.name() == "beauty"; });
  if (beauty != result.layers.end()) {
    beauty->is_named = true;
  } else if (limits_beauty) {
    throw InputError(test.file, "",
                     "the limits are for the beauty, which one image lacks; name another by --layer");
  }
}

std::optional<double> samples_of(const NamedImage& named) {
  const auto found = named.metadata.find("spectrace:spp");
  if (found == named.metadata.end()) return std::nullopt;
  const auto* spp = std::get_if<std::int64_t>(&found->second);
  return spp != nullptr && *spp > 0 ? std::optional(double(*spp)) : std::nullopt;
}

/// The variance of a layer's mean, or null.
const ChannelGroup* variance_group(const NamedImage& named, const ChannelGroup& layer) {
  const ChannelGroup* group = find_group(named.groups, variance_of(layer.name));
  return group != nullptr && group->channels.size() == layer.channels.size() ? group : nullptr;
}

Image variance_image(const NamedImage& named, const ChannelGroup& group) {
  Image variance = group_image(named.image, group);
  const auto negative =
      std::find_if(variance.data.begin(), variance.data.end(), [](float x) { return x < 0; });
  if (negative != variance.data.end()) {
    throw InputError(named.file, "", fmt::format("layer \"{}\": {} is no variance", group.name, *negative));
  }
  return variance;
}

/// Of the test image: its own; else, by the samples each says it has, the reference's scaled; else none.
std::pair<Image, std::string> test_noise(const NamedImage& reference, const NamedImage& test,
                                         const LayerResult& layer, const Image& reference_variance) {
  if (const ChannelGroup* own = variance_group(test, layer.test)) {
    return {variance_image(test, *own), "its own variance"};
  }
  const auto of_reference = samples_of(reference), of_test = samples_of(test);
  if (!of_reference || !of_test) return {Image(), "taken as without noise"};
  Image scaled = reference_variance;
  const double factor = *of_reference / *of_test;
  for (float& x : scaled.data) x = static_cast<float>(double(x) * factor);
  return {std::move(scaled),
          fmt::format("the reference's variance times {} / {} samples", *of_reference, *of_test)};
}

void run_z_tests(const NamedImage& reference, const NamedImage& test, const CompareSettings& settings,
                 Comparison& result) {
  std::vector<LayerResult*> layers;
  std::size_t tests = 0;
  for (LayerResult& layer : result.layers) {
    // Named layers must have a variance; of the others those that do are tested.
    if (variance_group(reference, layer.reference) == nullptr) {
      if (!settings.layers.empty()) require_group(reference, variance_of(layer.name()));
      continue;
    }
    layers.push_back(&layer);
    tests += layer.reference.channels.size() * std::size_t(result.width) * std::size_t(result.height);
  }
  if (layers.empty()) require_group(reference, variance_of(result.layers.front().name()));
  for (LayerResult* layer : layers) {
    const Image variance = variance_image(reference, *variance_group(reference, layer->reference));
    auto [noise, source] = test_noise(reference, test, *layer, variance);
    layer->z_test =
        LayerZTest{.result = z_test(group_image(reference.image, layer->reference), variance,
                                    group_image(test.image, layer->test), noise, tests, *settings.z_test),
                   .noise = std::move(source),
                   .test_has_variance = variance_group(test, layer->test) != nullptr};
  }
}

bool is_for(const Limit& limit, const std::string& layer, const CompareSettings& settings) {
  if (!limit.layer.empty()) return limit.layer == layer || limit.layer == kEveryLayer;
  if (settings.layers.empty()) return layer == "beauty";
  return std::find(settings.layers.begin(), settings.layers.end(), layer) != settings.layers.end();
}

}  // namespace

bool Comparison::passes() const {
  return non_finite.empty() &&
         std::all_of(limits.begin(), limits.end(), [](const LimitResult& l) { return l.holds; }) &&
         std::all_of(layers.begin(), layers.end(),
                     [](const LayerResult& l) { return !l.z_test || l.z_test->result.passes; });
}

NamedImage load_image(const std::string& file) {
  NamedImage named{.file = file, .image = read_image(file), .metadata = read_metadata(file), .groups = {}};
  named.groups = channel_groups(named.image, file);
  return named;
}

Comparison compare_two(const NamedImage& reference, const NamedImage& test, const CompareSettings& settings) {
  const Image &r = reference.image, &t = test.image;
  if (r.width != t.width || r.height != t.height) {
    throw InputError(test.file, "",
                     fmt::format("{} x {} pixels, but {} has {} x {}", t.width, t.height, reference.file,
                                 r.width, r.height));
  }
  Comparison result;
  result.reference = reference.file;
  result.test = test.file;
  result.width = r.width;
  result.height = r.height;
  result.note = noise_note(reference.metadata, test.metadata);
  find_non_finite(reference, result.non_finite);
  result.test_is_finite = find_non_finite(test, result.non_finite);
  choose_layers(reference, test, settings, result);
  for (LayerResult& layer : result.layers) {
    layer.metrics = compare_channels(r, layer.reference.indices, t, layer.test.indices, settings.options);
  }
  if (settings.z_test) run_z_tests(reference, test, settings, result);
  for (const LayerResult& layer : result.layers) {
    for (const Limit& limit : settings.limits) {
      if (!is_for(limit, layer.name(), settings)) continue;
      const double found = layer.metrics.together.*limit.metric->field;
      result.limits.push_back({layer.name(), limit, found, limit.holds(found)});
    }
  }
  return result;
}

}  // namespace spectrace::cli

// SPDX-License-Identifier: Apache-2.0
// `spectrace compare REF TEST...`
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "cli/command.h"
#include "cli/noise_note.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/nearest.h"
#include "core/image/image.h"
#include "core/image/metrics.h"

namespace spectrace::cli {

namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spectrace compare reference.exr test.exr\n"
    "  spectrace compare reference.exr test.exr --max relmse=1e-3 --min ssim=0.99\n"
    "  spectrace compare raw.exr separated.exr --layer specular --min psnr=40 --json figures.json\n"
    "  spectrace compare raw.exr sun.exr fresnel.exr diffraction.exr\n"
    "\n"
    "Compares the RGB layers that both images have: beauty (R, G, B), diffuse, specular, ... in linear "
    "values\n"
    "without tone mapping. Limits hold for the layers named by --layer, without --layer for the beauty.\n"
    "Metrics: mse, mae, relmse, mape (a fraction), psnr (dB), ssim, maxabs.\n"
    "Exit codes: 0 within all limits; 1 beyond one, or any value of any channel is NaN or infinite; 2 "
    "usage;\n"
    "3 unreadable images, or of different sizes.";

struct MetricName {
  std::string name;
  double Metrics::*field;
};
const std::array<MetricName, 7>& metric_names() {
  static const std::array<MetricName, 7> names = {{{"psnr", &Metrics::psnr_db},
                                                   {"ssim", &Metrics::ssim},
                                                   {"mape", &Metrics::mape},
                                                   {"relmse", &Metrics::rel_mse},
                                                   {"mse", &Metrics::mse},
                                                   {"mae", &Metrics::mae},
                                                   {"maxabs", &Metrics::max_abs}}};
  return names;
}

struct Limit {
  const MetricName* metric = nullptr;
  bool is_max = true;
  double value = 0;

  /// A metric that could not be computed (NaN) is within no limit.
  [[nodiscard]] bool holds(double x) const { return is_max ? x <= value : x >= value; }
  [[nodiscard]] std::string text() const {
    return fmt::format("{} {} {}", metric->name, is_max ? "<=" : ">=", value);
  }
};

struct Arguments {
  std::string reference, json;
  std::vector<std::string> tests;
  std::vector<std::string> layers, max_texts, min_texts;
  std::vector<Limit> limits;
  MetricOptions options;
};

/// "relmse=1e-3"; anything else is a usage error.
Limit parse_limit(const std::string& text, bool is_max) {
  const auto wrong = [&](const std::string& problem) {
    return CLI::ValidationError(is_max ? "--max" : "--min", fmt::format("\"{}\": {}", text, problem));
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw wrong("expected METRIC=VALUE");
  const std::string name = text.substr(0, equals);
  const auto& metrics = metric_names();
  const auto metric =
      std::find_if(metrics.begin(), metrics.end(), [&](const MetricName& m) { return m.name == name; });
  if (metric == metrics.end()) {
    std::vector<std::string> known;
    for (const MetricName& m : metrics) known.push_back(m.name);
    const std::string hint = suggestion(name, known);
    throw wrong(fmt::format("no metric \"{}\"{}", name,
                            hint.empty() ? fmt::format("; there are {}", fmt::join(known, ", ")) : hint));
  }
  Limit limit{.metric = &*metric, .is_max = is_max};
  const char *begin = text.data() + equals + 1, *end = text.data() + text.size();
  const std::from_chars_result parsed = std::from_chars(begin, end, limit.value);
  if (parsed.ec != std::errc() || parsed.ptr != end || !std::isfinite(limit.value)) {
    throw wrong("the value is not a finite number");
  }
  return limit;
}

struct LayerResult {
  std::string name;  ///< as printed: "beauty" for R, G, B
  bool is_limited = false;
  Metrics metrics;
};

struct LimitResult {
  std::string layer;
  Limit limit;
  double found = 0;
  bool holds = false;
};

struct Comparison {
  std::string test;
  int width = 0, height = 0;
  std::vector<std::string> non_finite;  ///< one line a channel that has such values, of all channels
  std::vector<std::string> not_compared;
  std::string note;  ///< on what the figures hold besides the difference in question
  std::vector<LayerResult> layers;
  std::vector<LimitResult> limits;

  [[nodiscard]] bool passes() const {
    return non_finite.empty() &&
           std::all_of(limits.begin(), limits.end(), [](const LimitResult& l) { return l.holds; });
  }
};

std::string layer_name(const std::string& layer) { return layer.empty() ? "beauty" : layer; }

void find_non_finite(const Image& image, const std::string& file, std::vector<std::string>& lines) {
  const std::size_t channels = image.channels.size();
  for (std::size_t c = 0; c < channels; ++c) {
    std::size_t count = 0, first = 0;
    for (std::size_t i = c; i < image.data.size(); i += channels) {
      if (std::isfinite(image.data[i])) continue;
      if (count++ == 0) first = i / channels;
    }
    if (count == 0) continue;
    const std::size_t width = static_cast<std::size_t>(image.width);
    lines.push_back(fmt::format("{}: channel {}: {} NaN or infinite values, the first at x = {}, y = {}",
                                file, image.channels[c], count, first % width, first / width));
  }
}

/// The layers to show; those that limits hold for first checked to be there.
std::vector<std::string> common_layers(const Arguments& arguments, const Image& reference, const Image& test,
                                       Comparison& result) {
  const std::vector<std::string> in_reference = reference.rgb_layers(), in_test = test.rgb_layers();
  const auto has = [](const std::vector<std::string>& all, const std::string& name) {
    return std::find(all.begin(), all.end(), name) != all.end();
  };
  std::vector<std::string> layers;
  if (!arguments.layers.empty()) {
    for (const std::string& name : arguments.layers) {
      const std::string layer = name == "beauty" ? "" : name;
      // select() names the file and the channel that is missing.
      static_cast<void>(reference.select(rgb_channels(layer), arguments.reference));
      static_cast<void>(test.select(rgb_channels(layer), result.test));
      if (!has(layers, layer)) layers.push_back(layer);
    }
    return layers;
  }
  for (const std::string& layer : in_reference) {
    if (has(in_test, layer)) {
      layers.push_back(layer);
    } else {
      result.not_compared.push_back(fmt::format("{} (only in {})", layer_name(layer), arguments.reference));
    }
  }
  for (const std::string& layer : in_test) {
    if (!has(in_reference, layer)) {
      result.not_compared.push_back(fmt::format("{} (only in {})", layer_name(layer), result.test));
    }
  }
  if (layers.empty()) {
    throw InputError(result.test, "", fmt::format("has no RGB layer in common with {}", arguments.reference));
  }
  if (!arguments.limits.empty() && layers.front() != "") {
    throw InputError(result.test, "",
                     "the limits are for the beauty, which one image lacks; name another by --layer");
  }
  return layers;
}

Comparison compare(const Arguments& arguments, const Image& reference, const std::string& test_file) {
  const Image test = read_image(test_file);
  if (reference.width != test.width || reference.height != test.height) {
    throw InputError(test_file, "",
                     fmt::format("{} x {} pixels, but {} has {} x {}", test.width, test.height,
                                 arguments.reference, reference.width, reference.height));
  }
  Comparison result;
  result.test = test_file;
  result.width = reference.width;
  result.height = reference.height;
  result.note = noise_note(arguments.reference, test_file);
  find_non_finite(reference, arguments.reference, result.non_finite);
  find_non_finite(test, test_file, result.non_finite);
  for (const std::string& layer : common_layers(arguments, reference, test, result)) {
    const auto names = rgb_channels(layer);
    const Metrics metrics = compare_images(reference.select(names, arguments.reference),
                                           test.select(names, test_file), arguments.options);
    result.layers.push_back({layer_name(layer), !arguments.layers.empty() || layer.empty(), metrics});
  }
  for (const LayerResult& layer : result.layers) {
    if (!layer.is_limited) continue;
    for (const Limit& limit : arguments.limits) {
      const double found = layer.metrics.*limit.metric->field;
      result.limits.push_back({layer.name, limit, found, limit.holds(found)});
    }
  }
  return result;
}

void print_header(std::string_view first_column) {
  fmt::print("{:<22}{:>10}{:>10}{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}\n", first_column, "PSNR [dB]", "SSIM",
             "MAPE", "relMSE", "MSE", "MAE", "max abs", "data range");
}

void print_row(const std::string& name, const Metrics& m) {
  fmt::print("{:<22}{:>10.3f}{:>10.6f}{:>12.4e}{:>12.4e}{:>12.4e}{:>12.4e}{:>12.4e}{:>12.5g}\n", name,
             m.psnr_db, m.ssim, m.mape, m.rel_mse, m.mse, m.mae, m.max_abs, m.data_range);
}

/// One test: a row a layer. Several: of each test the layers that limits hold for.
void print_tables(const std::vector<Comparison>& results, const Arguments& arguments) {
  const Comparison& first = results.front();
  fmt::print("reference {}\n", arguments.reference);
  if (results.size() == 1) fmt::print("test      {}\n", first.test);
  fmt::print("{} x {} pixels, linear values, no tone mapping\n\n", first.width, first.height);
  if (results.size() == 1) {
    print_header("layer");
    for (const LayerResult& layer : first.layers) print_row(layer.name, layer.metrics);
    return;
  }
  print_header("test");
  for (const Comparison& result : results) {
    const std::string file = std::filesystem::path(result.test).filename().string();
    for (const LayerResult& layer : result.layers) {
      if (layer.is_limited) print_row(layer.name == "beauty" ? file : file + " " + layer.name, layer.metrics);
    }
  }
}

void print_comparisons(const std::vector<Comparison>& results, const Arguments& arguments) {
  print_tables(results, arguments);
  const MetricOptions& o = arguments.options;
  fmt::print(
      "\ndata range: {}; PSNR's peak and SSIM's L\n"
      "SSIM: {} x {} Gaussian window, sigma 1.5, K1 0.01, K2 0.03, mean of the channels, border left out\n"
      "relMSE: (t-r)^2 / (r^2 + {}); MAPE: |t-r| / (|r| + {}), a fraction; means over pixels and channels\n",
      o.data_range > 0 ? fmt::format("{}", o.data_range) : "the reference's maximum in each layer",
      kSsimWindow, kSsimWindow, o.epsilon, o.mape_floor);
  for (const Comparison& result : results) {
    const std::string prefix = results.size() == 1 ? "" : result.test + ": ";
    if (!result.note.empty()) fmt::print("{}note: {}\n", prefix, result.note);
    if (!result.not_compared.empty()) {
      fmt::print("{}not compared: {}\n", prefix, fmt::join(result.not_compared, ", "));
    }
    for (const LimitResult& l : result.limits) {
      fmt::print("{}{}: {} {}: found {:.6g}\n", prefix, l.holds ? "pass" : "FAIL", l.layer, l.limit.text(),
                 l.found);
    }
    for (const std::string& line : result.non_finite) fmt::print("FAIL: {}\n", line);
  }
}

void write_json(JsonWriter& json, const Comparison& result, const Arguments& arguments) {
  json.begin_object();
  json.member("reference", arguments.reference);
  json.member("test", result.test);
  json.member("width", result.width);
  json.member("height", result.height);
  json.member("passes", result.passes());
  json.member("note", result.note);
  json.key("non_finite");
  json.begin_array();
  for (const std::string& line : result.non_finite) json.value(line);
  json.end_array();
  json.member("epsilon", arguments.options.epsilon);
  json.member("mape_floor", arguments.options.mape_floor);
  json.member("ssim_window", kSsimWindow);
  json.key("layers");
  json.begin_array();
  for (const LayerResult& layer : result.layers) {
    json.begin_object();
    json.member("layer", layer.name);
    json.member("finite", layer.metrics.finite);
    json.member("data_range", layer.metrics.data_range);
    for (const MetricName& metric : metric_names()) json.member(metric.name, layer.metrics.*metric.field);
    json.end_object();
  }
  json.end_array();
  json.key("limits");
  json.begin_array();
  for (const LimitResult& l : result.limits) {
    json.begin_object();
    json.member("layer", l.layer);
    json.member("metric", l.limit.metric->name);
    json.member("kind", l.limit.is_max ? "max" : "min");
    json.member("limit", l.limit.value);
    json.member("found", l.found);
    json.member("holds", l.holds);
    json.end_object();
  }
  json.end_array();
  json.end_object();
}

/// One test: its object. Several: an array of them.
std::string json_text(const std::vector<Comparison>& results, const Arguments& arguments) {
  JsonWriter json;
  if (results.size() > 1) json.begin_array();
  for (const Comparison& result : results) write_json(json, result, arguments);
  if (results.size() > 1) json.end_array();
  return json.text();
}

ExitCode compare_command(const Arguments& arguments) {
  const Image reference = read_image(arguments.reference);
  std::vector<Comparison> results;
  for (const std::string& test : arguments.tests) results.push_back(compare(arguments, reference, test));
  print_comparisons(results, arguments);
  if (!arguments.json.empty()) write_file_atomically(arguments.json, json_text(results, arguments));
  const bool passes =
      std::all_of(results.begin(), results.end(), [](const Comparison& c) { return c.passes(); });
  return passes ? ExitCode::kSuccess : ExitCode::kDiffers;
}

}  // namespace

void add_compare(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("compare", "Measure how far images are from a reference: PSNR, SSIM, MAPE, relMSE");
  command->footer(kExamples);
  const auto arguments = std::make_shared<Arguments>();
  MetricOptions& options = arguments->options;
  command->add_option("reference", arguments->reference, "reference image")->required();
  command->add_option("test", arguments->tests, "images to judge, one or more")->required();
  command->add_option("--max", arguments->max_texts, "METRIC=VALUE: fail above the value; repeatable")
      ->allow_extra_args(false);
  command->add_option("--min", arguments->min_texts, "METRIC=VALUE: fail below the value; repeatable")
      ->allow_extra_args(false);
  command
      ->add_option("--layer", arguments->layers, "compare only this layer (beauty, diffuse, ...); repeatable")
      ->allow_extra_args(false);
  command->add_option("--json", arguments->json,
                      "also write the figures to this file; NaN and infinity become null");
  command
      ->add_option("--data-range", options.data_range,
                   "peak of PSNR and L of SSIM; 0 = the reference's maximum")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--epsilon", options.epsilon, "added to the squared reference in relMSE")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--mape-floor", options.mape_floor, "added to the reference in MAPE")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->callback([arguments, &chosen] {
    const MetricOptions& given = arguments->options;
    for (const double x : {given.data_range, given.epsilon, given.mape_floor}) {
      if (std::isnan(x))
        throw CLI::ValidationError("compare", "NaN is no value for an option");  // passes ranges
    }
    for (const std::string& text : arguments->max_texts) arguments->limits.push_back(parse_limit(text, true));
    for (const std::string& text : arguments->min_texts)
      arguments->limits.push_back(parse_limit(text, false));
    chosen = [arguments] { return compare_command(*arguments); };
  });
}

}  // namespace spectrace::cli

// SPDX-License-Identifier: Apache-2.0
#include "cli/compare/figures.h"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>

#include "core/base/json.h"

namespace spectrace::cli {

namespace {

void print_header(std::string_view first_column) {
  fmt::print("{:<22}{:>10}{:>10}{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}\n", first_column, "PSNR [dB]", "SSIM",
             "MAPE", "relMSE", "MSE", "MAE", "max abs", "data range");
}

void print_row(const std::string& name, const Metrics& m) {
  fmt::print("{:<22}{:>10.3f}{:>10.6f}{:>12.4e}{:>12.4e}{:>12.4e}{:>12.4e}{:>12.4e}{:>12.5g}\n", name,
             m.psnr_db, m.ssim, m.mape, m.rel_mse, m.mse, m.mae, m.max_abs, m.data_range);
}

void print_tables(std::span<const Comparison> results) {
  const Comparison& first = results.front();
  fmt::print("reference {}\n", first.reference);
  if (results.size() == 1) fmt::print("test      {}\n", first.test);
  fmt::print("{} x {} pixels, linear values, no tone mapping\n\n", first.width, first.height);
  if (results.size() == 1) {
    print_header("layer");
    for (const LayerResult& layer : first.layers) print_row(layer.name(), layer.metrics.together);
    return;
  }
  print_header("test");
  for (const Comparison& result : results) {
    const std::string file = std::filesystem::path(result.test).filename().string();
    for (const LayerResult& layer : result.layers) {
      if (!layer.is_named) continue;
      print_row(layer.name() == "beauty" ? file : file + " " + layer.name(), layer.metrics.together);
    }
  }
}

void write_metrics(JsonWriter& json, const Metrics& metrics) {
  json.member("finite", metrics.finite);
  json.member("data_range", metrics.data_range);
  for (const MetricName& metric : kMetricNames) json.member(metric.name, metrics.*metric.field);
}

void write_z_test(JsonWriter& json, const LayerZTest& z) {
  json.key("z_test");
  json.begin_object();
  json.member("holds", z.result.passes);
  json.member("accepted", z.result.accepted_share);
  json.member("threshold", z.result.threshold);
  json.member("largest_z", z.result.largest_z);
  json.member("x", z.result.x);
  json.member("y", z.result.y);
  json.key("mean_z");
  json.begin_array();
  for (const double x : z.result.mean_z) json.value(x);
  json.end_array();
  json.member("test_noise", z.noise);
  json.end_object();
}

void write_layer(JsonWriter& json, const LayerResult& layer) {
  json.begin_object();
  json.member("layer", layer.name());
  write_metrics(json, layer.metrics.together);
  if (layer.z_test) write_z_test(json, *layer.z_test);
  const bool is_spectrum = layer.reference.kind == GroupKind::kSpectrum;
  json.key(is_spectrum ? "bands" : "channels");
  json.begin_array();
  for (std::size_t c = 0; c < layer.metrics.each.size(); ++c) {
    json.begin_object();
    json.member("channel", layer.reference.channels[c]);
    if (is_spectrum) json.member("lambda_nm", layer.reference.lambda_nm[c]);
    write_metrics(json, layer.metrics.each[c]);
    json.end_object();
  }
  json.end_array();
  json.end_object();
}

void write_limit(JsonWriter& json, const LimitResult& l) {
  json.begin_object();
  json.member("layer", l.layer);
  json.member("metric", l.limit.metric->name);
  json.member("kind", l.limit.is_max ? "max" : "min");
  json.member("limit", l.limit.value);
  json.member("found", l.found);
  json.member("holds", l.holds);
  json.end_object();
}

void write_comparison(JsonWriter& json, const Comparison& result, const CompareSettings& settings) {
  json.begin_object();
  json.member("reference", result.reference);
  json.member("test", result.test);
  json.member("width", result.width);
  json.member("height", result.height);
  json.member("passes", result.passes());
  json.member("note", result.note);
  json.key("non_finite");
  json.begin_array();
  for (const std::string& line : result.non_finite) json.value(line);
  json.end_array();
  json.member("epsilon", settings.options.epsilon);
  json.member("mape_floor", settings.options.mape_floor);
  json.member("ssim_window", kSsimWindow);
  if (settings.z_test) {
    json.key("z_test");
    json.begin_object();
    json.member("alpha", settings.z_test->alpha);
    json.member("accepted", settings.z_test->accepted);
    json.member("mean_z", settings.z_test->mean_z);
    json.end_object();
  }
  json.key("layers");
  json.begin_array();
  for (const LayerResult& layer : result.layers) write_layer(json, layer);
  json.end_array();
  json.key("limits");
  json.begin_array();
  for (const LimitResult& l : result.limits) write_limit(json, l);
  json.end_array();
  json.end_object();
}

}  // namespace

std::vector<std::string> conventions(const CompareSettings& settings) {
  const MetricOptions& o = settings.options;
  std::vector<std::string> lines{
      fmt::format("data range: {}; PSNR's peak and SSIM's L",
                  o.data_range > 0 ? fmt::format("{}", o.data_range)
                                   : std::string("the reference's maximum in each layer")),
      fmt::format("SSIM: {} x {} Gaussian window, sigma 1.5, K1 0.01, K2 0.03, mean of the channels, border "
                  "left out",
                  kSsimWindow, kSsimWindow),
      fmt::format("relMSE: (t-r)^2 / (r^2 + {}); MAPE: |t-r| / (|r| + {}), a fraction; means over pixels and "
                  "channels",
                  o.epsilon, o.mape_floor)};
  if (settings.z_test) {
    lines.push_back(fmt::format(
        "z-test: two-sided in every channel of every pixel, alpha {} with Sidak's correction over all tests; "
        "{:g} % of the pixels must accept in all channels",
        settings.z_test->alpha, 100 * settings.z_test->accepted));
  }
  return lines;
}

std::string z_test_line(const LayerResult& layer, const ZTestOptions& options) {
  const ZTestResult& z = layer.z_test->result;
  std::string line = fmt::format(
      "{}: {} z-test: {:.4g} % of pixels accept (|z| <= {:.3f}), largest |z| {:.3f} at x = {}, y = {}; means "
      "off by",
      z.passes ? "pass" : "FAIL", layer.name(), 100 * z.accepted_share, z.threshold, z.largest_z, z.x, z.y);
  for (const double x : z.mean_z) line += fmt::format(" {:.2f}", x);
  line += " standard errors";
  if (options.mean_z > 0) line += fmt::format(" (limit {:g})", options.mean_z);
  return line + "; noise of the test image: " + layer.z_test->noise;
}

void print_comparisons(std::span<const Comparison> results, const CompareSettings& settings) {
  print_tables(results);
  fmt::print("\n");
  for (const std::string& line : conventions(settings)) fmt::print("{}\n", line);
  for (const Comparison& result : results) {
    const std::string prefix = results.size() == 1 ? std::string() : result.test + ": ";
    if (!result.note.empty()) fmt::print("{}note: {}\n", prefix, result.note);
    if (!result.not_compared.empty()) {
      fmt::print("{}not compared: {}\n", prefix, fmt::join(result.not_compared, ", "));
    }
    for (const LimitResult& l : result.limits) {
      fmt::print("{}{}: {} {}: found {:.6g}\n", prefix, l.holds ? "pass" : "FAIL", l.layer, l.limit.text(),
                 l.found);
    }
    for (const LayerResult& layer : result.layers) {
      if (layer.z_test) fmt::print("{}{}\n", prefix, z_test_line(layer, *settings.z_test));
    }
    for (const std::string& line : result.non_finite) fmt::print("FAIL: {}\n", line);
  }
}

std::string json_text(std::span<const Comparison> results, const CompareSettings& settings) {
  JsonWriter json;
  if (results.size() > 1) json.begin_array();
  for (const Comparison& result : results) write_comparison(json, result, settings);
  if (results.size() > 1) json.end_array();
  return json.text();
}

}  // namespace spectrace::cli

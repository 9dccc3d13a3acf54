// SPDX-License-Identifier: Apache-2.0
#include "cli/compare/limits.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/json.h"
#include "core/base/nearest.h"

namespace spectrace::cli {

namespace {

constexpr NumberRange kAlphas{.min = 0, .max = 1, .min_open = true, .max_open = true};

const MetricName* find_metric(std::string_view name) {
  const auto* const found = std::find_if(kMetricNames.begin(), kMetricNames.end(),
                                         [&](const MetricName& m) { return m.name == name; });
  return found == kMetricNames.end() ? nullptr : found;
}

/// {"relmse": 1e-3, ...}: the limits of one layer and direction.
void read_metrics(const JsonValue& json, const std::string& layer, bool is_max, std::vector<Limit>& limits) {
  // Of what is no object keys() tells, once.
  if (json.keys().empty()) return;
  for (const MetricName& metric : kMetricNames) {
    const JsonValue value = json.get(metric.name);
    if (value.exists()) {
      limits.push_back({.layer = layer, .metric = &metric, .is_max = is_max, .value = value.number(0)});
    }
  }
  json.reject_unknown_keys();
}

void read_layer(const JsonValue& json, const std::string& name, std::vector<Limit>& limits) {
  if (name.empty()) json.error("a layer without a name; R, G, B is \"beauty\"");
  const JsonValue max = json.get("max"), min = json.get("min");
  read_metrics(max, name, true, limits);
  read_metrics(min, name, false, limits);
  json.reject_unknown_keys();
  const auto is_empty = [](const JsonValue& side) {
    return !side.exists() || (side.is_object() && side.keys().empty());
  };
  if (json.is_object() && is_empty(max) && is_empty(min)) json.error("limits nothing: neither max nor min");
}

std::optional<double> optional_number(const JsonValue& json, NumberRange range) {
  if (!json.exists()) return std::nullopt;
  return json.number(range.max, range);
}

ZTestOptions read_z_test(const JsonValue& json) {
  ZTestOptions options;
  options.alpha = json.get("alpha").number(options.alpha, kAlphas);
  options.accepted = json.get("accepted").number(options.accepted, kUnitInterval);
  options.mean_z = json.get("mean_z").number(options.mean_z, kNonNegative);
  json.reject_unknown_keys();
  return options;
}

}  // namespace

std::string Limit::text() const { return fmt::format("{} {} {}", metric->name, is_max ? "<=" : ">=", value); }

Limit parse_limit(const std::string& text, bool is_max) {
  const auto wrong = [&](const std::string& problem) {
    return CLI::ValidationError(is_max ? "--max" : "--min", fmt::format("\"{}\": {}", text, problem));
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw wrong("expected METRIC=VALUE or LAYER.METRIC=VALUE");
  const std::size_t dot = text.rfind('.', equals);  // layers may have dots of their own
  const bool has_layer = dot != std::string::npos;
  const std::size_t name_begin = has_layer ? dot + 1 : 0;
  const std::string name = text.substr(name_begin, equals - name_begin);
  if (has_layer && dot == 0) throw wrong("no layer before the dot");
  const MetricName* metric = find_metric(name);
  if (metric == nullptr) {
    std::vector<std::string> known;
    for (const MetricName& m : kMetricNames) known.emplace_back(m.name);
    const std::string hint = suggestion(name, known);
    throw wrong(fmt::format("no metric \"{}\"{}", name,
                            hint.empty() ? fmt::format("; there are {}", fmt::join(known, ", ")) : hint));
  }
  Limit limit{.layer = has_layer ? text.substr(0, dot) : "", .metric = metric, .is_max = is_max};
  const char *begin = text.data() + equals + 1, *end = text.data() + text.size();
  const std::from_chars_result parsed = std::from_chars(begin, end, limit.value);
  if (parsed.ec != std::errc() || parsed.ptr != end || !std::isfinite(limit.value)) {
    throw wrong("the value is not a finite number");
  }
  return limit;
}

LimitsFile read_limits(const std::filesystem::path& file) {
  JsonDocument document = JsonDocument::load(file);
  const JsonValue root = document.root();
  LimitsFile result;
  if (const JsonValue layers = root.get("layers"); layers.exists()) {
    for (const std::string& name : layers.keys()) read_layer(layers.get(name), name, result.limits);
  }
  result.data_range = optional_number(root.get("data_range"), kNonNegative);
  result.epsilon = optional_number(root.get("epsilon"), kPositive);
  result.mape_floor = optional_number(root.get("mape_floor"), kPositive);
  if (const JsonValue z = root.get("z_test"); z.exists()) result.z_test = read_z_test(z);
  root.reject_unknown_keys();
  // A misunderstanding that would pass for ever.
  if (result.limits.empty() && !result.z_test && document.diagnostics().empty()) {
    root.error("limits nothing: neither layers nor z_test");
  }
  document.throw_if_wrong();
  return result;
}

}  // namespace spectrace::cli

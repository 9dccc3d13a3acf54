// SPDX-License-Identifier: Apache-2.0
// `spectrace compare REF TEST...`
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/compare/comparison.h"
#include "cli/compare/figures.h"
#include "cli/compare/limits.h"
#include "cli/compare/page.h"
#include "cli/compare/pictures.h"
#include "cli/option_values.h"
#include "cli/output.h"
#include "core/base/error.h"
#include "core/base/file.h"

namespace spectrace::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* kExamples =
    "Examples:\n"
    "  spectrace compare reference.exr test.exr\n"
    "  spectrace compare reference.exr test.exr --max relmse=1e-3 --min ssim=0.99\n"
    "  spectrace compare raw.exr separated.exr --max specular.relmse=1e-2 --max '*.mae=0.1'\n"
    "  spectrace compare raw.exr separated.exr --layer normal --max maxabs=1e-3 --json figures.json\n"
    "  spectrace compare reference.exr test.exr --z-test --maps maps --html report.html\n"
    "  spectrace compare reference.exr test.exr --limits limits.json --update\n"
    "\n"
    "Compares the RGB layers (beauty is R, G, B) and the spectra (S0, T) that both images have, in linear "
    "values\n"
    "without tone mapping; any other layer (normal, depth, diffuse_variance) where --layer or a limit names "
    "it.\n"
    "Limits without a layer hold for the layers named by --layer, without --layer for the beauty.\n"
    "Metrics: mse, mae, relmse, mape (a fraction), psnr (dB), ssim, maxabs.\n"
    "\n"
    "--z-test asks whether the images estimate the same picture, of every layer with a variance of the mean "
    "in\n"
    "the reference (LAYER_variance; of the beauty beauty_variance.R, ...). In every channel of every pixel\n"
    "  z = (test - reference) / sqrt(variance of both + (1e-6 x the value)^2)\n"
    "is held, two-sided, to a level at which all tests of the image together reject an equal one with\n"
    "probability alpha (Sidak); a pixel accepts where all its channels do. Without variance values may "
    "differ by\n"
    "round-off alone. The test image's variance is its own; else the reference's, scaled by both headers'\n"
    "spectrace:spp; else nought. docs/compare.md tells what the test can find and what it cannot.\n"
    "\n"
    "Exit codes: 0 within all limits, or updated; 1 beyond one, or any value of any channel of either image "
    "is\n"
    "NaN or infinite; 2 usage; 3 unreadable images, or of different sizes, or a layer that is not there.";

struct Arguments {
  std::string reference, json, limits, maps, html;
  std::vector<std::string> tests, max_texts, min_texts;
  CompareSettings settings;
  ZTestOptions z_test;
  bool wants_z_test = false, update = false;
};

/// What the file says where the command line does not.
void add_limits_file(const CLI::App& command, Arguments& arguments) {
  const LimitsFile file = read_limits(arguments.limits);
  CompareSettings& settings = arguments.settings;
  settings.limits.insert(settings.limits.end(), file.limits.begin(), file.limits.end());
  const auto take = [&](const char* option, const auto& from_file, auto& value) {
    if (from_file && command.count(option) == 0) value = *from_file;
  };
  take("--data-range", file.data_range, settings.options.data_range);
  take("--epsilon", file.epsilon, settings.options.epsilon);
  take("--mape-floor", file.mape_floor, settings.options.mape_floor);
  if (file.z_test) {
    arguments.wants_z_test = true;
    take("--z-alpha", std::optional(file.z_test->alpha), arguments.z_test.alpha);
    take("--z-accepted", std::optional(file.z_test->accepted), arguments.z_test.accepted);
    take("--z-mean", std::optional(file.z_test->mean_z), arguments.z_test.mean_z);
  }
}

/// The reference becomes the test image, byte for byte, unless that would be no reference.
bool update_reference(const Comparison& result) {
  if (!result.test_is_finite) {
    fmt::print("not updated: {} has values that are NaN or infinite\n", result.test);
    return false;
  }
  for (const LayerResult& layer : result.layers) {
    if (!layer.z_test || layer.z_test->test_has_variance) continue;
    throw InputError(result.test, "",
                     fmt::format("has no layer \"{}\": a reference without it allows no z-test; not updated",
                                 variance_of(layer.name())));
  }
  const std::vector<std::byte> now = read_file(result.test);
  if (now == read_file(result.reference)) {
    fmt::print("not updated: {} is {} already, byte for byte\n", result.reference, result.test);
    return true;
  }
  write_file_atomically(result.reference, now);
  fmt::print("updated: {} is now a copy of {} ({} bytes)\n", result.reference, result.test, now.size());
  return true;
}

std::string prefix_of(const Arguments& arguments, std::size_t test) {
  if (arguments.tests.size() == 1) return {};
  return fmt::format("{}-{}-", test + 1, fs::path(arguments.tests[test]).stem().string());
}

ExitCode compare_command(const Arguments& arguments) {
  for (const std::string& file : {arguments.json, arguments.html}) {
    if (!file.empty()) require_folder_of(file);
  }
  const CompareSettings& settings = arguments.settings;
  const NamedImage reference = load_image(arguments.reference);
  std::vector<Comparison> results;
  std::vector<std::string> sections;
  std::size_t maps = 0;
  for (std::size_t i = 0; i < arguments.tests.size(); ++i) {
    const NamedImage test = load_image(arguments.tests[i]);
    results.push_back(compare_two(reference, test, settings));
    if (!arguments.maps.empty()) {
      maps += write_maps(arguments.maps, prefix_of(arguments, i), reference, test, results.back()).size();
    }
    if (!arguments.html.empty()) sections.push_back(page_section(reference, test, results.back(), settings));
  }
  print_comparisons(results, settings);
  if (maps > 0) fmt::print("{} maps in {}\n", maps, arguments.maps);
  if (!arguments.json.empty()) write_file_atomically(arguments.json, json_text(results, settings));
  if (!arguments.html.empty()) write_file_atomically(arguments.html, comparison_page(sections, settings));
  if (arguments.update) {
    return update_reference(results.front()) ? ExitCode::kSuccess : ExitCode::kDiffers;
  }
  const bool passes =
      std::all_of(results.begin(), results.end(), [](const Comparison& c) { return c.passes(); });
  return passes ? ExitCode::kSuccess : ExitCode::kDiffers;
}

void add_metric_options(CLI::App& command, Arguments& arguments) {
  MetricOptions& options = arguments.settings.options;
  command
      .add_option("--data-range", options.data_range,
                  "peak of PSNR and L of SSIM; 0 = the reference's maximum")
      ->check(at_least_zero())
      ->capture_default_str();
  command.add_option("--epsilon", options.epsilon, "added to the squared reference in relMSE")
      ->check(above_zero())
      ->capture_default_str();
  command.add_option("--mape-floor", options.mape_floor, "added to the reference in MAPE")
      ->check(above_zero())
      ->capture_default_str();
}

void add_z_test_options(CLI::App& command, Arguments& arguments) {
  ZTestOptions& options = arguments.z_test;
  command.add_flag("--z-test", arguments.wants_z_test,
                   "test against the reference's mean and variance, pixel by pixel");
  command
      .add_option("--z-alpha", options.alpha,
                  "of --z-test: chance that any test rejects an equal image; in (0, 1)")
      ->capture_default_str();
  command.add_option("--z-accepted", options.accepted, "of --z-test: share of pixels that must accept")
      ->check(from_zero_to_one())
      ->capture_default_str();
  command
      .add_option("--z-mean", options.mean_z,
                  "of --z-test: also fail where a channel's mean over the image is off by more than so many "
                  "standard errors; 0 = report it only")
      ->check(at_least_zero())
      ->capture_default_str();
}

void check_numbers(const Arguments& arguments) {
  const double alpha = arguments.z_test.alpha;
  if (!(alpha > 0 && alpha < 1)) {
    throw CLI::ValidationError("--z-alpha", fmt::format("{} is not in (0, 1)", alpha));
  }
}

void check_update(const Arguments& arguments) {
  if (!arguments.update) return;
  if (arguments.tests.size() > 1) {
    throw CLI::ValidationError("--update", "one test image can become the reference, not several");
  }
  if (fs::path(arguments.reference).extension() != fs::path(arguments.tests.front()).extension()) {
    throw CLI::ValidationError("--update",
                               "reference and test image are of different formats, by their names");
  }
}

}  // namespace

void add_compare(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "compare",
      "Measure how far images are from a reference, and hold them to limits: PSNR, SSIM, relMSE, z-test");
  command->footer(kExamples);
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("reference", arguments->reference, "reference image")->required();
  command->add_option("test", arguments->tests, "images to judge, one or more")->required();
  command
      ->add_option("--max", arguments->max_texts,
                   "[LAYER.]METRIC=VALUE: fail above the value; LAYER *: all layers; repeatable")
      ->allow_extra_args(false);
  command->add_option("--min", arguments->min_texts, "[LAYER.]METRIC=VALUE: fail below the value; repeatable")
      ->allow_extra_args(false);
  command
      ->add_option("--layer", arguments->settings.layers,
                   "compare this layer and no other but those of limits (beauty, diffuse, normal, S0, ...); "
                   "repeatable")
      ->allow_extra_args(false);
  command->add_option("--limits", arguments->limits, "JSON file of limits by layer (docs/compare.md)");
  add_z_test_options(*command, *arguments);
  add_metric_options(*command, *arguments);
  command->add_option("--json", arguments->json,
                      "also write the figures to this file; NaN and infinity become null");
  command->add_option("--maps", arguments->maps, "write difference and error maps (.png) to this folder");
  command->add_option("--html", arguments->html,
                      "also write a page that stands alone: figures, slider, difference and error");
  command->add_flag("--update", arguments->update,
                    "then replace the reference by the test image, if that is finite throughout");
  command->callback([arguments, command, &chosen] {
    check_numbers(*arguments);
    check_update(*arguments);
    for (const std::string& text : arguments->max_texts) {
      arguments->settings.limits.push_back(parse_limit(text, true));
    }
    for (const std::string& text : arguments->min_texts) {
      arguments->settings.limits.push_back(parse_limit(text, false));
    }
    chosen = [arguments, command] {
      if (!arguments->limits.empty()) add_limits_file(*command, *arguments);
      if (arguments->wants_z_test) arguments->settings.z_test = arguments->z_test;
      return compare_command(*arguments);
    };
  });
}

}  // namespace spectrace::cli

// SPDX-License-Identifier: Apache-2.0
// `spectrace separate IN -o OUT.sep`
#include "separation/separate.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "cli/command.h"
#include "cli/output.h"
#include "cli/separation_cache.h"
#include "core/base/file.h"
#include "materials/separated_tables.h"

namespace spectrace::cli {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spectrace separate irid_flake_paint2_spec.bsdf -o irid.sep\n"
    "  spectrace separate paper_white_rgb.bsdf -o paper.sep --report paper.json\n"
    "  spectrace separate mystique.brdf -o mystique.sep\n"
    "  spectrace separate car.bsdf -o car.sep --diffuse table\n"
    "\n"
    "OUT.sep holds all three models (sun, fresnel, diffraction). The report goes to standard output.\n"
    "Exit code 1: the fit is unusable, and OUT.sep is not written.";

struct Arguments {
  std::string input, output, report;
  std::string weight = "product", spacing = "quadratic", diffuse = "lambert", residual = "whole",
              colour = "dark";
  int threads = 0;
};

ExitCode separate_command(const Arguments& arguments) {
  require_folder_of(arguments.output);
  SeparationOptions options;
  options.weight = arguments.weight == "product" ? CosineWeight::kProduct : CosineWeight::kPrinted;
  options.grid.quadratic_theta_h = arguments.spacing == "quadratic";
  options.diffuse = arguments.diffuse == "lambert" ? DiffuseForm::kLambert : DiffuseForm::kTable;
  options.residual = arguments.residual == "whole" ? SpectralResidual::kWhole : SpectralResidual::kPrinted;
  options.colour = arguments.colour == "dark" ? DiffuseColour::kDark : DiffuseColour::kPrinted;
  options.threads = arguments.threads;

  SilentProgress progress;
  const SeparationResult result = separate_file(arguments.input, options, progress);
  fmt::print("{}: {}", arguments.input, result.report.full());
  if (!arguments.report.empty()) {
    write_file_atomically(arguments.report, std::string_view(result.report.json() + "\n"));
  }
  if (!result.report.usable) return ExitCode::kDiffers;
  separated_to_tensors(result.tables).write(arguments.output);
  fmt::print("wrote {}\n", arguments.output);
  return ExitCode::kSuccess;
}

}  // namespace

void add_separate(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("separate", "Separate a measured BRDF into diffuse and specular lobes");
  command->footer(kExamples);
  const auto arguments = std::make_shared<Arguments>();
  command
      ->add_option(
          "input", arguments->input,
          "measured BRDF: of the EPFL database (.bsdf), Cornell's scattered text (.brdf) or MERL's .binary")
      ->required();
  command->add_option("-o,--output", arguments->output, "separated material to write (.sep)")->required();
  command
      ->add_option("--weight", arguments->weight,
                   "cosine weight of eq. 10: as the paper's text says, or as printed")
      ->check(CLI::IsMember({"product", "printed"}))
      ->capture_default_str();
  command->add_option("--theta-h-spacing", arguments->spacing, "how the table spaces the half angle")
      ->check(CLI::IsMember({"quadratic", "uniform"}))
      ->capture_default_str();
  command
      ->add_option("--diffuse", arguments->diffuse,
                   "diffuse lobe: exactly Lambertian, or the table of eq. 16")
      ->check(CLI::IsMember({"lambert", "table"}))
      ->capture_default_str();
  command
      ->add_option("--diffuse-colour", arguments->colour,
                   "read where the specular lobe is weakest, or from eqs. 7 and 18 as printed")
      ->check(CLI::IsMember({"dark", "printed"}))
      ->capture_default_str();
  command
      ->add_option("--residual", arguments->residual,
                   "what eqs. 19 and 20 compare: the whole BRDF, or as printed")
      ->check(CLI::IsMember({"whole", "printed"}))
      ->capture_default_str();
  command->add_option("--report", arguments->report, "also write the report as JSON");
  command->add_option("--threads", arguments->threads, "threads to use, 0 = all cores")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  command->callback([arguments, &chosen] { chosen = [arguments] { return separate_command(*arguments); }; });
}

}  // namespace spectrace::cli

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
#include "cli/grid_option.h"
#include "cli/option_values.h"
#include "cli/output.h"
#include "cli/separation_cache.h"
#include "core/base/cost.h"
#include "core/base/file.h"
#include "materials/choose_model.h"
#include "materials/separated_tables.h"
#include "separation/compact.h"

namespace spectrace::cli {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spectrace separate irid_flake_paint2_spec.bsdf -o irid.sep\n"
    "  spectrace separate paper_white_rgb.bsdf -o paper.sep --report paper.json\n"
    "  spectrace separate mystique.brdf -o mystique.sep\n"
    "  spectrace separate car.bsdf -o car.sep --diffuse table\n"
    "  spectrace separate pearl.bsdf -o pearl.sep --model auto --tolerance 0.02\n"
    "  spectrace separate pearl.bsdf -o pearl.sep --quality 10\n"
    "  spectrace separate pearl.bsdf -o draft.sep --grid 45x30x36\n"
    "\n"
    "OUT.sep holds the chosen model and all cheaper ones. The report goes to standard output.\n"
    "Exit code 1: the fit is unusable, and OUT.sep is not written.";

struct Arguments {
  std::string input, output, report;
  std::string weight = "product", spacing = "quadratic", diffuse = "lambert", residual = "whole",
              colour = "dark";
  std::string model = "diffraction";
  HalfDifferenceGrid grid;
  double tolerance = kDefaultTolerance;
  int quality = kDefaultQuality;
  bool full = false, analytic = false, reciprocal = false;
  int threads = 0;
};

/// The tables as OUT.sep will hold them, and a line about that.
struct Stored {
  TensorFile file;
  std::string summary;
};

Stored store_full(const SeparatedTables& tables) {
  return {.file = separated_to_tensors(tables), .summary = "plain tables of single precision"};
}

Stored store_compact(const SeparatedTables& tables, const Arguments& arguments, SeparationModel richest) {
  const CompactResult result = compact(tables, arguments.quality, richest);
  return {.file = compact_to_tensors(result.tables),
          .summary =
              fmt::format("up to model {}, quality {}: rho_s within {:.2g} of its value, spectra of rank {} "
                          "within {:.2g} (rms)",
                          name_of(richest), arguments.quality, result.report.rho_s_error_bound,
                          result.report.spectral_rank, result.report.spectral_rms_error)};
}

/// The model named, or of --model auto the cheapest that meets the tolerance, with the reason printed.
SeparationModel richest_of(const Arguments& arguments, const SeparatedTables& tables) {
  if (const auto named = separation_model_named(arguments.model)) return *named;
  const ModelChoice choice = choose_model(
      MeasuredBrdf(read_measured(arguments.input)),
      std::make_shared<const CompactTables>(compact(tables, arguments.quality).tables), arguments.tolerance);
  fmt::print("  {:<22}{}\n", "model", choice.reason);
  return choice.model;
}

/// Writes OUT.sep; a line about what it holds.
std::string store(const SeparatedTables& tables, const Arguments& arguments) {
  const SeparationModel richest = richest_of(arguments, tables);
  const Stored stored = arguments.full ? store_full(tables) : store_compact(tables, arguments, richest);
  stored.file.write(arguments.output);
  return stored.summary;
}

ExitCode separate_command(const Arguments& arguments) {
  require_folder_of(arguments.output);
  SeparationOptions options;
  options.weight = arguments.weight == "product" ? CosineWeight::kProduct : CosineWeight::kPrinted;
  options.grid = arguments.grid;
  options.grid.quadratic_theta_h = arguments.spacing == "quadratic";
  options.diffuse = arguments.diffuse == "lambert" ? DiffuseForm::kLambert : DiffuseForm::kTable;
  options.residual = arguments.residual == "whole" ? SpectralResidual::kWhole : SpectralResidual::kPrinted;
  options.colour = arguments.colour == "dark" ? DiffuseColour::kDark : DiffuseColour::kPrinted;
  const bool wants_residual = arguments.model == "residual" || arguments.model == "auto";
  options.residual_rank = wants_residual ? kDefaultResidualRank : 0;
  options.analytic = arguments.analytic;
  options.reciprocal = arguments.reciprocal;
  options.threads = arguments.threads;

  SilentProgress progress;
  SeparationResult result = separate_file(arguments.input, options, progress);
  fmt::print("{}: {}", arguments.input, result.report.full());
  if (result.report.usable) {
    std::string summary;
    result.report.seconds_store = seconds_of([&] { summary = store(result.tables, arguments); });
    fmt::print("wrote {}: {} bytes, {}\n", arguments.output, std::filesystem::file_size(arguments.output),
               summary);
  }
  result.report.peak_memory_bytes = peak_memory_bytes();
  fmt::print("{}", result.report.costs());
  if (!arguments.report.empty()) {
    write_file_atomically(arguments.report, std::string_view(result.report.json() + "\n"));
  }
  return result.report.usable ? ExitCode::kSuccess : ExitCode::kDiffers;
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
  add_grid_option(*command, arguments->grid);
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
      ->add_option("--spectral-residual", arguments->residual,
                   "what eqs. 19 and 20 compare: the whole BRDF, or as printed")
      ->check(CLI::IsMember({"whole", "printed"}))
      ->capture_default_str();
  command
      ->add_option("--model", arguments->model,
                   "richest model to store; auto: the cheapest within --tolerance")
      ->check(CLI::IsMember({"sun", "fresnel", "diffraction", "residual", "auto"}))
      ->capture_default_str();
  command
      ->add_option("--tolerance", arguments->tolerance,
                   "of --model auto: share of the reflected light a model may get wrong")
      ->check(from_zero_to_one())
      ->capture_default_str();
  command
      ->add_option("--quality", arguments->quality,
                   "bits of precision of OUT.sep: its size against its error")
      ->check(CLI::Range(kMinQuality, kMaxQuality))
      ->capture_default_str();
  command->add_flag("--analytic", arguments->analytic,
                    "also fit Lambert + GGX at each wavelength, the paper's comparison");
  command->add_flag("--reciprocal", arguments->reciprocal,
                    "of model residual: leave out in what the measurement is not reciprocal");
  command
      ->add_flag("--full", arguments->full,
                 "plain tables of single precision instead, for other programs to read")
      ->excludes("--quality");
  command->add_option("--report", arguments->report, "also write the report as JSON");
  command->add_option("--threads", arguments->threads, "threads to use, 0 = all cores")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  command->callback([arguments, &chosen] { chosen = [arguments] { return separate_command(*arguments); }; });
}

}  // namespace spectrace::cli

// SPDX-License-Identifier: Apache-2.0
// `spectrace acquire MATERIAL.json -o OUT.bsdf`
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/console_progress.h"
#include "cli/output.h"
#include "core/base/error.h"
#include "materials/acquisition.h"

namespace spectrace::cli {

namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spectrace acquire scenes/materials/pearlescent.json -o pearlescent.bsdf\n"
    "  spectrace acquire brushed.json -o brushed.bsdf --phi 16 --symmetry 2\n"
    "  spectrace acquire metal.json -o metal.bsdf --elevations 16 --table 64\n"
    "\n"
    "OUT.bsdf has the spectral layout of the EPFL material database: 195 wavelengths from 358.63 to\n"
    "1001.89 nm, and by default its grids: 8 elevations, 32 x 32 directions, 128 x 128 visible normals.\n"
    "MATERIAL.json holds one material, docs/materials.md.";

struct Arguments {
  std::string input, output;
  AcquisitionOptions options;
  ProgressStyle progress = ProgressStyle::kAuto;
};

ExitCode acquire_command(const Arguments& arguments) {
  require_folder_of(arguments.output);
  const MaterialDesc description = load_material(arguments.input);
  const Material material = build_material(description);
  AcquisitionOptions options = arguments.options;
  options.description = "Virtual measurement of " + description.name;
  ConsoleProgress progress(arguments.progress);
  try {
    const MeasuredTables tables = acquire(material, options, progress);
    measured_to_tensors(tables).write(arguments.output);
    fmt::print("{}: {} elevations, {} azimuths, {} wavelengths, {} x {} directions\n", arguments.output,
               tables.theta_i.size(), tables.phi_i.size(), tables.axis.size(), tables.table_size,
               tables.table_size);
  } catch (const InputError& e) {
    // The library knows the material, not the file it came from.
    if (e.diagnostics().front().file != options.description) throw;
    throw InputError(arguments.input, "", e.diagnostics().front().problem);
  }
  return ExitCode::kSuccess;
}

}  // namespace

void add_acquire(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("acquire", "Measure a material of this program into an EPFL .bsdf file");
  command->footer(kExamples);
  const auto arguments = std::make_shared<Arguments>();
  AcquisitionOptions& options = arguments->options;
  command->add_option("material", arguments->input, "material to measure (.json)")->required();
  command->add_option("-o,--output", arguments->output, "file to write (.bsdf)")->required();
  command->add_option("--phi", options.azimuths, "incident azimuths, 1 = isotropic")
      ->check(CLI::IsMember({1}) | CLI::Range(4, 64))
      ->capture_default_str();
  command
      ->add_option("--symmetry", options.symmetry,
                   "measure only 1/N of the azimuths: 2 = the material looks the same after half a turn, 4 = "
                   "it is mirror symmetric about both axes (needs --phi)")
      ->check(CLI::IsMember({1, 2, 4}))
      ->capture_default_str();
  command->add_option("--elevations", options.elevations, "incident elevations, 90 degrees included")
      ->check(CLI::Range(3, 64))
      ->capture_default_str();
  command->add_option("--table", options.table_size, "side of the tables of spectra")
      ->check(CLI::Range(4, 256))
      ->capture_default_str();
  add_progress_option(*command, arguments->progress);
  command->callback([arguments, command, &chosen] {
    if (arguments->options.symmetry != 1 && arguments->options.azimuths == 1) {
      throw CLI::ValidationError(command->get_name(), "--symmetry needs --phi");
    }
    chosen = [arguments] { return acquire_command(*arguments); };
  });
}

}  // namespace spectrace::cli

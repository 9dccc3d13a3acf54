// SPDX-License-Identifier: Apache-2.0
// `spectrace reproduce FOLDER -o REPORT`: the paper's tables and figures on every material of a folder.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/console_progress.h"
#include "cli/grid_option.h"
#include "cli/option_values.h"
#include "cli/report/exposure.h"
#include "cli/reproduce/material_study.h"
#include "cli/reproduce/reference_scene.h"
#include "cli/reproduce/study_page.h"
#include "cli/reproduce/study_sheet.h"
#include "cli/reproduce/study_summary.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/version.h"
#include "core/image/metrics.h"
#include "materials/choose_model.h"

namespace spectrace::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExamples =
    "Examples:\n"
    "  spectrace reproduce epfl_rgb -o report\n"
    "  spectrace reproduce epfl_rgb -o report --environment studio.hdr --spp 256\n"
    "  spectrace reproduce scenes/materials -o truth\n"
    "\n"
    "FOLDER's .bsdf, .brdf and .binary files, and materials of the program's own (.json), which are "
    "measured\n"
    "first and whose known lobes are a reference too. REPORT: index.html, results.csv, results.json,\n"
    "figure4.svg, sheets/, pictures/ (EXR), materials/ (a record each), scene/. A finished material is not\n"
    "done again. Exit code 3: a file is bad; 1: a fit is unusable. The rest is done all the same.";

struct Arguments {
  std::string folder, report, environment;
  int height = 144;
  StudyOptions study;
  ProgressStyle progress = ProgressStyle::kAuto;
};

std::vector<fs::path> files_of(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed, unknown;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
    const std::string extension = entry->path().extension().string();
    constexpr std::array kExtensions{".bsdf", ".brdf", ".binary", ".json"};
    if (entry->is_regular_file(unknown) &&
        std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end())
      files.push_back(entry->path());
  }
  if (failed) throw InputError(folder.string(), "", "cannot be read as a folder: " + failed.message());
  if (files.empty()) throw InputError(folder.string(), "", "holds no .bsdf, .brdf, .binary or .json file");
  std::sort(files.begin(), files.end());
  return files;
}

/// A name for each: its stem, or all of its name where two share the stem.
std::vector<std::string> names_of(const std::vector<fs::path>& files) {
  std::map<std::string, int> count;
  for (const fs::path& f : files) ++count[f.stem().string()];
  std::vector<std::string> names;
  for (const fs::path& f : files) {
    names.push_back(count[f.stem().string()] > 1 ? f.filename().string() : f.stem().string());
  }
  return names;
}

class Report {
 public:
  explicit Report(const Arguments& arguments)
      : arguments_(arguments), root_(arguments.report), description_(describe()), scene_(build()) {}

  /// The finished ones first, so that the time left is that of the rest.
  void run(const std::vector<fs::path>& files, Progress& progress) {
    const std::vector<std::string> names = names_of(files);
    records_.resize(files.size());
    std::vector<std::size_t> to_do;
    for (std::size_t i = 0; i < files.size(); ++i) {
      if (auto record = finished(files[i], names[i])) {
        records_[i] = std::move(*record);
      } else {
        to_do.push_back(i);
      }
    }
    if (to_do.size() < files.size()) {
      progress.note(
          fmt::format("{} of {} materials were done before", files.size() - to_do.size(), files.size()));
    }
    for (std::size_t n = 0; n < to_do.size(); ++n) {
      const std::size_t i = to_do[n];
      records_[i] = study(files[i], names[i], [&](double share) {
        progress.update("reproduce", double(n) + share, double(to_do.size()));
      });
      const StudyRecord& r = records_[i];
      progress.note(r.status == "done" ? fmt::format("{}: {}", r.material, r.choice) : r.problem);
    }
  }

  ExitCode write() const {
    const std::vector<ModelMean> means = means_of(records_);
    write_file_atomically(root_ / "results.csv", std::string_view(csv_text(records_)));
    write_file_atomically(root_ / "results.json",
                          std::string_view(json_text(records_, means, protocol()) + "\n"));
    write_file_atomically(root_ / "figure4.svg", std::string_view(svg(psnr_chart(records_))));
    write_file_atomically(root_ / "index.html",
                          std::string_view(study_page(records_, means, root_ / "sheets", protocol())));
    fmt::print("{}\n{}", protocol(), table_text(means));
    for (const std::string& line : findings(means)) fmt::print("{}\n", line);
    fmt::print("wrote {}\n", (root_ / "index.html").string());
    const auto any = [&](const char* status) {
      return std::any_of(records_.begin(), records_.end(),
                         [&](const StudyRecord& r) { return r.status == status; });
    };
    return any("bad") ? ExitCode::kBadInput : any("unusable") ? ExitCode::kDiffers : ExitCode::kSuccess;
  }

 private:
  [[nodiscard]] SceneDesc describe() const {
    for (const char* folder : {"materials", "sheets", "pictures"}) make_folder(root_ / folder);
    return write_reference_scene(root_ / "scene",
                                 {.environment = arguments_.environment, .height = arguments_.height});
  }

  [[nodiscard]] Scene build() const {
    SilentProgress progress;
    return build_scene(description_, progress);
  }

  static void make_folder(const fs::path& folder) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) throw InputError(folder.string(), "", "cannot make this folder: " + failed.message());
  }

  [[nodiscard]] std::string protocol() const {
    const HalfDifferenceGrid& grid = arguments_.study.grid;
    return fmt::format(
        "A sphere and a bumpy ball, {} x {} pixels, {} samples a pixel, seed {}, environment {}; the light "
        "they "
        "reflect, linear sRGB, all pictures of a material on the same random paths; models from .sep files "
        "of "
        "quality {}, {} x {} x {} cells.",
        2 * arguments_.height, arguments_.height, arguments_.study.pictures.spp,
        arguments_.study.pictures.seed,
        arguments_.environment.empty() ? "scene/studio.exr" : arguments_.environment,
        arguments_.study.quality, grid.n_theta_h, grid.n_theta_d, grid.n_phi_d);
  }

  /// Of the program, the protocol and the bytes of all that goes in: figures of another build are made anew.
  [[nodiscard]] std::string key_of(const fs::path& file) const {
    std::string text = fmt::format("study {} {} {} {} tolerance {}", version(), commit(), protocol(),
                                   description_.sha256, arguments_.study.tolerance);
    for (const fs::path& part : {file, fs::path(arguments_.environment), measurement_behind(file)}) {
      if (!part.empty()) text += ' ' + sha256_hex(read_file(part));
    }
    return sha256_hex(std::as_bytes(std::span(text)));
  }

  /// The file that a material of the program's own reads, if any.
  [[nodiscard]] static fs::path measurement_behind(const fs::path& file) {
    if (file.extension() != ".json") return {};
    return std::visit(
        [](const auto& kind) {
          if constexpr (requires { kind.file; }) return kind.file;
          return fs::path();
        },
        load_material(file).kind);
  }

  [[nodiscard]] fs::path record_file(const std::string& name) const {
    return root_ / "materials" / (name + ".json");
  }

  [[nodiscard]] std::optional<StudyRecord> finished(const fs::path& file, const std::string& name) const {
    std::error_code absent;
    if (!fs::exists(record_file(name), absent)) return std::nullopt;
    try {
      std::optional<StudyRecord> record = read_record(record_file(name), key_of(file));
      const bool has_sheet = fs::exists(root_ / "sheets" / (name + ".png"), absent);
      return record && (has_sheet || record->status == "unusable") ? record : std::nullopt;
    } catch (const InputError&) {
      return std::nullopt;  // unreadable by now: study() says so
    }
  }

  StudyRecord study(const fs::path& file, const std::string& name, const std::function<void(double)>& step) {
    StudyRecord about{.material = name,
                      .file = file.string(),
                      .key = {},
                      .status = "bad",
                      .problem = {},
                      .choice = {},
                      .rows = {}};
    MaterialStudy study;
    try {
      about.key = key_of(file);
      study = study_material(file, scene_, arguments_.study, step);
    } catch (const InputError& e) {  // one bad file, and the rest go on
      for (const Diagnostic& d : e.diagnostics())
        about.problem += (about.problem.empty() ? "" : "\n") + d.text();
      return about;
    } catch (const std::bad_alloc&) {
      about.problem =
          fmt::format("{}: not enough memory for a grid of this size at these wavelengths", about.file);
      return about;
    }
    study.record.material = name;
    study.record.file = about.file;
    study.record.key = about.key;
    write_pictures(study, name);
    JsonWriter json;
    write_record(json, study.record);
    write_file_atomically(root_ / "materials" / (name + ".separation.json"),
                          std::string_view(study.report_json + "\n"));
    // Last: a record says that all the rest is there.
    write_file_atomically(record_file(name), std::string_view(json.text() + "\n"));
    return study.record;
  }

  void write_pictures(const MaterialStudy& study, const std::string& name) const {
    if (study.pictures.empty()) return;
    const fs::path folder = root_ / "pictures" / name;
    make_folder(folder);
    const double exposure = exposure_of(study.pictures.front().rgb());
    for (const Picture& picture : study.pictures) {
      write_exr(folder / (picture.name + ".exr"), picture.layers,
                {{"spectrace:protocol", protocol()},
                 {"spectrace:material", name},
                 {"spectrace:model", picture.name}});
      write_png(folder / (picture.name + ".png"), picture.layers, "", exposure);
    }
    write_png(root_ / "sheets" / (name + ".png"), study_sheet(study));
  }

  const Arguments& arguments_;
  fs::path root_;
  SceneDesc description_;
  Scene scene_;
  std::vector<StudyRecord> records_;
};

ExitCode reproduce_command(const Arguments& arguments) {
  const std::vector<fs::path> files = files_of(arguments.folder);
  ConsoleProgress progress(arguments.progress);
  Report report(arguments);
  report.run(files, progress);
  progress.finish();
  return report.write();
}

}  // namespace

void add_reproduce(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "reproduce", "The paper's tables and figures on every measured material of a folder");
  command->footer(kExamples);
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("folder", arguments->folder, "measured materials")->required();
  command->add_option("-o,--output", arguments->report, "folder of the report; made where absent")
      ->required();
  command->add_option("--environment", arguments->environment,
                      "latitude-longitude image that lights the scene; default: a studio of five soft lamps");
  command->add_option("--spp", arguments->study.pictures.spp, "samples a pixel")
      ->check(CLI::Range(1, 1 << 20))
      ->capture_default_str();
  command->add_option("--height", arguments->height, "of a picture in pixels; twice as wide")
      ->check(CLI::Range(kSsimWindow, 4096))
      ->capture_default_str();
  command->add_option("--seed", arguments->study.pictures.seed, "of the random numbers")
      ->capture_default_str();
  command->add_option("--quality", arguments->study.quality, "of the compact .sep files")
      ->check(CLI::Range(kMinQuality, kMaxQuality))
      ->capture_default_str();
  command->add_option("--tolerance", arguments->study.tolerance, "of the choice that --model auto would make")
      ->check(from_zero_to_one())
      ->capture_default_str();
  add_grid_option(*command, arguments->study.grid);
  command->add_option("--threads", arguments->study.pictures.threads, "threads to use, 0 = all cores")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  add_progress_option(*command, arguments->progress);
  command->callback([arguments, &chosen] { chosen = [arguments] { return reproduce_command(*arguments); }; });
}

}  // namespace spectrace::cli

// SPDX-License-Identifier: Apache-2.0
#include "cli/reproduce/material_study.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "core/image/metrics.h"
#include "materials/acquisition.h"
#include "materials/choose_model.h"
#include "separation/tabulate.h"

namespace spectrace::cli {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Input {
  std::shared_ptr<const MeasuredBrdf> measured;
  std::optional<PairedBrdf::Values> truth;  ///< of a material of the program's own
  double seconds = 0;                       ///< to read
};

Input read_input(const std::filesystem::path& file) {
  const auto start = Clock::now();
  Input input;
  if (file.extension() == ".json") {
    const Material material = build_material(load_material(file));
    AcquisitionOptions options;
    options.description = file.string();  // what messages call it
    SilentProgress progress;
    input.measured = std::make_shared<const MeasuredBrdf>(acquire(material, options, progress));
    std::visit(
        [&](const auto& m) {
          if constexpr (std::is_constructible_v<PairedBrdf::Values, decltype(m)>) input.truth = m;
        },
        material);
  } else {
    input.measured = std::make_shared<const MeasuredBrdf>(read_measured(file));
  }
  input.seconds = seconds_since(start);
  return input;
}

/// A model's compact form, as a .sep file keeps it.
struct ModelFile {
  std::string name;
  SeparationModel model{};
  std::shared_ptr<const CompactTables> tables;
  double seconds = 0;  ///< to make it small
  std::int64_t bytes = 0;
};

/// A description of the material, and what it costs to have it.
struct Description {
  std::string name;
  double seconds = 0;
  std::int64_t bytes = 0;
};

class Study {
 public:
  Study(const std::filesystem::path& file, Scene& scene, const StudyOptions& options,
        const std::function<void(double)>& step)
      : file_(file), scene_(scene), options_(options), step_(step), input_(read_input(file)) {}

  MaterialStudy run() {
    study_.record.wavelengths = static_cast<std::int64_t>(input_.measured->axis().size());
    separate_it();
    if (study_.record.status != "done") return std::move(study_);
    picture_all();
    for (const Description& d : descriptions_) {
      if (d.name != "raw") compare("raw", d.name, d.name);
      const bool is_of_x = !d.name.ends_with("table") && d.name != "raw" && d.name != "tabulated";
      if (is_of_x) compare("tabulated", d.name, d.name);
      if (input_.truth) compare("truth", d.name, d.name);
    }
    if (input_.truth) {
      compare("truth", "diffraction", "diffuse", "diffuse");
      compare("truth", "diffraction", "specular", "specular");
    }
    return std::move(study_);
  }

 private:
  void separate_it() {
    SeparationOptions options = table_options();
    options.residual_rank = kDefaultResidualRank;
    options.analytic = true;
    SilentProgress progress;
    SeparationResult result = separate(*input_.measured, options, progress);
    report_ = result.report;
    study_.report_json = report_.json();
    StudyRecord& record = study_.record;
    record.cells = std::int64_t(report_.cells);
    record.measured = std::int64_t(report_.measured);
    record.extrapolated = std::int64_t(report_.extrapolated);
    record.invalid = std::int64_t(report_.invalid);
    record.below_horizon = std::int64_t(report_.below_horizon);
    record.negative_values = std::int64_t(report_.negative_values);
    record.specular_share = report_.specular_share;
    record.lambert_cost = report_.lambert_cost;
    if (!report_.usable) {
      record.status = "unusable";
      record.problem = report_.verdict;
      return;
    }
    for (const SeparationModel model : {SeparationModel::kSun, SeparationModel::kFresnel,
                                        SeparationModel::kDiffraction, SeparationModel::kResidual}) {
      add_model(name_of(model), model, result.tables);
    }
    compact_ = models_.back().tables;
    result.tables.residual.odd.clear();
    add_model("residual_reciprocal", SeparationModel::kResidual, result.tables);
    record.choice = choose_model(*input_.measured, compact_, options_.tolerance).reason;
    advance();
  }

  void add_model(const std::string& name, SeparationModel model, const SeparatedTables& tables) {
    const auto start = Clock::now();
    auto small = std::make_shared<const CompactTables>(compact(tables, options_.quality, model).tables);
    const auto bytes = std::int64_t(compact_to_tensors(*small).serialize().size());
    models_.push_back({name, model, std::move(small), seconds_since(start), bytes});
  }

  [[nodiscard]] SeparationOptions table_options() const {
    SeparationOptions options;
    options.grid = options_.grid;
    options.threads = options_.pictures.threads;
    return options;
  }

  void picture_all() {
    const double table_s = input_.seconds + report_.seconds_table;
    const double steps_s = table_s + report_.seconds_step1 + report_.seconds_step2 + report_.seconds_step3;
    picture({"raw", input_.seconds, std::int64_t(file_bytes())}, *input_.measured);
    if (input_.truth) picture({"truth", 0, 0}, *input_.truth);
    tabulated(
        "plain_table", [](const auto&... a) { return tabulate_plain(a...); },
        [](auto table) { return PlainTableBrdf(std::move(table)); });
    tabulated(
        "tabulated", [](const auto&... a) { return tabulate(a...); },
        [](auto table) { return TabulatedBrdf(std::move(table)); });
    tabulated(
        "oriented_table", [](const auto&... a) { return tabulate_oriented(a...); },
        [](auto table) { return TabulatedBrdf(std::move(table)); });
    picture({"analytic", table_s + report_.seconds_step1 + report_.seconds_analytic,
             std::int64_t(compact_->analytic.size() * sizeof(float))},
            AnalyticBrdf(compact_->axis, compact_->analytic));
    for (const ModelFile& m : models_) {
      const double residual_s = m.model == SeparationModel::kResidual ? report_.seconds_residual : 0;
      picture({m.name, steps_s + residual_s + m.seconds, m.bytes}, SeparatedBrdf(m.tables, m.model));
    }
  }

  /// The table lives only as long as its picture takes: at 195 wavelengths it fills 1.1 GB.
  template <typename Make, typename Brdf>
  void tabulated(const std::string& name, const Make& make, const Brdf& brdf) {
    const auto start = Clock::now();
    auto table = std::make_shared<const HalfDifferenceTable>(make(*input_.measured, table_options()));
    const double seconds = input_.seconds + seconds_since(start);
    const auto bytes = std::int64_t((table->q.size() + table->odd.size()) * sizeof(float));
    picture({name, seconds, bytes}, brdf(std::move(table)));
  }

  void picture(Description description, PairedBrdf::Values values) {
    const SeparatedBrdf directions(compact_, SeparationModel::kDiffraction);
    study_.pictures.push_back(
        take_picture(description.name, scene_, std::move(values), directions, options_.pictures));
    study_.record.invalid_samples += study_.pictures.back().invalid_samples;
    if (description.name != "truth") descriptions_.push_back(std::move(description));
    advance();
  }

  void compare(const std::string& reference, const std::string& picture, const std::string& row_name,
               const std::string& layer = "") {
    const auto named = [&](const std::string& name) -> const Picture& {
      return *std::find_if(study_.pictures.begin(), study_.pictures.end(),
                           [&](const Picture& p) { return p.name == name; });
    };
    const auto description = std::find_if(descriptions_.begin(), descriptions_.end(),
                                          [&](const Description& d) { return d.name == picture; });
    const Metrics metrics = compare_images(named(reference).rgb(layer), named(picture).rgb(layer));
    study_.record.rows.push_back({.reference = reference,
                                  .model = row_name,
                                  .psnr_db = metrics.psnr_db,
                                  .ssim = metrics.ssim,
                                  .mape = metrics.mape,
                                  .rel_mse = metrics.rel_mse,
                                  .seconds = description->seconds,
                                  .bytes = description->bytes});
  }

  [[nodiscard]] std::uintmax_t file_bytes() const { return std::filesystem::file_size(file_); }

  void advance() {
    constexpr double kSteps = 11;  // the separation and ten pictures; the truth's is not counted
    step_(std::min(1.0, ++steps_done_ / kSteps));
  }

  const std::filesystem::path& file_;
  Scene& scene_;
  const StudyOptions& options_;
  const std::function<void(double)>& step_;
  Input input_;
  MaterialStudy study_;
  SeparationReport report_;
  std::shared_ptr<const CompactTables> compact_;  // of all models
  std::vector<ModelFile> models_;                 // cheapest first
  std::vector<Description> descriptions_;
  int steps_done_ = 0;
};

}  // namespace

MaterialStudy study_material(const std::filesystem::path& input, Scene& scene, const StudyOptions& options,
                             const std::function<void(double share)>& step) {
  return Study(input, scene, options, step).run();
}

}  // namespace spectrace::cli

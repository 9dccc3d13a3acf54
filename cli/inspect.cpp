// SPDX-License-Identifier: Apache-2.0
// `spectrace inspect FILE`
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>

#include "cli/command.h"
#include "cli/inspect_report.h"
#include "core/base/error.h"
#include "core/image/image.h"
#include "materials/tensor_file.h"

namespace spectrace::cli {

namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spectrace inspect cc_nothern_aurora_spec.bsdf\n"
    "  spectrace inspect pearlescent.sep\n"
    "  spectrace inspect mystique.brdf\n"
    "  spectrace inspect out.exr --json\n"
    "  spectrace inspect scenes/cornell_box.json\n"
    "  spectrace inspect scenes/materials/glossy.json\n"
    "\n"
    "Tells the file's fields, units and ranges; of measurements what is measured, invalid and extrapolated.\n"
    "Files are told apart by content: tensor files (.bsdf, .sep), scenes and materials (JSON), images "
    "(EXR, HDR, PNG, ...);\nother measurements by their extension: Cornell's scattered text (.brdf), MERL's "
    ".binary.";

enum class FileKind { kTensors, kMeasured, kJson, kImage };

FileKind kind_of(const std::filesystem::path& file) {
  std::array<char, 64> head{};
  std::ifstream in(file, std::ios::binary);
  in.read(head.data(), head.size());
  const std::string_view text(head.data(),
                              static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  if (TensorFile::has_magic(std::as_bytes(std::span(text)))) return FileKind::kTensors;
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  // Damaged ones and those of other programs: their reader says what is wrong.
  if (extension == ".bsdf" || extension == ".sep") return FileKind::kTensors;
  if (extension == ".brdf" || extension == ".binary") return FileKind::kMeasured;
  if (extension == ".json") return FileKind::kJson;
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool is_json =
      first != std::string_view::npos && (text[first] == '{' || text.substr(first, 2) == "//");
  return is_json ? FileKind::kJson : FileKind::kImage;
}

ExitCode inspect_command(const std::string& file, bool as_json) {
  InspectReport report;
  switch (kind_of(file)) {
    case FileKind::kTensors:
      report = inspect_tensors(file);
      break;
    case FileKind::kMeasured:
      report = inspect_measured(file);
      break;
    case FileKind::kJson:
      report = is_material(file) ? inspect_material(file) : inspect_scene(file);
      break;
    case FileKind::kImage:
      report = inspect_image(file);
      break;
  }
  fmt::print("{}", as_json ? to_json(report) : to_text(report));
  return ExitCode::kSuccess;
}

}  // namespace

InspectReport inspect_image(const std::filesystem::path& file) {
  const Image image = read_image(file);
  InspectSection summary;
  summary.title = "image";
  summary.add("file", file.string());
  summary.add("width", image.width);
  summary.add("height", image.height);
  summary.add("channels", image.channels.size());
  std::string layers;
  for (const std::string& layer : image.rgb_layers()) {
    layers += (layers.empty() ? "" : ", ") + (layer.empty() ? std::string("beauty") : layer);
  }
  summary.add("rgb_layers", layers);

  InspectSection channels;
  channels.title = "channels";
  channels.columns = {"channel", "min", "max", "mean", "non_finite", "negative"};
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    const ValueStatistics s = statistics_of(image.data, c, image.channels.size());
    channels.rows.push_back(
        {image.channels[c], s.min, s.max, s.mean, std::int64_t(s.non_finite), std::int64_t(s.negative)});
  }

  InspectSection metadata;
  metadata.title = "metadata";
  for (const auto& [name, value] : read_metadata(file)) {
    std::visit([&, key = name](const auto& x) { metadata.add(key, x); }, value);
  }
  return {summary, channels, metadata};
}

void add_inspect(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("inspect", "Tell what is in a measurement, .sep, image, scene or material");
  command->footer(kExamples);
  struct Arguments {
    std::string file;
    bool as_json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("file", arguments->file, "file to inspect")->required();
  command->add_flag("--json", arguments->as_json, "print JSON instead of text");
  command->callback([arguments, &chosen] {
    chosen = [arguments] { return inspect_command(arguments->file, arguments->as_json); };
  });
}

}  // namespace spectrace::cli

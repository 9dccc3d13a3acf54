// SPDX-License-Identifier: Apache-2.0
// `spectrace sheet OUT.png IMAGE...`
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/option_values.h"
#include "core/base/error.h"
#include "core/image/contact_sheet.h"
#include "core/image/image.h"

namespace spectrace::cli {

namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spectrace sheet sheet.png raw.exr sun.exr fresnel.exr diffraction.exr --columns 2\n"
    "  spectrace sheet lobes.png raw.exr model.exr --labels 'measured,model' --layer specular --exposure "
    "0.5\n"
    "\n"
    "Pixels that are NaN or infinite are painted magenta.";

constexpr std::size_t kMaxSheetPixels = std::size_t(1) << 26;  // 8192 x 8192: what viewers still open

struct Arguments {
  std::string output;
  std::vector<std::string> inputs, labels;
  std::string layer = "beauty", font;
  int columns = 0;
  double exposure = 1;
};

SheetItem load_item(const Arguments& arguments, std::size_t i) {
  const std::string layer = arguments.layer == "beauty" ? "" : arguments.layer;
  const std::string& file = arguments.inputs[i];
  SheetItem item{read_image(file, kMaxSheetPixels).select(rgb_channels(layer), file), ""};
  for (float& x : item.rgb.data) x = static_cast<float>(x * arguments.exposure);
  item.caption = arguments.labels.empty() ? std::filesystem::path(file).stem().string() : arguments.labels[i];
  return item;
}

/// Before the sheet is allocated: one huge image among many makes every cell huge.
void check_sheet_size(const std::vector<SheetItem>& items, const Arguments& arguments) {
  std::size_t width = 0, height = 0;
  for (const SheetItem& item : items) {
    width = std::max(width, static_cast<std::size_t>(item.rgb.width));
    height = std::max(height, static_cast<std::size_t>(item.rgb.height));
  }
  if (width * height > kMaxSheetPixels / items.size()) {
    throw InputError(arguments.output, "",
                     fmt::format("{} cells of {} x {} pixels are more than {} pixels", items.size(), width,
                                 height, kMaxSheetPixels));
  }
}

ExitCode sheet_command(const Arguments& arguments) {
  std::vector<SheetItem> items;
  for (std::size_t i = 0; i < arguments.inputs.size(); ++i) items.push_back(load_item(arguments, i));
  check_sheet_size(items, arguments);
  std::optional<std::filesystem::path> font = find_caption_font();
  if (!arguments.font.empty()) font = arguments.font;
  const ContactSheet sheet = make_contact_sheet(items, arguments.columns, font);
  write_png(arguments.output, sheet.image);
  if (!sheet.has_captions) {
    fmt::print(stderr, "no captions: {}\n",
               font ? fmt::format("text cannot be drawn with {}", font->string())
                    : std::string("no font found; name one by --font, or install fonts-dejavu-core"));
  }
  fmt::print("{}: {} images, {} x {} pixels\n", arguments.output, items.size(), sheet.image.width,
             sheet.image.height);
  return ExitCode::kSuccess;
}

}  // namespace

void add_sheet(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("sheet", "Put images side by side into one PNG, with captions");
  command->footer(kExamples);
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("output", arguments->output, "sheet to write (.png)")->required();
  command->add_option("images", arguments->inputs, "images to show")->required();
  command->add_option("--labels", arguments->labels, "captions, separated by commas; default: the file names")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--columns", arguments->columns, "0 = as near to a square as it gets")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  command->add_option("--exposure", arguments->exposure, "factor before the sRGB curve")
      ->check(above_zero())
      ->capture_default_str();
  command->add_option("--layer", arguments->layer, "RGB layer to show: beauty, diffuse, specular, ...")
      ->capture_default_str();
  command->add_option("--font", arguments->font, "TrueType font of the captions");
  command->callback([arguments, &chosen] {
    if (std::filesystem::path(arguments->output).extension() != ".png") {
      throw CLI::ValidationError("output", fmt::format("\"{}\" does not end in .png", arguments->output));
    }
    if (!arguments->labels.empty() && arguments->labels.size() != arguments->inputs.size()) {
      throw CLI::ValidationError("--labels", fmt::format("{} labels for {} images", arguments->labels.size(),
                                                         arguments->inputs.size()));
    }
    if (std::isnan(arguments->exposure)) throw CLI::ValidationError("--exposure", "NaN is no exposure");
    chosen = [arguments] { return sheet_command(*arguments); };
  });
}

}  // namespace spectrace::cli

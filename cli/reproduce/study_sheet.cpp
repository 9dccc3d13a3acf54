// SPDX-License-Identifier: Apache-2.0
#include "cli/reproduce/study_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "cli/report/exposure.h"
#include "core/image/contact_sheet.h"
#include "core/image/error_map.h"

namespace spectrace::cli {
namespace {

constexpr double kComponentGain = 4;  // of signed parts, which are small beside the picture
constexpr int kColumns = 7;

class Sheet {
 public:
  explicit Sheet(const MaterialStudy& study)
      : study_(study), exposure_(exposure_of(study.pictures.front().rgb())) {}

  Image draw() {
    descriptions();
    errors();
    components();
    if (find("truth") != nullptr) truth();
    return make_contact_sheet(items_, kColumns).image;
  }

 private:
  [[nodiscard]] const Picture* find(const std::string& name) const {
    const auto found = std::find_if(study_.pictures.begin(), study_.pictures.end(),
                                    [&](const Picture& p) { return p.name == name; });
    return found == study_.pictures.end() ? nullptr : &*found;
  }

  [[nodiscard]] std::string figures(const std::string& reference, const std::string& model) const {
    for (const StudyRow& row : study_.record.rows) {
      if (row.reference == reference && row.model == model) {
        return fmt::format("{:.1f} dB, MAPE {:.1f} %", row.psnr_db, 100 * row.mape);
      }
    }
    return "";
  }

  [[nodiscard]] Image exposed(Image image) const {
    for (float& x : image.data) x *= static_cast<float>(exposure_);
    return image;
  }

  void add(Image image, std::string caption) { items_.push_back({std::move(image), std::move(caption)}); }
  void add_picture(const std::string& name, const std::string& caption) {
    add(exposed(find(name)->rgb()), caption);
  }
  void add_layer(const std::string& picture, const std::string& layer, const std::string& caption,
                 double signed_gain = 0) {
    const Image image = exposed(find(picture)->rgb(layer));
    add(signed_gain > 0 ? signed_map(image, signed_gain) : image, caption);
  }
  void add_error(const std::string& reference, const std::string& model) {
    add(error_map(find(reference)->rgb(), find(model)->rgb()),
        model + " - " + (reference == "raw" ? "measured" : "table X") + ": " + figures(reference, model));
  }

  void descriptions() {
    add_picture("raw", study_.record.material + ", measured");
    add_picture("tabulated", "table X");
    for (const char* model : {"analytic", "sun", "fresnel", "diffraction"}) {
      add_picture(model, std::string(model) + ": " + figures("tabulated", model));
    }
    add_picture("residual", "residual: " + figures("raw", "residual"));
  }

  void errors() {
    const Image& first = items_.front().rgb;
    add(error_scale(first.width, first.height),
        fmt::format("relative error, 0 to {:.0f} %", 100 * kErrorMapFull));
    add_error("raw", "tabulated");
    for (const char* model : {"analytic", "sun", "fresnel", "diffraction"}) add_error("tabulated", model);
    add_error("raw", "residual");
  }

  void components() {
    add_layer("residual", "diffuse", "diffuse");
    add_layer("residual", "specular", "specular");
    add_layer("residual", "specular_fresnel", "Fresnel part of it");
    add_layer("residual", "specular_diffraction", "diffraction effect, grey = 0, x 4", kComponentGain);
    add_layer("residual", "specular_residual", "residual, grey = 0, x 4", kComponentGain);
    add_error("raw", "diffraction");
    add_error("raw", "oriented_table");
  }

  void truth() {
    add_picture("truth", "truth");
    add_layer("truth", "diffuse", "true diffuse");
    add_layer("diffraction", "diffuse", "diffuse: " + figures("truth", "diffuse"));
    add(error_map(find("truth")->rgb("diffuse"), find("diffraction")->rgb("diffuse")), "its error");
    add_layer("truth", "specular", "true specular");
    add_layer("diffraction", "specular", "specular: " + figures("truth", "specular"));
    add(error_map(find("truth")->rgb("specular"), find("diffraction")->rgb("specular")), "its error");
  }

  const MaterialStudy& study_;
  double exposure_;
  std::vector<SheetItem> items_;
};

}  // namespace

Image study_sheet(const MaterialStudy& study) { return Sheet(study).draw(); }

}  // namespace spectrace::cli

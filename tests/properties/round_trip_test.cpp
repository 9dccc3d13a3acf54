// SPDX-License-Identifier: Apache-2.0
// What is written and read again is what it was.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/spectra/color.h"
#include "materials/tensor_file.h"

namespace spectrace::test {
namespace {

/// Any text of printable ASCII, quotes and backslashes among it.
rc::Gen<std::string> printable() {
  return rc::gen::container<std::string>(rc::gen::inRange<char>(' ', '\x7f'));
}

RC_GTEST_PROP(RoundTrip, OfJsonNumbersIsExact, (double x)) {
  RC_PRE(std::isfinite(x));
  JsonWriter writer;
  writer.begin_object();
  writer.member("x", x);
  writer.end_object();
  JsonDocument document = JsonDocument::parse(writer.text(), "x.json");
  RC_ASSERT(document.root().get("x").number(std::nan("")) == x);
  RC_ASSERT(document.diagnostics().empty());
}

RC_GTEST_PROP(RoundTrip, OfJsonTextIsExact, ()) {
  const auto texts = *rc::gen::container<std::vector<std::string>>(printable());
  JsonWriter writer;
  writer.begin_array();
  for (const std::string& text : texts) writer.value(text);
  writer.end_array();
  JsonDocument document = JsonDocument::parse(writer.text(), "x.json");
  std::vector<std::string> read;
  for (const JsonValue& element : document.root().elements()) read.push_back(element.string());
  RC_ASSERT(read == texts);
}

RC_GTEST_PROP(RoundTrip, OfTensorFilesIsExact, (const std::vector<std::vector<float>>& fields)) {
  TensorFile file;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].empty()) continue;
    file.add(Tensor::from_floats("field" + std::to_string(i), {fields[i].size()}, fields[i]));
  }
  const std::vector<std::byte> bytes = file.serialize();
  const TensorFile read = TensorFile::parse(bytes, "x.sep");
  RC_ASSERT(read.tensors().size() == file.tensors().size());
  for (std::size_t i = 0; i < read.tensors().size(); ++i) {
    RC_ASSERT(read.tensors()[i].name == file.tensors()[i].name);
    RC_ASSERT(read.tensors()[i].shape == file.tensors()[i].shape);
    RC_ASSERT(read.tensors()[i].bytes == file.tensors()[i].bytes);
  }
  RC_ASSERT(read.serialize() == bytes);
}

RC_GTEST_PROP(RoundTrip, OfColoursIsExactToRounding, ()) {
  const auto component =
      rc::gen::map(rc::gen::inRange(0, 1 << 20), [](int i) { return double(i) / (1 << 16); });
  const Rgb rgb{*component, *component, *component};
  const Rgb again = xyz_to_rgb(rgb_to_xyz(rgb));
  for (std::size_t c = 0; c < 3; ++c) {
    RC_ASSERT(std::abs(again[c] - rgb[c]) <= 1e-12 * (rgb[0] + rgb[1] + rgb[2]));
    const double shown = rgb[c] / 16;
    // The curve's two pieces of IEC 61966-2-1 meet to 1e-6 only.
    RC_ASSERT(std::abs(srgb_decode(srgb_encode(shown)) - shown) <= 1e-6);
  }
}

}  // namespace
}  // namespace spectrace::test

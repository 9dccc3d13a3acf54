// SPDX-License-Identifier: Apache-2.0
// Images for the tests of `spectrace compare`.
#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"
#include "tests/cli/program.h"

namespace spectrace::test {

inline Image constant(float value, std::vector<std::string> channels = {"R", "G", "B"}, int width = 16,
                      int height = 16) {
  Image image(width, height, std::move(channels));
  image.data.assign(image.data.size(), value);
  return image;
}

class CompareProgram : public Program {
 protected:
  /// Names a new EXR file.
  std::string file(const std::string& name, const Image& image, const Metadata& metadata = {}) const {
    write_exr(folder_ / name, image, metadata);
    return (folder_ / name).string();
  }
};

}  // namespace spectrace::test

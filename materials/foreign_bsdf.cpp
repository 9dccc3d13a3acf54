// SPDX-License-Identifier: Apache-2.0
#include "materials/foreign_bsdf.h"

#include <cstddef>

namespace spectrace {

std::string_view foreign_bsdf(std::string_view bytes) {
  constexpr std::size_t kLooked = 4096;  // the keywords of text formats stand in the first dozen lines
  std::string_view text = bytes.substr(0, kLooked);
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // UTF-8 byte order mark
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == text.npos) return {};
  text.remove_prefix(first);
  const auto mentions = [&](std::string_view word) { return text.find(word) != text.npos; };
  if (text.starts_with("#?RADIANCE")) return "a Radiance file";
  if (text.starts_with("<")) return "an XML file, as Radiance's genBSDF and LBNL WINDOW write";
  // LightTools' files share some of the keywords of Radiant's "BSDF Data Interchange" format that Zemax
  // reads.
  if (mentions("LightTools")) return "a LightTools BSDF text file";
  if (mentions("ScatterAzimuth") || mentions("SpectralContent")) return "a Zemax tabular BSDF text file";
  if (mentions("ScatterType") || mentions("AOI")) return "a LightTools BSDF text file";
  return {};
}

}  // namespace spectrace

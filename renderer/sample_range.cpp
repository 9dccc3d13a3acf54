// SPDX-License-Identifier: Apache-2.0
#include "renderer/sample_range.h"

namespace spectrace {

std::vector<LeafRange> blocks_of(LeafRange leaves) {
  std::vector<LeafRange> blocks;
  while (leaves.count > 0) {
    blocks.push_back(largest_block(leaves.first, leaves.count));
    leaves = {blocks.back().end(), leaves.count - blocks.back().count};
  }
  return blocks;
}

}  // namespace spectrace

// SPDX-License-Identifier: Apache-2.0
// Meshes as PLY files, to be read again.
#pragma once

#include <string>

#include "renderer/geometry.h"

namespace spectrace::test {

enum class PlyFormat { kText, kLittleEndian, kBigEndian };

/// The whole file; numbers as float, so that nothing is lost.
std::string ply_text(const TriangleMesh& mesh, PlyFormat format);

}  // namespace spectrace::test

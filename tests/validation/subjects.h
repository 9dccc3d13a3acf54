// SPDX-License-Identifier: Apache-2.0
// What the full-size statistics are made on: more than the default suite's time allows.
#pragma once

#include <string>
#include <vector>

#include "tests/statistical/bsdf_registry.h"

namespace spectrace::test {

struct Subject {
  std::string family;  ///< a row of the table
  BsdfCase bsdf;
};

/// Every BSDF of the registry; those with a roughness at seven of them from 0.001 to 1; every real file as
/// measured, and separated on the default grid in compact form by each model. Nothing is read or made before
/// its `make` is called; the models of one file follow each other and share its separation.
std::vector<Subject> validation_subjects();

}  // namespace spectrace::test

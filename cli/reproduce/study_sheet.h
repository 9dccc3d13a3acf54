// SPDX-License-Identifier: Apache-2.0
// All pictures of one material on one sheet, in the manner of the paper's figures 3 and 5 to 9.
#pragma once

#include "cli/reproduce/material_study.h"

namespace spectrace::cli {

/// Rows: the descriptions; their error maps against the table X, the two outer ones against the measurement;
/// the components, and more error maps against the measurement; of a material of the program's own the truth
/// and its components. PSNR and MAPE are inset.
Image study_sheet(const MaterialStudy& study);

}  // namespace spectrace::cli

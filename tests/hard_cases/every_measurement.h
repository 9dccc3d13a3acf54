// SPDX-License-Identifier: Apache-2.0
// What the hard cases of measured BRDFs are held on: measurements of formulae, of the virtual goniophotometer
// and every real file there is, each as it is and separated.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "materials/material.h"
#include "separation/separate.h"

namespace spectrace::test {

struct Measurement {
  std::filesystem::path file;
  std::unique_ptr<const MeasuredBrdf> brdf;
  std::shared_ptr<const SeparatedTables> separated;  ///< null of an anisotropic material
};

/// One of measurement_names(); read and separated once a program. SetUp() skips what is absent.
class EveryMeasurement : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override;
  [[nodiscard]] const MeasuredBrdf& measured() const { return *measurement_->brdf; }
  [[nodiscard]] const std::filesystem::path& file() const { return measurement_->file; }
  [[nodiscard]] const std::shared_ptr<const SeparatedTables>& separated() const {
    return measurement_->separated;
  }
  /// As measured, and by each model of its separation, by name.
  [[nodiscard]] std::vector<std::pair<std::string, Material>> forms() const;

 private:
  const Measurement* measurement_ = nullptr;
};

/// "synthetic", ...; "acquired_gold", ...; the real files' names, or "real_files" where there are none.
std::vector<std::string> measurement_names();

}  // namespace spectrace::test

/// `suite`: an alias of EveryMeasurement.
#define SPECTRACE_ON_EVERY_MEASUREMENT(suite)                                    \
  INSTANTIATE_TEST_SUITE_P(All, suite, ::testing::ValuesIn(measurement_names()), \
                           [](const auto& name) { return name.param; })

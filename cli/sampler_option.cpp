// SPDX-License-Identifier: Apache-2.0
#include "cli/sampler_option.h"

#include <map>
#include <string>

#include "cli/option_values.h"

namespace spectrace::cli {

void add_sampler_option(CLI::App& app, std::optional<SamplerKind>& sampler) {
  std::map<std::string, SamplerKind> names;
  for (const SamplerKind kind : {SamplerKind::kOwenSobol, SamplerKind::kIndependent}) {
    names.emplace(sampler_name(kind), kind);
  }
  take_one_of(
      app.add_option(
          "--sampler", sampler,
          "how the samples of a pixel relate: owen-sobol (stratified), independent (more noise); default: "
          "the scene's"),
      names);
}

}  // namespace spectrace::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace spectrace {

/// Functions for std::visit, one for each kind a variant holds: one that is missing does not compile.
template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

}  // namespace spectrace

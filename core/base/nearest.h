// SPDX-License-Identifier: Apache-2.0
// "Did you mean ...?"
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace spectrace {

/// The name in `known` with the fewest edits (insert, delete, replace, swap neighbours; case is ignored) from
/// `word`, or one that begins with `word`; nothing where even that one differs in more than a third of its
/// letters, at least two.
std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string> known);

/// `; did you mean "roughness"?`, or nothing: to be put behind a message.
std::string suggestion(std::string_view word, std::span<const std::string> known);

}  // namespace spectrace

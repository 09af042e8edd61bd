#pragma once
/// A comparison as terminal text and as JSON (docs/reference/compare.md).

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "alhazen/laboratory/compare.h"

namespace alhazen {

/// Two tables: over all rays, and by kind of ray.
[[nodiscard]] std::string comparison_table(const Comparison& comparison);

/// The comparisons of all scenes, with the version of the format.
[[nodiscard]] nlohmann::ordered_json comparison_json(std::span<const Comparison> comparisons);

}  // namespace alhazen

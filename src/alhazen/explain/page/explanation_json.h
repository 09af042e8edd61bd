#pragma once
/// An explanation as JSON (docs/guide/explain.md lists the fields).
///
/// Conventions: numbers that are not finite are null; rays are numbered in the order of the tree,
/// depth first, from 1. `weight` of a ray is the product of all factors of its radiance on the way
/// to the pixel, so `weight * radiance` is its share of the pixel.

#include <string>

#include "alhazen/explain/explanation.h"

namespace alhazen {

/// `indent`: blanks per level; negative: a single line.
[[nodiscard]] std::string explanation_json(const Explanation& explanation, int indent);

}  // namespace alhazen

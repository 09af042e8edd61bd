#pragma once
/// The importance of a node of the light tree: an estimate of the light that it sends to a point.
///
/// Source: as light_tree.h, section 5.
/// Conventions: two nodes are evaluated in SIMD lanes with SSE2; results are the same without.

#include <array>

#include "alhazen/illumination/light_tree.h"

namespace alhazen {

[[nodiscard]] double importance(const LightTree::Node& node, const LitPoint& at);

[[nodiscard]] std::array<double, 2> importances(const LightTree::Siblings& two, const LitPoint& at);

}  // namespace alhazen

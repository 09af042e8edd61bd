#pragma once
/// What the lights of a node of the light tree may send to a point, about.
///
/// Source: as light_tree.h, section 5.
/// Conventions: the two nodes in lanes where the compiler has SSE2; the same bits without.

#include <array>

#include "alhazen/illumination/light_tree.h"

namespace alhazen {

[[nodiscard]] double importance(const LightTree::Node& node, const LitPoint& at);

/// Of two that follow each other.
[[nodiscard]] std::array<double, 2> importances(const LightTree::Node* two, const LitPoint& at);

}  // namespace alhazen

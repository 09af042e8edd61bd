#pragma once
/// `LightTree::choose` for eight points in lanes.
///
/// Conventions: the bits are those of LightTree::choose.

#include <cstddef>
#include <span>

#include "alhazen/illumination/light_tree.h"

namespace alhazen {

inline constexpr std::size_t kMostLightChoices = 8;

/// Chooses a light for each of up to kMostLightChoices points; `choices` in [0, 1).
void choose_lights(const LightTree& tree, std::span<const LitPoint> at,
                   std::span<const double> choices, ChosenLight* chosen);

}  // namespace alhazen

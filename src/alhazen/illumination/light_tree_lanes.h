#pragma once
/// `LightTree::choose` for sixteen points, several of them with both siblings in lanes at a time:
/// eight with AVX-512, else two.
///
/// Conventions: the bits are those of LightTree::choose.

#include <cstddef>

#include "alhazen/illumination/light_tree.h"

namespace alhazen {

/// Numbers in [0, 1) for choices, [lane].
struct ChoiceLanes {
    alignas(64) double of[LitPointLanes::kMost] = {};
};

/// Chooses a light for each of the first `count` points.
void choose_lights(const LightTree& tree, const LitPointLanes& at, const ChoiceLanes& choices,
                   std::size_t count, ChosenLight* chosen);

}  // namespace alhazen

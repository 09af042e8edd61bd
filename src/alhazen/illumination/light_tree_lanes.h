#pragma once
/// `LightTree::choose` for sixteen points, several of them with all children in lanes at a time:
/// eight with AVX-512, four with AVX2. Otherwise, and in trees with cones, one by one.
///
/// Conventions: the bits are those of LightTree::choose.

#include <cstddef>

#include "alhazen/illumination/light_tree.h"

namespace alhazen {

/// Numbers in [0, 1) for choices, [lane].
struct ChoiceLanes {
    alignas(64) double of[LitPointLanes::kMost] = {};
};

/// What is read of a light after its choice.
struct alignas(64) LightRecord {
    std::byte bytes[128];
};

/// Chooses a light for each of the first `count` points. `lights`: what is prefetched of a chosen
/// light, [light]; it need not exist for all lights, or for any.
void choose_lights(const LightTree& tree, const LitPointLanes& at, const ChoiceLanes& choices,
                   std::size_t count, ChosenLight* chosen, const LightRecord* lights = nullptr);

}  // namespace alhazen

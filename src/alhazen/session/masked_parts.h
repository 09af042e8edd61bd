#pragma once
/// Number of parts with a visibility mask.

#include <algorithm>
#include <cstdint>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// The number of parts with a visibility mask; the parts of an object count once.
[[nodiscard]] inline std::uint64_t masked_parts(const SceneDescription& description) {
    std::uint64_t count = 0;
    for (const ObjectDescription& object : description.objects) {
        count += static_cast<std::uint64_t>(
            std::count_if(object.parts.begin(), object.parts.end(),
                          [](const Part& part) { return part.visible_to != kAllRays; }));
    }
    return count;
}

}  // namespace alhazen

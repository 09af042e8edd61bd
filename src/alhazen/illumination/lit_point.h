#pragma once
/// A point at which light is gathered: on a surface, or inside a scattering volume.

#include "alhazen/math/vec.h"

namespace alhazen {

struct LitPoint {
    Vec3 point;
    Vec3 normal;              ///< unit, shading, on the side of the view
    bool both_sides = false;  ///< light from behind counts, too
    bool in_volume = false;   ///< light from all directions counts alike; no normal

    [[nodiscard]] static LitPoint inside_volume(const Vec3& point) {
        return {point, {}, true, true};
    }
};

}  // namespace alhazen

#pragma once
/// A point that is to be lit: of a surface, or inside a volume that scatters.

#include "alhazen/math/vec.h"

namespace alhazen {

struct LitPoint {
    Vec3 point;
    Vec3 normal;              ///< unit, shading, on the side of the view
    bool both_sides = false;  ///< light from behind counts, too
    bool in_volume = false;   ///< light counts alike from all sides: there is no normal

    [[nodiscard]] static LitPoint inside_volume(const Vec3& point) {
        return {point, {}, true, true};
    }
};

}  // namespace alhazen

#pragma once
/// A point that is to be lit.

#include "alhazen/math/vec.h"

namespace alhazen {

struct LitPoint {
    Vec3 point;
    Vec3 normal;              ///< unit, shading, on the side of the view
    bool both_sides = false;  ///< light from behind counts, too
};

}  // namespace alhazen

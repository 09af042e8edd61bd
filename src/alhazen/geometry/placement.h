#pragma once
/// A transform with its inverse.

#include "alhazen/math/affine.h"

namespace alhazen {

struct Placement {
    Affine outer_from_inner, inner_from_outer;
};

}  // namespace alhazen

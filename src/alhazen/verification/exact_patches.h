#pragma once
/// All crossings of a line with rational Bezier patches, isolated by exhaustive subdivision and
/// computed in 113 bits.
///
/// Source: Lane and Riesenfeld, "A Theoretical Development for the Computer Generation and Display
/// of Piecewise Polynomial Surfaces", IEEE PAMI 2(1), 1980 (subdivision, convex hulls);
/// Ortega and Rheinboldt, "Iterative Solution of Nonlinear Equations in Several Variables", 1970
/// (a map that differs from the identity by a contraction is one to one).
/// Differs: shares no code with the production search. A cell is dropped if its control points, as
/// they are or solved for the parameters, lie on one side of the line beyond all rounding. It has
/// at most one root if the control points of its Jacobian, so solved, differ from the identity by
/// less than 9/10. Cells that double precision cannot decide are subdivided again in 113 bits.
/// Conventions: the line is the whole line of the ray. Roots ascend in t. A root within 2^-85 of a
/// side of its patch counts as on it.
/// Complexity: about 0.1 ms for a ray and a model of thirty patches.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/ray.h"
#include "alhazen/math/real128.h"
#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

struct ExactPatchRoot {
    Real128 t = 0, u = 0, v = 0;
    std::uint32_t patch = 0;
    double slope = 0;      ///< tangent of the angle between line and normal
    bool on_side = false;  ///< on a side of the patch
};

struct ExactPatchRoots {
    std::vector<ExactPatchRoot> roots;
    /// Cells that 113 bits do not decide: the line meets an edge that is a point, or is tangent.
    int undecided = 0;
};

[[nodiscard]] ExactPatchRoots exact_patch_roots(std::span<const BezierNet> nets, const Ray& ray);

}  // namespace alhazen

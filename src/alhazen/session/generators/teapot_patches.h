#pragma once
/// Control points of Newell's teapot, as 32 bicubic Bezier patches. Stored are profiles of the
/// surfaces of revolution and one half of handle and spout, which is mirrored.
///
/// Source: Newell, "The Utilization of Procedure Models in Digital Image Synthesis", 1975; the
/// points as printed by Crow, "The Origins of the Teapot", IEEE CG&A 7(1), 1987, with the later
/// bottom.
/// Conventions: z is up, the bottom lies in z = 0, the rim at 2.4, the spout towards +x. Rows of a
/// patch of a surface of revolution go down its profile. Seen from outside, u x v points inward.

#include <array>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// Row by row: the first index is that of u.
using TeapotPatch = std::array<std::array<Vec3, 4>, 4>;

/// Rim (4 patches), body (8), handle (4), spout (4), lid (8), bottom (4).
[[nodiscard]] std::vector<TeapotPatch> teapot_patches();

/// Points and normals of a patch on a lattice of parameters.
struct PatchGrid {
    int side = 0;                       ///< cells per side
    std::vector<Vec3> points, normals;  ///< [u * (side + 1) + v]
    [[nodiscard]] std::size_t at(int u, int v) const {
        return static_cast<std::size_t>(u) * static_cast<std::size_t>(side + 1) +
               static_cast<std::size_t>(v);
    }
};

/// Evaluates a patch; unit normals point out of the pot, and up or down where the patch is
/// degenerate (its rows converge to a point).
[[nodiscard]] PatchGrid evaluate(const TeapotPatch& patch, int cells);

}  // namespace alhazen

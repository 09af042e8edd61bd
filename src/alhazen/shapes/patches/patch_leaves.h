#pragma once
/// The parts that patches are divided into when they are prepared: domains small enough that
/// Newton's method converges for most lines, with the bounds that tell for which.
///
/// Source: Barth and Stuerzlinger, "Efficient Ray Tracing for Bezier and B-Spline Surfaces",
/// Computers & Graphics 17(4), 1993 (parallelepipeds around parts of a patch, the first step of
/// Newton's method from their axes).
/// Conventions: leaves are in the frame of their tree: (p - center) * scale. A leaf's own
/// parameters are from -1 to 1. One leaf for each part of the unit square, which they tile.

#include <cstdint>
#include <vector>

#include "alhazen/geometry/box.h"
#include "alhazen/shapes/patches/patch_borders.h"

namespace alhazen {

/// A part of a patch around the plane center + a du + b dv, with n = du x dv. The sum of second
/// derivatives |S_aa| + 2 |S_ab| + |S_bb|, written as x du + y dv + z n, has x, y and z at most
/// `bend`; the distance from the plane's point at (a, b) has at most half of them. Without a plane,
/// du and dv are zero: neither certified nor rejected for any line.
struct PatchLeaf {
    float center[3], du[3], dv[3], bend[3];
    std::uint32_t piece;
    std::uint8_t u, v;  ///< the cell: [u, u + 1] / 2^level_u
    std::uint8_t level_u, level_v;

    [[nodiscard]] PatchCell cell() const {
        const double width_u = 1.0 / (1 << level_u), width_v = 1.0 / (1 << level_v);
        return {u * width_u, (u + 1) * width_u, v * width_v, (v + 1) * width_v};
    }
    void set_without_plane() {
        for (int k = 0; k < 3; ++k) du[k] = dv[k] = bend[k] = 0.0f;
    }
};
static_assert(sizeof(PatchLeaf) == 56);

/// The frame of a tree: its box becomes about [-1, 1].
struct PatchFrame {
    Vec3 center;
    double scale = 1;
};

/// Divides a patch; appends its leaves, and boxes in the frame that contain them.
void append_leaves(const BezierNet& net, std::uint32_t piece, const PatchFrame& frame,
                   std::vector<PatchLeaf>& leaves, std::vector<Box3>& boxes);

}  // namespace alhazen

#pragma once
/// The leaves into which patches are divided in preparation: domains small enough that Newton's
/// method converges for most lines, with the bounds that decide for which.
///
/// Source: Barth and Stuerzlinger, "Efficient Ray Tracing for Bezier and B-Spline Surfaces",
/// Computers & Graphics 17(4), 1993 (parallelepipeds around parts of a patch, the first step of
/// Newton's method from their axes).
/// Conventions: leaves are in the frame of their tree: (p - center) * scale. A leaf's own
/// parameters run from -1 to 1. The leaves of a patch tile the unit square.

#include <bit>
#include <cstdint>
#include <vector>

#include "alhazen/geometry/box.h"
#include "alhazen/shapes/patches/patch_borders.h"

namespace alhazen {

/// A part of a patch near the plane center + a du + b dv, with n = du x dv. The sum of the second
/// derivatives |S_aa| + 2 |S_ab| + |S_bb|, written as x du + y dv + z n, has x, y and z at most
/// `bend`; the displacement from the plane's point at (a, b) has at most half of them. A leaf
/// without a plane has zero du and dv: it is neither certified nor rejected for any line.
struct PatchLeaf {
    float center[3];
    std::int16_t du[3], dv[3];  ///< times 2^exponent_u and 2^exponent_v
    std::uint16_t bend[3];      ///< the upper halves of floats
    std::int8_t exponent_u, exponent_v;
    std::uint8_t u, v;  ///< the cell: [u, u + 1] / 2^level_u
    std::uint8_t level_u : 4, level_v : 4;
    std::uint32_t piece;

    [[nodiscard]] PatchCell cell() const {
        const double width_u = power_of_two(-level_u), width_v = power_of_two(-level_v);
        return {u * width_u, (u + 1) * width_u, v * width_v, (v + 1) * width_v};
    }
    [[nodiscard]] Vec3 middle() const { return {center[0], center[1], center[2]}; }
    [[nodiscard]] double unit_u() const { return power_of_two(exponent_u); }
    [[nodiscard]] double unit_v() const { return power_of_two(exponent_v); }
    [[nodiscard]] Vec3 by_u() const {
        return unit_u() * Vec3{double(du[0]), double(du[1]), double(du[2])};
    }
    [[nodiscard]] Vec3 by_v() const {
        return unit_v() * Vec3{double(dv[0]), double(dv[1]), double(dv[2])};
    }
    /// Upper bound of the length of du (or dv), at most four times it.
    [[nodiscard]] double most_u() const { return kMostLength * unit_u(); }
    [[nodiscard]] double most_v() const { return kMostLength * unit_v(); }
    [[nodiscard]] double most_bend(int k) const {
        return std::bit_cast<float>(std::uint32_t{bend[k]} << 16);
    }

    static constexpr int kMost = 1 << 14;  ///< largest of the numbers in du and dv
    static constexpr double kMostLength = 1.7321 * kMost;

  private:
    static double power_of_two(int exponent) {
        return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52);
    }
};
static_assert(sizeof(PatchLeaf) == 40);

/// The frame of a tree, in which its box is about [-1, 1].
struct PatchFrame {
    Vec3 center;
    double scale = 1;
};

/// Divides a patch; appends its leaves, and boxes in the frame that bound them.
void append_leaves(const BezierNet& net, std::uint32_t piece, const PatchFrame& frame,
                   std::vector<PatchLeaf>& leaves, std::vector<Box3>& boxes);

}  // namespace alhazen

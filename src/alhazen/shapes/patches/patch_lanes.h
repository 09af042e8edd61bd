#pragma once
/// The parts of the search for a line's crossings with patches that run in lanes: the walk through
/// the boxes, and values of bicubic patches.
///
/// Conventions: internal to PatchIndex. Every target gives the same bits.

#include <cstdint>

#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/shapes/patches/certified_cells.h"
#include "alhazen/shapes/patches/patch_borders.h"
#include "alhazen/shapes/patches/patch_boxes.h"
#include "alhazen/shapes/patches/patch_leaves.h"
#include "alhazen/shapes/patches/patch_value.h"

namespace alhazen {

/// A line on its way through a tree of boxes, nearest boxes first.
struct PatchWalk {
    struct Waiting {
        float near;
        std::uint32_t child;
    };
    // The tree has at most some 18 levels, each of which leaves seven children.
    static constexpr int kMostWaiting = 160;

    float from[3], inverse[3];  ///< in the frame; 1 / direction
    float least, most;          ///< the range along the line
    int size;
    Waiting stack[kMostWaiting];
};

/// Lines side by side on their way through a tree of boxes together. The directions have the same
/// signs.
struct alignas(64) PatchPacket {
    double origin[3][kRayLanes], direction[3][kRayLanes];  ///< in the frame
    float most_of[kRayLanes];                              ///< the range along each line ends here
    float from[2][3], inverse[2][3];                       ///< least and most of PatchWalk's
    PatchWalk walk;                                        ///< the range of all; no origin
};

/// Bounds of a cell by its control points.
struct CellBounds {
    double least[3], most[3];          ///< of x, y and along `aside`
    PlanePoint f, f_u, f_v;            ///< value and derivatives at the middle, in half-widths
    double bend_u[3], bend_v[3];       ///< |second differences| by uu, uv, vv, solved for u and v
    double size_uu, size_uv, size_vv;  ///< |second differences|
    double extent_u, extent_v;         ///< |first differences|
};

struct PatchKernels {
    /// The next leaf whose box the line passes through; false at the end.
    bool (*next_leaf)(const PatchBoxes* nodes, PatchWalk& walk, std::uint32_t& leaf);
    /// Sets out eight rays; false where the signs of their directions differ. Farther than `far`
    /// from the middle a line begins at the point nearest to it.
    bool (*begin_packet)(const RayLanes& rays, const PatchFrame& frame, double far,
                         PatchPacket& packet);
    /// The same for a packet, nearest first; `near` is where the first line enters the box.
    bool (*next_leaf_of_packet)(const PatchBoxes* nodes, PatchPacket& packet, std::uint32_t& leaf,
                                float& near);
    /// The lines for which `test_leaf` has another answer than None, and hardly any others.
    std::uint32_t (*lines_near)(const PatchLeaf& leaf, const PatchPacket& packet);
    /// For bicubic patches.
    HomogeneousValue (*bicubic)(BezierView net, double u, double v);
    /// Only `least` and `most` where these leave out the origin by more than `margin`.
    void (*cubic_bounds)(const PlaneNet& net, double margin, CellBounds& out);
    /// `low` may be `net`.
    void (*halve_cubic)(const PlaneNet& net, bool along_u, PlaneNet& low, PlaneNet& high);
    /// The control points over a cell, to some roundings.
    void (*cubic_part)(const PlaneNet& whole, const PatchCell& cell, PlaneNet& part);
};
[[nodiscard]] const PatchKernels& patch_kernels();

}  // namespace alhazen

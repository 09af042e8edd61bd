#pragma once
/// The parts of the search for a line's crossings with patches that run in lanes: the walk through
/// the boxes, and values of bicubic patches.
///
/// Conventions: internal to PatchIndex. Every target gives the same bits.

#include <cstdint>

#include "alhazen/shapes/patches/patch_boxes.h"
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

struct PatchKernels {
    /// The next leaf whose box the line passes through; false at the end.
    bool (*next_leaf)(const PatchBoxes* nodes, PatchWalk& walk, std::uint32_t& leaf);
    HomogeneousValue (*bicubic)(const BezierNet& net, double u, double v);
};
[[nodiscard]] const PatchKernels& patch_kernels();

}  // namespace alhazen

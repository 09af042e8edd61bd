#pragma once
/// A tree of boxes with sixteen children to a node, for the leaves of patches.
///
/// Source: Wald, Benthin and Boulos, "Getting Rid of Packets", IEEE Symposium on Interactive Ray
/// Tracing, 2008 (wide nodes); surface area heuristic in bins: Wald, "On Fast Construction of SAH
/// based Bounding Volume Hierarchies", 2007.
/// Conventions: boxes are in the frame of PatchFrame, grown by kBoxMargin for all rounding of rays
/// in single precision. Packets meet boxes that none of their lines meets, empty ones, too: unused
/// children are marked. Node 0 is the root.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/box.h"

namespace alhazen {

inline constexpr int kBoxChildren = 16;
inline constexpr std::uint32_t kLeafChild = 0x80000000u;
inline constexpr double kBoxMargin = 0x1p-18;

/// Planes of boxes are at from + byte * step, rounded outward.
struct PatchBoxes {
    float from[3], step[3];
    std::uint8_t planes[2][3][kBoxChildren];  ///< lo and hi
    std::uint32_t child[kBoxChildren];        ///< a node, or kLeafChild | place in the order
    std::uint32_t used;                       ///< bits of the children that there are
};
static_assert(sizeof(PatchBoxes) == 188);

/// Builds the tree; `order` receives the boxes' numbers in the order of the tree.
[[nodiscard]] std::vector<PatchBoxes> make_patch_boxes(std::span<const Box3> boxes,
                                                       std::vector<std::uint32_t>& order);

}  // namespace alhazen

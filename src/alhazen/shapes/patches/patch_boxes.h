#pragma once
/// A bounding volume hierarchy with sixteen children per node, over the leaves of patches.
///
/// Source: Wald, Benthin and Boulos, "Getting Rid of Packets", IEEE Symposium on Interactive Ray
/// Tracing, 2008 (wide nodes); surface area heuristic in bins: Wald, "On Fast Construction of SAH
/// based Bounding Volume Hierarchies", 2007.
/// Conventions: boxes are in the frame of PatchFrame, grown by kBoxMargin for the rounding of rays
/// in single precision. Packets may visit boxes that none of their lines meets, even empty ones:
/// unused children are marked. Node 0 is the root.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/box.h"

namespace alhazen {

inline constexpr int kBoxChildren = 16;
inline constexpr std::uint32_t kLeafChild = 0x80000000u;
inline constexpr double kBoxMargin = 0x1p-18;

/// A node with quantised boxes: planes are at from + byte * step, rounded outward.
struct PatchBoxes {
    float from[3], step[3];
    std::uint8_t planes[2][3][kBoxChildren];  ///< lo and hi
    std::uint32_t child[kBoxChildren];        ///< a node, or kLeafChild | position in the order
    std::uint32_t used;                       ///< bits of the existing children
};
static_assert(sizeof(PatchBoxes) == 188);

/// Builds the tree; `order` receives the indices of the boxes in the order of the tree.
[[nodiscard]] std::vector<PatchBoxes> make_patch_boxes(std::span<const Box3> boxes,
                                                       std::vector<std::uint32_t>& order);

}  // namespace alhazen

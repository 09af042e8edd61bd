#pragma once
/// A tree of boxes with eight children to a node, for the leaves of patches.
///
/// Source: Wald, Benthin and Boulos, "Getting Rid of Packets", IEEE Symposium on Interactive Ray
/// Tracing, 2008 (wide nodes); surface area heuristic in bins: Wald, "On Fast Construction of SAH
/// based Bounding Volume Hierarchies", 2007.
/// Conventions: boxes are in the frame of PatchFrame, grown by kBoxMargin for all rounding of rays
/// in single precision. Unused children have empty boxes. Node 0 is the root.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/box.h"

namespace alhazen {

inline constexpr int kBoxChildren = 8;
inline constexpr std::uint32_t kLeafChild = 0x80000000u;
inline constexpr float kBoxMargin = 0x1p-19f;

struct alignas(32) PatchBoxes {
    float lo[3][kBoxChildren], hi[3][kBoxChildren];
    std::uint32_t child[kBoxChildren];  ///< a node, or kLeafChild | place in the order
};

/// Builds the tree; `order` receives the boxes' numbers in the order of the tree.
[[nodiscard]] std::vector<PatchBoxes> make_patch_boxes(std::span<const Box3> boxes,
                                                       std::vector<std::uint32_t>& order);

}  // namespace alhazen

#include "alhazen/scene/wide_bvh_check.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "alhazen/scene/leaf_bounds.h"

namespace alhazen {
namespace {

bool leads_to_leaf(const WideBvhLayout& layout, NodeRef ref) {
    const auto lies_in = [&](const auto& array) {
        return std::size_t{ref.offset()} + ref.count() <= array.size();
    };
    switch (static_cast<LeafType>(ref.kind())) {
        case LeafType::Triangles:
            return layout.is_indexed() ? lies_in(layout.indices) : lies_in(layout.triangles);
        case LeafType::Spheres:
            return lies_in(layout.spheres);
        case LeafType::Frustums:
            return lies_in(layout.frustums);
        case LeafType::Others:
            return lies_in(layout.others);
    }
    return false;
}

/// A slot that no ray enters.
bool is_free(const WideNode& node, std::size_t slot) {
    return node.box(slot) == FloatBox{};
}

/// Every octant's order names every slot once.
bool is_ordered(const WideNode& node) {
    for (const std::uint32_t order : node.order) {
        std::uint32_t seen = order >> 24;
        for (std::uint32_t i = 0; i < kWideNodeWidth; ++i) seen |= 1u << (order >> 3 * i & 7);
        if (seen != (1u << kWideNodeWidth) - 1 || order >> 24 != 0) return false;
    }
    return true;
}

/// A frame as one is made for some box: rays in it are then what the kernels expect.
bool is_sound(const LocalFrame& frame) {
    const double reach = max_component(abs(frame.center));
    return is_finite(frame.center) && reach <= 2e150 && frame.scale >= 0x1p-502 &&
           frame.scale <= 0x1p502 && frame.scale == std::ldexp(1.0, std::ilogb(frame.scale)) &&
           frame.inverse_scale == 1.0 / frame.scale && frame.offset == reach * frame.scale &&
           frame.offset <= 0x1p32 && frame.usual == LocalFrame::is_usual(frame.scale) &&
           frame.slack == FrameSlack(frame.offset, frame.usual);
}

const char* check_nodes(const WideBvhLayout& layout) {
    const WideBvh& tree = layout.tree;
    if (tree.empty) return nullptr;
    if (tree.root.is_leaf()) {
        return leads_to_leaf(layout, tree.root) ? nullptr : "the root leads out of the leaves";
    }
    if (tree.root.index() >= tree.nodes.size()) return "the root leads out of the nodes";
    std::vector<std::uint8_t> depth(tree.nodes.size(), 0);  // 0: not met so far
    depth[tree.root.index()] = 1;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const WideNode& node = tree.nodes[i];
        if (!is_ordered(node)) return "the order of some children is none";
        bool ended = false;
        for (std::size_t slot = 0; slot < kWideNodeWidth; ++slot) {
            const NodeRef child = node.child[slot];
            if (is_free(node, slot)) {
                ended = true;
                continue;
            }
            // Who counts the slots takes the first ones.
            if (ended) return "a node has a free slot before one in use";
            if (child.is_leaf()) {
                if (!leads_to_leaf(layout, child)) return "a node leads out of the leaves";
                continue;
            }
            if (child.index() >= tree.nodes.size()) return "a node leads out of the nodes";
            if (child.index() <= i || depth[child.index()] != 0 || depth[i] == 0) {
                return "the nodes make no tree";
            }
            if (depth[i] >= kMaxWideDepth) return "the tree is too deep";
            depth[child.index()] = static_cast<std::uint8_t>(depth[i] + 1);
        }
    }
    return nullptr;
}

/// The lanes in use are the first, and hold primitives of the kind.
bool names_kind(const PrimitiveTable& table, const BlockId (&ids)[kBlockWidth], LeafType kind) {
    bool ended = false;
    for (const BlockId id : ids) {
        const bool fits = static_cast<std::uint32_t>(id.id()) < table.size() &&
                          may_be_in(kind, table.kind(id.id()));
        if (id.used() && (ended || !fits)) return false;
        ended = ended || !id.used();
    }
    return true;
}
template <class Block>
bool is_sound(const PrimitiveTable& table, const Block& block, LeafType kind) {
    if constexpr (requires { block.lanes; }) {
        const std::uint32_t used = used_lanes(block);
        if (used == 0 || block.lanes != (1u << used) - 1) return false;
    }
    return names_kind(table, block.ids, kind);
}

const char* check_leaves(const WideBvhLayout& layout, const PrimitiveTable& table) {
    constexpr const char* kMessage = "a leaf has a gap or names a primitive that is not there";
    const auto all_sound = [&](const auto& blocks, LeafType kind) {
        return std::all_of(blocks.begin(), blocks.end(),
                           [&](const auto& block) { return is_sound(table, block, kind); });
    };
    const bool sound = all_sound(layout.triangles, LeafType::Triangles) &&
                       all_sound(layout.indices, LeafType::Triangles) &&
                       all_sound(layout.spheres, LeafType::Spheres) &&
                       all_sound(layout.frustums, LeafType::Frustums) &&
                       all_sound(layout.others, LeafType::Others);
    return sound ? nullptr : kMessage;
}

}  // namespace

const char* find_unsound(const WideBvhLayout& layout, const PrimitiveTable& table) {
    if (!is_sound(layout.frame)) return "its frame is none";
    if (const char* message = check_nodes(layout)) return message;
    return check_leaves(layout, table);
}

}  // namespace alhazen

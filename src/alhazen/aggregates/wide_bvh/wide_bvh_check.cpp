#include "alhazen/aggregates/wide_bvh/wide_bvh_check.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"

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
template <std::size_t W>
bool is_free(const WideNodeOf<W>& node, std::size_t slot) {
    return node.box(slot) == FloatBox{};
}

/// True if every octant's order names every slot once.
template <std::size_t W>
bool is_ordered(const WideNodeOf<W>& node) {
    constexpr std::uint32_t kBits = WideNodeOf<W>::kSlotBits;
    for (const std::uint64_t order : node.order) {
        std::uint32_t seen = 0;
        for (std::uint32_t i = 0; i < W; ++i) seen |= 1u << (order >> kBits * i & (W - 1));
        if (seen != (1u << W) - 1) return false;
        if (W * kBits < 64 && order >> (W * kBits) % 64 != 0) return false;
    }
    return true;
}

/// True if the frame could have been made for some box, as the kernels require.
bool is_sound(const LocalFrame& frame) {
    const double reach = max_component(abs(frame.center));
    return is_finite(frame.center) && reach <= 2e150 && frame.scale >= 0x1p-502 &&
           frame.scale <= 0x1p502 && frame.scale == std::ldexp(1.0, std::ilogb(frame.scale)) &&
           frame.inverse_scale == 1.0 / frame.scale && frame.offset == reach * frame.scale &&
           frame.offset <= 0x1p32 && frame.usual == LocalFrame::is_usual(frame.scale) &&
           frame.slack == FrameSlack(frame.offset, frame.usual);
}

/// What is wrong with the children of the node with index `index` of `count`. Sets the depth of
/// inner ones (0: not reached so far).
template <std::size_t W>
const char* check_children(const WideBvhLayout& layout, const WideNodeOf<W>& node,
                           std::size_t index, std::vector<std::uint8_t>& depth) {
    bool ended = false;
    for (std::size_t slot = 0; slot < W; ++slot) {
        const NodeRef child = node.child[slot];
        if (is_free(node, slot)) {
            ended = true;
            continue;
        }
        // Traversal takes the first slots as those in use.
        if (ended) return "a node has a free slot before one in use";
        if (child.is_leaf()) {
            if (!leads_to_leaf(layout, child)) return "a node leads out of the leaves";
            continue;
        }
        if (child.index() >= depth.size()) return "a node leads out of the nodes";
        if (child.index() <= index || depth[child.index()] != 0 || depth[index] == 0) {
            return "the nodes make no tree";
        }
        if (depth[index] >= kMaxWideDepth) return "the tree is too deep";
        depth[child.index()] = static_cast<std::uint8_t>(depth[index] + 1);
    }
    return nullptr;
}

const char* check_nodes(const WideBvhLayout& layout) {
    const WideBvh& tree = layout.tree;
    if (tree.empty) return nullptr;
    if (tree.root.is_leaf()) {
        return leads_to_leaf(layout, tree.root) ? nullptr : "the root leads out of the leaves";
    }
    return with_nodes(tree, [&](const auto& nodes) -> const char* {
        if (tree.root.index() >= nodes.size()) return "the root leads out of the nodes";
        std::vector<std::uint8_t> depth(nodes.size(), 0);
        depth[tree.root.index()] = 1;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (!is_ordered(nodes[i])) return "the order of some children is none";
            if (const char* message = check_children(layout, nodes[i], i, depth)) return message;
        }
        return nullptr;
    });
}

/// True if the used lanes are the first and hold primitives of the kind.
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
/// True if the bits of spheres and cylinders are those of the kinds: the queries rely on them.
bool tells_kinds(const PrimitiveTable& table, const FrustumBlock& block) {
    std::uint32_t balls = 0, cylinders = 0;
    for (std::uint32_t lane = 0; lane < used_lanes(block); ++lane) {
        const std::uint32_t kind = table.kind(block.ids[lane].id());
        balls |= std::uint32_t{kind == column_of<Sphere>()} << lane;
        cylinders |= std::uint32_t{kind == column_of<Cylinder>()} << lane;
    }
    return block.balls == balls && block.certain == (balls | cylinders);
}
template <class Block>
bool is_sound(const PrimitiveTable& table, const Block& block, LeafType kind) {
    if constexpr (requires { block.lanes; }) {
        const std::uint32_t used = used_lanes(block);
        if (used == 0 || block.lanes != (1u << used) - 1) return false;
    }
    if (!names_kind(table, block.ids, kind)) return false;
    if constexpr (requires { block.balls; }) return tells_kinds(table, block);
    return true;
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

const char* first_violation(const WideBvhLayout& layout, const PrimitiveTable& table) {
    if (!is_sound(layout.frame)) return "its frame is none";
    if (const char* message = check_nodes(layout)) return message;
    return check_leaves(layout, table);
}

}  // namespace alhazen

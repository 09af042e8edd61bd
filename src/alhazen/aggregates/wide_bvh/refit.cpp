#include "alhazen/aggregates/wide_bvh/refit.h"

#include <cmath>
#include <vector>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_fill.h"
#include "alhazen/base/error.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {
namespace {

constexpr std::size_t kRefitGrain = 1024;  // nodes per task

template <std::uint32_t kWidth>
class Refit {
    using Node = WideNodeOf<kWidth>;

  public:
    Refit(WideBvhLayout& layout, const PrimitiveTable& table)
        : layout_(layout), table_(table), nodes_(nodes_of<kWidth>(layout.tree).data()) {
        // Fetched once: data() may copy a mapped array.
        triangles_ = layout.triangles.data();
        indices_ = layout.is_indexed() ? layout.indices.data() : nullptr;
        spheres_ = layout.spheres.data();
        frustums_ = layout.frustums.data();
        others_ = layout.others.data();
    }

    void run() {
        const NodeRef root = layout_.tree.root;
        if (root.is_leaf()) {
            (void)refit_leaf(root);
            return;
        }
        const std::size_t count = nodes_of<kWidth>(std::as_const(layout_.tree)).size();
        parallel_for(count, kRefitGrain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n) refit_leaves(nodes_[n]);
        });
        // Children follow their parents.
        for (std::size_t n = count; n-- > 0;) refit_inner(nodes_[n]);
        parallel_for(count, kRefitGrain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n) nodes_[n].set_order();
        });
    }

  private:
    void refit_leaves(Node& node) {
        const std::uint32_t count = node.child_count();
        for (std::uint32_t i = 0; i < count; ++i) {
            if (node.child[i].is_leaf()) node.set_box(i, refit_leaf(node.child[i]));
        }
    }
    void refit_inner(Node& node) {
        const std::uint32_t count = node.child_count();
        for (std::uint32_t i = 0; i < count; ++i) {
            if (node.child[i].is_leaf()) continue;
            const Node& child = nodes_[node.child[i].index()];
            FloatBox box;
            const std::uint32_t inner_count = child.child_count();
            for (std::uint32_t k = 0; k < inner_count; ++k) box.include(child.box(k));
            node.set_box(i, box);
        }
    }

    FloatBox refit_leaf(NodeRef leaf) {
        FloatBox box;
        switch (static_cast<LeafType>(leaf.kind())) {
            case LeafType::Triangles:
                if (indices_ != nullptr) {
                    refit_blocks(indices_ + leaf.offset(), leaf.count(), box);
                } else {
                    refit_blocks(triangles_ + leaf.offset(), leaf.count(), box);
                }
                break;
            case LeafType::Spheres:
                refit_blocks(spheres_ + leaf.offset(), leaf.count(), box);
                break;
            case LeafType::Frustums:
                refit_blocks(frustums_ + leaf.offset(), leaf.count(), box);
                break;
            case LeafType::Others:
                refit_blocks(others_ + leaf.offset(), leaf.count(), box);
                break;
        }
        return box;
    }
    template <class Block>
    void refit_blocks(Block* block, std::uint32_t count, FloatBox& box) const {
        for (const Block* end = block + count; block < end; ++block) {
            std::array<PrimitiveId, kBlockWidth> ids;
            std::size_t used = 0;
            for (const BlockId id : block->ids) {
                if (id.used()) ids[used++] = id.id();
            }
            for (std::size_t i = 0; i < used; ++i) include(box, ids[i]);
            fill_block(*block, std::span(ids).first(used), table_, layout_.frame);
        }
    }
    void include(FloatBox& box, PrimitiveId id) const {
        const Box3 its = table_.box(static_cast<std::uint32_t>(id));
        box.include(its.empty() ? point_of(id) : layout_.frame.local(its));
    }
    /// The box of a primitive that cannot be hit: a point within the frame, near its vertices.
    [[nodiscard]] FloatBox point_of(PrimitiveId id) const {
        FloatBox point;
        Vec3 p{};
        if (table_.kind(id) == kTriangleKind) {
            p = layout_.frame.local(table_.triangle_vertices(table_.index(id))[0]);
        }
        for (int k = 0; k < 3; ++k) {
            // Written so that NaN becomes 0.
            const double x = std::abs(p[k]) <= 1 ? p[k] : p[k] > 0 ? 1.0 : p[k] < 0 ? -1.0 : 0.0;
            point.lo[k] = point.hi[k] = static_cast<float>(x);
        }
        return point;
    }

    WideBvhLayout& layout_;
    const PrimitiveTable& table_;
    Node* nodes_;
    TriangleBlock* triangles_;
    IndexBlock* indices_;  ///< null if triangles are in `triangles_`
    SphereBlock* spheres_;
    FrustumBlock* frustums_;
    BoxBlock* others_;
};

/// Throws Error(Usage) unless the tree holds exactly the primitives that have bounds.
void check(const WideBvhLayout& layout, const PrimitiveTable& moved,
           const BoundedPrimitives& bounded) {
    std::vector<bool> in_tree(moved.size(), false);
    bool known = true;
    const auto note = [&](PrimitiveId id) {
        const auto i = static_cast<std::uint32_t>(id);
        known = known && i < moved.size();
        if (known) in_tree[i] = true;
    };
    const auto note_blocks = [&](const auto& blocks) {
        for (const auto& block : blocks) {
            for (const BlockId id : block.ids) {
                if (id.used()) note(id.id());
            }
        }
    };
    note_blocks(layout.triangles);
    note_blocks(layout.indices);
    note_blocks(layout.spheres);
    note_blocks(layout.frustums);
    note_blocks(layout.others);
    for (std::size_t i = 0; known && i < bounded.size(); ++i) known = in_tree[bounded.id(i)];
    for (const PrimitiveId id : bounded.unbounded()) {
        known = known && !in_tree[static_cast<std::uint32_t>(id)];
    }
    if (!known) {
        throw Error(ErrorKind::Usage,
                    "the set of bounded primitives has changed; build the tree anew");
    }
}

}  // namespace

void refit(WideBvhLayout& layout, const PrimitiveTable& moved, const BoundedPrimitives& bounded) {
    check(layout, moved, bounded);
    if (layout.tree.empty) return;
    layout.frame = LocalFrame(box_of_bounded(bounded));
    if (layout.tree.width == 4) return Refit<4>(layout, moved).run();
    if (layout.tree.width == 16) return Refit<16>(layout, moved).run();
    Refit<8>(layout, moved).run();
}

}  // namespace alhazen

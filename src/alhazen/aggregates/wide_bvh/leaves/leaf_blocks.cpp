#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"

#include <algorithm>

#include "alhazen/accel/wide_bvh/build/binary_builder.h"
#include "alhazen/accel/wide_bvh/build/clustering.h"
#include "alhazen/accel/wide_bvh/build/reinsertion.h"
#include "alhazen/accel/wide_bvh/build/sah_cost.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_fill.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_splitter.h"
#include "alhazen/base/error.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/primitives/bounded_primitives.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {
namespace {

/// Costs in visits of a wide node, measured.
constexpr LeafKinds kLeafKindTable{LeafKind{3, 1.5f}, LeafKind{3, 1.5f}, LeafKind{3, 1.5f},
                                   LeafKind{3, 1.5f}};
static_assert(1u << kLeafKindTable[0].width_log2 == kBlockWidth);

/// Copies primitives into blocks, leaf by leaf.
class Packer final : public LeafSink {
  public:
    Packer(const PrimitiveTable& table, Leaves leaves, WideBvhLayout& layout)
        : table_(table), leaves_(leaves), layout_(layout) {}

    void resize(const std::array<std::size_t, kLeafKinds>& blocks) override {
        const std::size_t triangles = blocks[static_cast<std::size_t>(LeafType::Triangles)];
        if (leaves_ == Leaves::Indices) {
            layout_.indices.resize(triangles);
        } else {
            layout_.triangles.resize(triangles);
        }
        layout_.spheres.resize(blocks[static_cast<std::size_t>(LeafType::Spheres)]);
        layout_.frustums.resize(blocks[static_cast<std::size_t>(LeafType::Frustums)]);
        layout_.others.resize(blocks[static_cast<std::size_t>(LeafType::Others)]);
    }

    float pack(std::uint32_t kind, std::size_t offset,
               std::span<const BuildReference> references) override {
        std::array<PrimitiveId, kBlockWidth * NodeRef::kMaxBlocks> sorted;
        const std::span ids = std::span(sorted).first(references.size());
        std::transform(references.begin(), references.end(), ids.begin(),
                       [](const BuildReference& r) { return PrimitiveId{r.id}; });
        std::sort(ids.begin(), ids.end());
        fill(static_cast<LeafType>(kind), offset, ids);
        float surface = 0;
        for (const PrimitiveId id : ids) surface += surface_of(id);
        return surface;
    }

  private:
    void fill(LeafType kind, std::size_t offset, std::span<const PrimitiveId> ids) const {
        switch (kind) {
            case LeafType::Triangles:
                if (leaves_ == Leaves::Vertices) prefetch_triangles(ids);
                return leaves_ == Leaves::Indices ? fill_blocks(&layout_.indices[offset], ids)
                                                  : fill_blocks(&layout_.triangles[offset], ids);
            case LeafType::Spheres:
                return fill_blocks(&layout_.spheres[offset], ids);
            case LeafType::Frustums:
                return fill_blocks(&layout_.frustums[offset], ids);
            case LeafType::Others:
                return fill_blocks(&layout_.others[offset], ids);
        }
    }
    /// What lets light through may end a query or not.
    [[nodiscard]] float surface_of(PrimitiveId id) const {
        const double unit = layout_.frame.scale * layout_.frame.scale;
        const double area = surface_area(table_, id) * unit;
        return static_cast<float>(table_.is_opaque(id) ? area : 0.5 * area);
    }

    /// Triangles lie about in memory as seen from a leaf: all of a leaf are on their way before the
    /// first is looked at.
    void prefetch_triangles(std::span<const PrimitiveId> ids) const {
        for (const PrimitiveId id : ids) {
            __builtin_prefetch(table_.triangle_corners(table_.index(id)));
        }
        for (const PrimitiveId id : ids) {
            for (const Vec3* corner : table_.corner_positions(table_.index(id))) {
                __builtin_prefetch(corner);
            }
        }
    }

    template <class Block>
    void fill_blocks(Block* block, std::span<const PrimitiveId> ids) const {
        for (std::size_t i = 0; i < ids.size(); i += kBlockWidth, ++block) {
            fill_block(*block, ids.subspan(i, std::min(kBlockWidth, ids.size() - i)), table_,
                       layout_.frame);
        }
    }

    const PrimitiveTable& table_;
    Leaves leaves_;
    WideBvhLayout& layout_;
};

constexpr std::size_t kGrain = 16384;

}  // namespace

Box3 box_of_bounded(const BoundedPrimitives& bounded) {
    if (bounded.unbounded().empty()) return bounded.all();
    std::vector<Box3> parts((bounded.size() + kGrain - 1) / kGrain);
    parallel_for(bounded.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) parts[begin / kGrain].include(bounded.box(i));
    });
    Box3 box;
    for (const Box3& part : parts) box.include(part);
    return box;
}

namespace {

BinaryBvh build_binary_of(BuildQuality quality, std::vector<BuildReference>& references,
                          const LocalFrame& frame, const PrimitiveTable& table) {
    if (quality == BuildQuality::Fast) return build_by_clustering(references, kLeafKindTable);
    if (quality == BuildQuality::Default) return build_binary(references, kLeafKindTable);
    const TriangleSplitter splitter(table, frame);
    DraftBvh draft =
        draft_of(build_with_spatial_splits(references, kLeafKindTable, splitter), kLeafKindTable);
    reinsert(draft);
    return linearize(draft, references);
}

}  // namespace

WideBvhLayout build_wide_bvh(const PrimitiveTable& table, const BoundedPrimitives& bounded,
                             const BuildOptions& options) {
    if (table.size() > BlockId::kLimit) {
        throw Error(ErrorKind::Resource, "too many primitives for one wide BVH");
    }
    check_node_width(options.width);
    WideBvhLayout layout;
    layout.frame = LocalFrame(box_of_bounded(bounded));
    std::vector<BuildReference> references(bounded.size());
    parallel_for(bounded.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t id = bounded.id(i);
            references[i] = {layout.frame.local(bounded.box(i)), id,
                             static_cast<std::uint32_t>(leaf_type(table, PrimitiveId{id}))};
        }
    });
    const BinaryBvh binary = build_binary_of(options.quality, references, layout.frame, table);
    Packer packer(table, options.leaves, layout);
    const std::uint32_t width = options.precision == Precision::Fast ? 8 : options.width;
    layout.tree = collapse(binary, references, kLeafKindTable, packer, width);
    return layout;
}

double WideBvhLayout::sah_cost() const {
    return alhazen::sah_cost(tree, kLeafKindTable);
}

std::size_t WideBvhLayout::memory_bytes() const {
    std::size_t bytes = 0;
    for_each_array(*this, [&](const auto& array) { bytes += array.capacity() * sizeof(array[0]); });
    return bytes;
}

}  // namespace alhazen

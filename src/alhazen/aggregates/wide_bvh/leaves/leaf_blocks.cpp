#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"

#include <algorithm>

#include "alhazen/accel/wide_bvh/build/binary_builder.h"
#include "alhazen/accel/wide_bvh/build/curve_builder.h"
#include "alhazen/accel/wide_bvh/build/morton_order.h"
#include "alhazen/accel/wide_bvh/build/reinsertion.h"
#include "alhazen/accel/wide_bvh/build/sah_cost.h"
#include "alhazen/aggregates/wide_bvh/leaves/build_references.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_writer.h"
#include "alhazen/aggregates/wide_bvh/leaves/table_curve.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_splitter.h"
#include "alhazen/base/discard_pages.h"
#include "alhazen/base/error.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/primitives/bounded_primitives.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {
namespace {

/// Costs in visits of a wide node, from measurements.
constexpr LeafKinds kLeafKindTable{LeafKind{3, 1.5f}, LeafKind{3, 1.5f}, LeafKind{3, 3.0f},
                                   LeafKind{3, 1.5f}};
static_assert(1u << kLeafKindTable[0].width_log2 == kBlockWidth);
static_assert(kBlockWidth == kCurveLeafSize);

constexpr std::size_t kGrain = 16384;
/// Bytes of references from which on their pages serve for the leaves.
constexpr std::size_t kLargeReferences = std::size_t{32} << 20;
/// Bytes of blocks a triangle, at most: 5 of 8 lanes in use. Meshes have 5.6; triangles that do not
/// touch have 4.1, and take memory of their own.
constexpr std::size_t kRoomOfTriangle = 64;

/// Copies primitives into blocks, leaf by leaf.
class Packer final : public LeafSink {
  public:
    explicit Packer(LeafWriter& writer) : writer_(writer) {}
    /// Leaves need only the ids of `references`: a large array loses its other values when the
    /// leaves are made, so that its pages serve for them. The system takes longer to provide a page
    /// that another process had. `room`: the number of blocks of triangles in whose memory the
    /// references are; 0: elsewhere.
    Packer(LeafWriter& writer, std::span<BuildReference> references, std::size_t room)
        : writer_(writer), room_(room) {
        if (references.size_bytes() >= kLargeReferences) large_ = references;
    }

    void resize(const std::array<std::size_t, kLeafKinds>& blocks) override {
        if (!large_.empty()) {
            keep_ids();
            const bool fits = blocks[static_cast<std::size_t>(LeafType::Triangles)] <= room_;
            if (!fits) discard_pages(large_.data(), large_.size_bytes());
        }
        writer_.resize(blocks);
    }
    float pack(std::uint32_t kind, std::size_t offset,
               std::span<const BuildReference> references) override {
        const std::size_t size = references.size();
        std::array<PrimitiveId, kBlockWidth * NodeRef::kMaxBlocks> sorted;
        const std::span ids = std::span(sorted).first(size);
        if (large_.empty()) {
            sort_ids(ids, [&](std::size_t i) { return references[i].id; });
        } else {
            const std::uint32_t* const kept = ids_.get() + (references.data() - large_.data());
            sort_ids(ids, [kept](std::size_t i) { return kept[i]; });
        }
        return writer_.write(static_cast<LeafType>(kind), offset, ids);
    }

  private:
    void keep_ids() {
        ids_ = make_huge_array<std::uint32_t>(large_.size());
        parallel_for(large_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) ids_[i] = large_[i].id;
        });
    }

    /// Sorts few ids, id_of(0) and so on, by their ranks, without branches that depend on them.
    template <class IdOf>
    static void sort_ids(std::span<PrimitiveId> ids, const IdOf& id_of) {
        const std::size_t size = ids.size();
        if (size > 2 * kBlockWidth) {
            for (std::size_t i = 0; i < size; ++i) ids[i] = PrimitiveId{id_of(i)};
            std::sort(ids.begin(), ids.end());
            return;
        }
        std::array<std::uint32_t, 2 * kBlockWidth> id, rank;
        for (std::size_t i = 0; i < size; ++i) {
            id[i] = id_of(i);
            std::uint32_t before = 0;
            for (std::size_t k = 0; k < i; ++k) {
                const std::uint32_t later = id[i] < id[k];
                rank[k] += later;
                before += 1 - later;
            }
            rank[i] = before;
        }
        for (std::size_t i = 0; i < size; ++i) ids[rank[i]] = PrimitiveId{id[i]};
    }

    LeafWriter& writer_;
    std::size_t room_ = 0;
    std::span<BuildReference> large_;
    HugeArray<std::uint32_t> ids_;  ///< of `large_`, whose values are lost
};

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

/// A tree before it is made wide.
struct DraftTree {
    std::vector<BuildReference> references;
    DraftBvh draft;

    [[nodiscard]] double cost() const { return draft_cost(draft, references, kLeafKindTable); }
    [[nodiscard]] std::size_t leaf_references() const {
        std::size_t count = 0;
        for (const DraftNode& node : draft.nodes) {
            if (node.is_leaf()) count += node.end - node.begin;
        }
        return count;
    }
};

/// Builds with spatial splits and without, and takes what costs less: in a closed room the splits
/// divide the walls at every level, and no box is as small as the things in it.
BinaryBvh build_of_high_quality(std::vector<BuildReference>& references, const LocalFrame& frame,
                                const PrimitiveTable& table) {
    // With more gain by splits, or fewer parts, reinsertion does not change which of the trees
    // costs less, by measurements.
    constexpr double kClearGain = 0.95, kFewParts = 1.03;
    DraftTree whole{references, {}}, best{std::move(references), {}};
    whole.draft = draft_of(build_binary(whole.references, kLeafKindTable), kLeafKindTable);
    const TriangleSplitter splitter(table, frame);
    best.draft = draft_of(build_with_spatial_splits(best.references, kLeafKindTable, splitter),
                          kLeafKindTable);
    const double cost = best.cost(), cost_of_whole = whole.cost();
    const auto count = static_cast<double>(whole.references.size());
    if (!(cost <= cost_of_whole)) {
        best = {};
        reinsert(whole.draft);
        std::swap(best, whole);
    } else if (cost < kClearGain * cost_of_whole ||
               static_cast<double>(best.leaf_references()) <= kFewParts * count) {
        whole = {};
        reinsert(best.draft);
    } else {
        reinsert(best.draft);
        reinsert(whole.draft);
        if (!(best.cost() <= whole.cost())) std::swap(best, whole);
    }
    references = std::move(best.references);
    return linearize(best.draft, references);
}

/// The number of blocks in whose room the references are made, which they replace, if these are
/// many and all of triangles; else 0.
std::size_t room_of_references(const PrimitiveTable& table, const BoundedPrimitives& bounded,
                               const BuildOptions& options) {
    static_assert(sizeof(BuildReference) < kRoomOfTriangle);
    static_assert(alignof(TriangleBlock) % alignof(BuildReference) == 0);
    const bool large = bounded.size() * sizeof(BuildReference) >= kLargeReferences;
    const std::size_t triangles = table.first(kInstanceKind) - table.first(kTriangleKind);
    if (!large || triangles != table.size() || options.leaves == Leaves::Indices) return 0;
    return bounded.size() * kRoomOfTriangle / sizeof(TriangleBlock);
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
    LeafWriter writer(table, options.leaves, layout);
    const std::uint32_t width = options.precision == Precision::Fast ? 8 : options.width;
    if (options.quality == BuildQuality::Fast && LocalVertices::can_number(table)) {
        TableCurve primitives(bounded, writer);
        layout.tree = build_along_curve(primitives, kLeafKindTable, width);
        return layout;
    }
    if (options.quality == BuildQuality::High) {
        Packer packer(writer);
        // Splits add references.
        std::vector<BuildReference> references(bounded.size());
        make_references(table, bounded, layout.frame, references);
        const BinaryBvh binary = build_of_high_quality(references, layout.frame, table);
        layout.tree = collapse(binary, references, kLeafKindTable, packer, width);
        return layout;
    }
    const std::size_t blocks = room_of_references(table, bounded, options);
    HugeArray<BuildReference> beside;
    if (blocks == 0) beside = make_huge_array<BuildReference>(bounded.size());
    layout.triangles.reserve(blocks);
    const std::span references(
        blocks == 0 ? beside.get() : reinterpret_cast<BuildReference*>(layout.triangles.data()),
        bounded.size());
    make_references(table, bounded, layout.frame, references);
    const BinaryBvh binary = build_binary(references, kLeafKindTable);
    Packer packer(writer, references, blocks);
    layout.tree = collapse(binary, references, kLeafKindTable, packer, width);
    return layout;
}

double WideBvhLayout::sah_cost() const {
    return alhazen::sah_cost(tree, kLeafKindTable);
}

std::size_t WideBvhLayout::memory_bytes() const {
    std::size_t bytes = 0;
    // What is reserved beside is not written.
    for_each_array(*this, [&](const auto& array) { bytes += array.size() * sizeof(array[0]); });
    return bytes;
}

}  // namespace alhazen

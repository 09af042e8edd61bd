#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"

#include <algorithm>

#include "alhazen/accel/wide_bvh/build/binary_builder.h"
#include "alhazen/accel/wide_bvh/build/clustering.h"
#include "alhazen/accel/wide_bvh/build/reinsertion.h"
#include "alhazen/accel/wide_bvh/build/sah_cost.h"
#include "alhazen/aggregates/wide_bvh/leaves/build_references.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_fill.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_splitter.h"
#include "alhazen/base/error.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/parallel/touch_pages.h"
#include "alhazen/primitives/bounded_primitives.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {
namespace {

/// Costs in visits of a wide node, from measurements.
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
            resize(layout_.indices, triangles);
            indices_ = layout_.indices.data();
        } else {
            resize(layout_.triangles, triangles);
            triangles_ = layout_.triangles.data();
        }
        resize(layout_.spheres, blocks[static_cast<std::size_t>(LeafType::Spheres)]);
        resize(layout_.frustums, blocks[static_cast<std::size_t>(LeafType::Frustums)]);
        resize(layout_.others, blocks[static_cast<std::size_t>(LeafType::Others)]);
    }

    float pack(std::uint32_t kind, std::size_t offset,
               std::span<const BuildReference> references) override {
        std::array<PrimitiveId, kBlockWidth * NodeRef::kMaxBlocks> sorted;
        const std::span ids = std::span(sorted).first(references.size());
        sort_ids(references, ids);
        const auto type = static_cast<LeafType>(kind);
        if (type == LeafType::Triangles) return pack_triangles(offset, ids);
        fill(type, offset, ids);
        float surface = 0;
        for (const PrimitiveId id : ids) {
            surface += surface_of(surface_area(table_, id), table_.is_opaque(id));
        }
        return surface;
    }

  private:
    template <class Block>
    static void resize(MappableVector<Block>& blocks, std::size_t count) {
        blocks.reserve(count);
        touch_pages(blocks.data(), count * sizeof(Block));
        blocks.resize(count);
    }
    /// Sorts few ids by their ranks, without branches that depend on them.
    static void sort_ids(std::span<const BuildReference> references, std::span<PrimitiveId> ids) {
        const std::size_t size = references.size();
        if (size > 2 * kBlockWidth) {
            std::transform(references.begin(), references.end(), ids.begin(),
                           [](const BuildReference& r) { return PrimitiveId{r.id}; });
            std::sort(ids.begin(), ids.end());
            return;
        }
        std::array<std::uint32_t, 2 * kBlockWidth> id, rank;
        for (std::size_t i = 0; i < size; ++i) {
            id[i] = references[i].id;
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

    void fill(LeafType kind, std::size_t offset, std::span<const PrimitiveId> ids) const {
        switch (kind) {
            case LeafType::Triangles:
                return;
            case LeafType::Spheres:
                return fill_blocks(&layout_.spheres[offset], ids);
            case LeafType::Frustums:
                return fill_blocks(&layout_.frustums[offset], ids);
            case LeafType::Others:
                return fill_blocks(&layout_.others[offset], ids);
        }
    }
    /// A surface that lets light through may not end a query, so it counts for less.
    [[nodiscard]] float surface_of(double area, bool opaque) const {
        const double unit = layout_.frame.scale * layout_.frame.scale;
        area *= unit;
        return static_cast<float>(opaque ? area : 0.5 * area);
    }

    /// The triangles of a leaf are scattered in memory: all are prefetched before the first is
    /// read.
    float pack_triangles(std::size_t offset, std::span<const PrimitiveId> ids) const {
        const std::uint32_t first = table_.first(kTriangleKind);
        std::array<LeafTriangle, kBlockWidth * NodeRef::kMaxBlocks> room;
        const std::span triangles = std::span(room).first(ids.size());
        const PlacedMesh* const only = table_.meshes.size() == 1 ? table_.meshes.data() : nullptr;
        for (const PrimitiveId id : ids) {
            const std::uint32_t triangle = static_cast<std::uint32_t>(id) - first;
            const PlacedMesh& placed = only != nullptr ? *only : table_.mesh_of(triangle);
            __builtin_prefetch(placed.mesh->triangles.data() + (triangle - placed.first_triangle));
        }
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const std::uint32_t triangle = static_cast<std::uint32_t>(ids[i]) - first;
            const PlacedMesh& placed = only != nullptr ? *only : table_.mesh_of(triangle);
            const TriangleMesh& mesh = *placed.mesh;
            const auto& corners = mesh.triangles.data()[triangle - placed.first_triangle];
            LeafTriangle& out = triangles[i];
            for (std::size_t k = 0; k < 3; ++k) {
                out.corner[k] = mesh.positions.data() + corners[k];
                __builtin_prefetch(out.corner[k]);
            }
            out.id = ids[i];
            out.opaque = mesh.vertex_materials.empty() ? is_opaque(placed.material)
                                                       : table_.is_opaque(ids[i]);
        }
        if (leaves_ == Leaves::Indices) {
            fill_with(indices_ + offset, triangles);
        } else {
            fill_with(triangles_ + offset, triangles);
        }
        float surface = 0;
        for (const auto& [corner, id, opaque] : triangles) {
            const Vec3 u = *corner[1] - *corner[0], v = *corner[2] - *corner[0];
            surface += surface_of(0.5 * length(cross(u, v)), opaque);
        }
        return surface;
    }
    [[nodiscard]] bool is_opaque(MaterialId material) const {
        return table_.material_opacity[static_cast<std::uint32_t>(material)] == Opacity::Opaque;
    }

    template <class Block>
    void fill_with(Block* block, std::span<const LeafTriangle> triangles) const {
        for (std::size_t i = 0; i < triangles.size(); i += kBlockWidth, ++block) {
            fill_block(*block, triangles.subspan(i, std::min(kBlockWidth, triangles.size() - i)),
                       layout_.frame);
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
    IndexBlock* indices_ = nullptr;
    TriangleBlock* triangles_ = nullptr;
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

BinaryBvh build_of_high_quality(std::vector<BuildReference>& references, const LocalFrame& frame,
                                const PrimitiveTable& table) {
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
    Packer packer(table, options.leaves, layout);
    const std::uint32_t width = options.precision == Precision::Fast ? 8 : options.width;
    if (options.quality == BuildQuality::High) {
        // Splits add references.
        std::vector<BuildReference> references(bounded.size());
        make_references(table, bounded, layout.frame, references);
        const BinaryBvh binary = build_of_high_quality(references, layout.frame, table);
        layout.tree = collapse(binary, references, kLeafKindTable, packer, width);
        return layout;
    }
    const auto room = make_huge_array<BuildReference>(bounded.size());
    const std::span references(room.get(), bounded.size());
    make_references(table, bounded, layout.frame, references);
    const BinaryBvh binary = options.quality == BuildQuality::Fast
                                 ? build_by_clustering(references, kLeafKindTable)
                                 : build_binary(references, kLeafKindTable);
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

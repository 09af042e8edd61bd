#include "alhazen/aggregates/wide_bvh/leaves/table_curve.h"

#include <algorithm>

#include "alhazen/aggregates/wide_bvh/leaves/lane_triangles.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/base/interruption.h"

namespace alhazen {
namespace {

constexpr auto kTriangles = static_cast<std::uint32_t>(LeafType::Triangles);

}  // namespace

TableCurve::TableCurve(const BoundedPrimitives& bounded, LeafWriter& writer)
    : bounded_(bounded),
      writer_(writer),
      vertices_(writer.table(), writer.frame()),
      only_triangles_(false) {
    if (bounded.size() == 0) return;
    const PrimitiveTable& table = writer.table();
    only_triangles_ = bounded.id(0) >= table.first(kTriangleKind) &&
                      bounded.id(bounded.size() - 1) < table.first(kInstanceKind);
}

TableCurve::MeshView TableCurve::view(PrimitiveId id) const {
    const PlacedMesh& placed = writer_.mesh_of(id);
    const TriangleMesh& mesh = *placed.mesh;
    const bool same = mesh.vertex_materials.empty();
    const std::array<std::uint32_t, 3>* const own = &writer_.corners(id, placed);
    const auto place = static_cast<std::uint32_t>(own - mesh.triangles.data());
    return {mesh.triangles.data(), static_cast<std::uint32_t>(id) - place, first_vertex(placed),
            same && writer_.is_opaque(id, placed), same};
}

std::uint32_t TableCurve::first_vertex(const PlacedMesh& placed) const {
    return vertices_.first(static_cast<std::size_t>(&placed - writer_.table().meshes.data()));
}

std::uint32_t TableCurve::common_kind() const {
    return only_triangles_ ? kTriangles : std::uint32_t{kLeafKinds};
}

std::uint32_t TableCurve::kind(std::uint32_t index) const {
    return static_cast<std::uint32_t>(leaf_type(writer_.table(), PrimitiveId{bounded_.id(index)}));
}

void TableCurve::centers(std::uint32_t begin, std::uint32_t end, Float4* to) const {
    interruption_point();
    const PrimitiveTable& table = writer_.table();
    const bool all = bounded_.size() == table.size();
    const std::uint32_t first = all ? std::clamp(table.first(kTriangleKind), begin, end) : end;
    const std::uint32_t last = all ? std::clamp(table.first(kInstanceKind), begin, end) : end;
    const auto others = [&](std::uint32_t from, std::uint32_t until) {
        for (std::uint32_t i = from; i < until; ++i) {
            const Vec3 p = writer_.frame().local(bounded_.box(i).center());
            to[i - begin] = Float4{static_cast<float>(p.x), static_cast<float>(p.y),
                                   static_cast<float>(p.z), 0.0f};
        }
    };
    others(begin, first);
    triangle_centers(first, last, to + (first - begin));
    others(last, end);
}

void TableCurve::triangle_centers(std::uint32_t begin, std::uint32_t end, Float4* to) const {
    constexpr Float4 kHalf{0.5f, 0.5f, 0.5f, 0.0f};
    for (std::uint32_t id = begin; id < end;) {
        const PlacedMesh& placed = writer_.mesh_of(PrimitiveId{id});
        const auto* const first = &writer_.corners(PrimitiveId{id}, placed);
        const auto* const last = placed.mesh->triangles.data() + placed.mesh->triangles.size();
        const auto count = std::min(end - id, static_cast<std::uint32_t>(last - first));
        const Float4* const vertices = &vertices_[first_vertex(placed)];
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto& corners = first[i];
            const Float4 a = vertices[corners[0]], b = vertices[corners[1]],
                         c = vertices[corners[2]];
            *to++ = kHalf * (lesser(lesser(a, b), c) + greater(greater(a, b), c));
        }
        id += count;
    }
}

void TableCurve::fill(std::span<const CurveLeaf> leaves, const std::uint32_t* indices,
                      std::uint32_t first, BuildReference* boxes, float* areas) const {
    interruption_point();
    for (std::size_t i = 0; i < leaves.size();) {
        const auto number = static_cast<std::uint32_t>(first + i);
        std::size_t last = i;
        while (last < leaves.size() && leaves[last].kind == kTriangles) ++last;
        if (last > i) {
            fill_triangles(leaves.subspan(i, last - i), indices, number, boxes + i, areas + i);
            i = last;
        } else {
            fill_shapes(leaves[i], indices, number, boxes[i], areas[i]);
            ++i;
        }
    }
}

/// The triangles of leaves, in the order of these.
template <bool kSimple>
class TableCurve::Finder {
  public:
    /// `kSimple`: one mesh has all primitives, and all its triangles are opaque or none.
    Finder(const TableCurve& curve, const std::uint32_t* indices, const MeshView& only)
        : curve_(curve),
          indices_(indices),
          only_(only),
          several_(curve.writer_.table().meshes.size() > 1),
          vertices_(&curve.vertices_[0]) {}

    /// Inlined: GCC drops calls of a function that only prefetches.
    [[gnu::always_inline]] void prefetch(const CurveLeaf& leaf) const {
        const std::uint32_t* const its = indices_ + leaf.first;
        for (std::uint32_t k = 0; k < leaf.count; ++k) {
            const PrimitiveId id = id_of(its[k]);
            __builtin_prefetch(&view_of(id).corners(id));
        }
    }
    /// Prefetches the vertices. All lanes are written without a branch on their number.
    void find(const CurveLeaf& leaf, LaneTriangles& found) const {
        const std::uint32_t* const its = indices_ + leaf.first;
        const std::uint32_t last = leaf.count - 1;
        found.count = leaf.count;
#pragma GCC unroll 8
        for (std::uint32_t k = 0; k < kBlockWidth; ++k) {
            const PrimitiveId id = id_of(its[std::min(k, last)]);
            const auto& mesh = view_of(id);
            const auto& corners = mesh.corners(id);
            const Float4* const vertices = vertices_ + mesh.first_vertex;
            const Float4 *const p = vertices + corners[0], *const q = vertices + corners[1],
                                *const r = vertices + corners[2];
            found.corner[0][k] = p;
            found.corner[1][k] = q;
            found.corner[2][k] = r;
            __builtin_prefetch(p);
            __builtin_prefetch(q);
            __builtin_prefetch(r);
            const bool opaque =
                kSimple || mesh.same ? mesh.opaque : curve_.writer_.table().is_opaque(id);
            found.ids[k] = {id, opaque, false};
        }
    }

  private:
    [[nodiscard]] PrimitiveId id_of(std::uint32_t index) const {
        return PrimitiveId{kSimple ? index : curve_.bounded_.id(index)};
    }
    /// A reference to a view, or a view.
    [[nodiscard]] decltype(auto) view_of(PrimitiveId id) const {
        if constexpr (kSimple) {
            return (only_);
        } else {
            return several_ ? curve_.view(id) : only_;
        }
    }

    const TableCurve& curve_;
    const std::uint32_t* indices_;
    MeshView only_;
    bool several_;
    const Float4* vertices_;
};

void TableCurve::fill_triangles(std::span<const CurveLeaf> leaves, const std::uint32_t* indices,
                                std::uint32_t first, BuildReference* boxes, float* areas) const {
    const PrimitiveTable& table = writer_.table();
    const MeshView only = view(PrimitiveId{bounded_.id(indices[leaves[0].first])});
    if (bounded_.size() == table.size() && table.meshes.size() == 1 && only.same) {
        fill_found(Finder<true>(*this, indices, only), leaves, first, boxes, areas);
    } else {
        fill_found(Finder<false>(*this, indices, only), leaves, first, boxes, areas);
    }
}

/// Reads and prefetches some leaves ahead.
template <class TriangleFinder>
void TableCurve::fill_found(const TriangleFinder& finder, std::span<const CurveLeaf> leaves,
                            std::uint32_t first, BuildReference* boxes, float* areas) const {
    constexpr std::size_t kAhead = 4;  // leaves
    LaneTriangles triangles[kAhead];
    const auto prefetch = [&](std::size_t i) {
        if (i < leaves.size()) finder.prefetch(leaves[i]);
    };
    const auto find = [&](std::size_t i) {
        if (i < leaves.size()) finder.find(leaves[i], triangles[i % kAhead]);
    };
    TriangleBlock* const blocks = writer_.triangle_blocks();
    const auto fill = lane_kernels().fill;
    for (std::size_t i = 0; i + 1 < 2 * kAhead; ++i) prefetch(i);
    for (std::size_t i = 0; i + 1 < kAhead; ++i) find(i);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        prefetch(i + 2 * kAhead - 1);
        find(i + kAhead - 1);
        const LaneTriangles& here = triangles[i % kAhead];
        TriangleBlock* const block = blocks == nullptr ? nullptr : blocks + leaves[i].offset;
        const LaneExtent extent = fill(block, here);
        set_reference(boxes[i], vertices_.padded(extent.lo, extent.hi),
                      static_cast<std::uint32_t>(first + i), kTriangles);
        areas[i] = extent.area;
        if (block == nullptr) {
            BlockId* const ids = writer_.index_blocks()[leaves[i].offset].ids;
            std::copy_n(here.ids, here.count, ids);
            std::fill(ids + here.count, ids + kBlockWidth, BlockId::none());
        }
    }
}

void TableCurve::fill_shapes(const CurveLeaf& leaf, const std::uint32_t* indices,
                             std::uint32_t number, BuildReference& box, float& area) const {
    std::array<PrimitiveId, kBlockWidth> room;
    const std::span ids = std::span(room).first(leaf.count);
    FloatBox all;
    for (std::uint32_t k = 0; k < leaf.count; ++k) {
        const std::uint32_t index = indices[leaf.first + k];
        ids[k] = PrimitiveId{bounded_.id(index)};
        all.include(writer_.frame().local(bounded_.box(index)));
    }
    box = {all, number, leaf.kind};
    area = writer_.write(static_cast<LeafType>(leaf.kind), leaf.offset, ids);
}

}  // namespace alhazen

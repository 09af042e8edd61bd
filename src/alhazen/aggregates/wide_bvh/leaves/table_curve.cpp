#include "alhazen/aggregates/wide_bvh/leaves/table_curve.h"

#include <algorithm>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_references.h"
#include "alhazen/base/interruption.h"

namespace alhazen {
namespace {

constexpr auto kTriangles = static_cast<std::uint32_t>(LeafType::Triangles);

/// Centers of the boxes of triangles in the frame of a tree.
class TriangleCenters {
  public:
    explicit TriangleCenters(const LocalFrame& frame) {
        const double half = 0.5 * frame.scale;
        scale_ = Double2{half, half};
        const Vec3 center = frame.scale * frame.center;
        center_ = Double2{center.x, center.y};
        deep_ = center.z;
    }
    [[nodiscard]] Float4 operator()(const Vec3& a, const Vec3& b, const Vec3& c) const {
        const PointLanes p(a), q(b), r(c);
        const Double2 lower = lesser(lesser(p.xy, q.xy), r.xy);
        const Double2 upper = greater(greater(p.xy, q.xy), r.xy);
        const double near = std::min(std::min(p.z, q.z), r.z);
        const double far = std::max(std::max(p.z, q.z), r.z);
        const Double2 across = scale_ * (lower + upper) - center_;
        const double deep = scale_[0] * (near + far) - deep_;
        return Float4{static_cast<float>(across[0]), static_cast<float>(across[1]),
                      static_cast<float>(deep), 0.0f};
    }

  private:
    Double2 scale_, center_;
    double deep_;
};

}  // namespace

TableCurve::TableCurve(const BoundedPrimitives& bounded, LeafWriter& writer)
    : bounded_(bounded), writer_(writer), only_triangles_(false) {
    if (bounded.size() == 0) return;
    const PrimitiveTable& table = writer.table();
    only_triangles_ = bounded.id(0) >= table.first(kTriangleKind) &&
                      bounded.id(bounded.size() - 1) < table.first(kInstanceKind);
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
    const TriangleCenters center(writer_.frame());
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
    for_triangles(table, first, last,
                  [&](std::uint32_t id, const Vec3& a, const Vec3& b, const Vec3& c) {
                      to[id - begin] = center(a, b, c);
                  });
    others(last, end);
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

/// Reads and prefetches some leaves ahead.
void TableCurve::fill_triangles(std::span<const CurveLeaf> leaves, const std::uint32_t* indices,
                                std::uint32_t first, BuildReference* boxes, float* areas) const {
    constexpr std::size_t kAhead = 4;  // leaves
    const TriangleReferences to_box(writer_.frame());
    LeafTriangle triangles[kAhead][kBlockWidth];
    const auto for_ids = [&](std::size_t i, const auto& f) {
        if (i >= leaves.size()) return;
        const std::uint32_t* const its = indices + leaves[i].first;
        for (std::uint32_t k = 0; k < leaves[i].count; ++k) f(k, PrimitiveId{bounded_.id(its[k])});
    };
    const auto prefetch = [&](std::size_t i) {
        for_ids(i, [&](std::uint32_t, PrimitiveId id) { writer_.prefetch(id); });
    };
    const auto find = [&](std::size_t i) {
        for_ids(i, [&](std::uint32_t k, PrimitiveId id) {
            triangles[i % kAhead][k] = writer_.find(id);
        });
    };
    for (std::size_t i = 0; i + 1 < 2 * kAhead; ++i) prefetch(i);
    for (std::size_t i = 0; i + 1 < kAhead; ++i) find(i);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        prefetch(i + 2 * kAhead - 1);
        find(i + kAhead - 1);
        const std::span<const LeafTriangle> here(triangles[i % kAhead], leaves[i].count);
        TriangleBounds bounds;
        for (const LeafTriangle& triangle : here) {
            for (const Vec3* corner : triangle.corner) bounds.include(PointLanes(*corner));
        }
        bounds.pad();
        to_box(bounds, static_cast<std::uint32_t>(first + i), boxes[i]);
        writer_.write_triangles(leaves[i].offset, here);
        areas[i] = writer_.area_of(here);
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

#include "alhazen/aggregates/wide_bvh/leaves/local_vertices.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_fill.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/primitives/triangle_bounds.h"

namespace alhazen {
namespace {

constexpr std::size_t kVerticesAtOnce = 8192;
/// Beyond the local coordinates of all bounded primitives; within those of floats.
constexpr double kBeyond = 64;

using IntLanes = std::int32_t __attribute__((vector_size(16)));

/// Rounds vertices to the frame.
class VertexRounding {
  public:
    explicit VertexRounding(const LocalFrame& frame)
        : scale_{frame.scale, frame.scale},
          inverse_{frame.inverse_scale, frame.inverse_scale},
          across_{frame.center.x, frame.center.y},
          deep_{frame.center.z, frame.center.z},
          beyond_(kBeyond * inverse_) {}

    [[nodiscard]] Float4 operator()(const Vec3& p) const {
        const PointLanes lanes(p);
        const Double2 z{lanes.z, lanes.z};
        float x0, y0, z0, z1;
        const bool exact_across = round(lanes.xy, across_, x0, y0);
        const bool exact_deep = round(z, deep_, z0, z1);
        return Float4{x0, y0, z0, exact_across && exact_deep ? 1.0f : 0.0f};
    }

  private:
    /// Rounds two coordinates; true if they are exact.
    [[nodiscard]] bool round(Double2 world, Double2 center, float& first, float& second) const {
        // Vertices without a bounded triangle may be anywhere.
        const Double2 local = scale_ * greater(lesser(world - center, beyond_), -beyond_);
        first = static_cast<float>(local[0]);
        second = static_cast<float>(local[1]);
        const Double2 rounded{static_cast<double>(first), static_cast<double>(second)};
        const Double2 back = inverse_ * rounded + center;
        std::uint64_t was[2], is[2];
        std::memcpy(was, &world, sizeof(was));
        std::memcpy(is, &back, sizeof(is));
        return ((was[0] ^ is[0]) | (was[1] ^ is[1])) == 0;
    }

    Double2 scale_, inverse_, across_, deep_, beyond_;
};

IntLanes bits_of(Float4 v) {
    IntLanes bits;
    std::memcpy(&bits, &v, sizeof(bits));
    return bits;
}
Float4 magnitude(Float4 v) {
    return greater(v, -v);
}
Float4 square_root(Float4 v) {
#ifdef __SSE2__
    return _mm_sqrt_ps(v);
#else
    return Float4{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
#endif
}

/// A corner of four triangles: its coordinates, and 1 where they are exact.
struct CornerLanes {
    Float4 x, y, z, exact;

    CornerLanes(const LocalVertices& vertices, const std::uint32_t* corner) {
        const Float4 a = vertices[corner[0]], b = vertices[corner[1]], c = vertices[corner[2]],
                     d = vertices[corner[3]];
        const Float4 ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
        const Float4 cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
        const Float4 ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
        const Float4 cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
        x = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
        y = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
        z = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
        exact = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
    }
    void store(float (&rows)[3][kBlockWidth], std::size_t lane) const {
        std::memcpy(rows[0] + lane, &x, sizeof(x));
        std::memcpy(rows[1] + lane, &y, sizeof(y));
        std::memcpy(rows[2] + lane, &z, sizeof(z));
    }
};

/// Twice the areas of four triangles.
Float4 double_areas(const CornerLanes& a, const CornerLanes& b, const CornerLanes& c) {
    const Float4 ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const Float4 vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const Float4 nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    return square_root(nx * nx + ny * ny + nz * nz);
}

/// The weights of double_areas of four lanes with these ids.
Float4 area_weights(IntLanes ids, std::size_t lane, std::uint32_t count) {
    const IntLanes lanes = IntLanes{0, 1, 2, 3} + static_cast<std::int32_t>(lane);
    const IntLanes used = lanes < static_cast<std::int32_t>(count);
    // The bits of 0.5; those of 0.25 differ in one, which is cleared unless the lane is opaque.
    const IntLanes half = bits_of(Float4{0.5f, 0.5f, 0.5f, 0.5f});
    const IntLanes step = half - bits_of(Float4{0.25f, 0.25f, 0.25f, 0.25f});
    const IntLanes opaque = ids < 0;
    const IntLanes bits = used & (half - (step & ~opaque));
    Float4 weights;
    std::memcpy(&weights, &bits, sizeof(weights));
    return weights;
}

float sum_of(Float4 v) {
    return (v[0] + v[1]) + (v[2] + v[3]);
}

}  // namespace

bool LocalVertices::can_number(const PrimitiveTable& table) {
    std::uint64_t count = 3;
    for (const PlacedMesh& placed : table.meshes) count += placed.mesh->positions.size();
    return count <= std::uint64_t{1} << 32;
}

LocalVertices::LocalVertices(const PrimitiveTable& table, const LocalFrame& frame) {
    std::uint32_t count = 0;
    for (const PlacedMesh& placed : table.meshes) {
        firsts_.push_back(count);
        count += static_cast<std::uint32_t>(placed.mesh->positions.size());
    }
    firsts_.push_back(count);
    all_ = make_huge_array<Float4>(std::size_t{count} + 3);
    const VertexRounding rounded(frame);
    for (std::size_t i = 0; i < table.meshes.size(); ++i) {
        const std::vector<Vec3>& positions = table.meshes[i].mesh->positions;
        parallel_for(positions.size(), kVerticesAtOnce, [&](std::size_t begin, std::size_t end) {
            const Vec3* const from = positions.data();
            Float4* const to = all_.get() + firsts_[i];
            for (std::size_t k = begin; k < end; ++k) to[k] = rounded(from[k]);
        });
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const auto& p = kUnusedTriangle[k];
        all_[count + k] = Float4{p[0], p[1], p[2], 0.0f};
    }
    // As TriangleBounds::pad and its rounding, for the largest coordinate; and a step of the least
    // floats.
    pad_ = static_cast<float>(9.5e-16 * (1.0 + frame.offset) + 1e-37);
}

float LocalVertices::fill(TriangleBlock& block, const LaneTriangles& triangles) const {
    static_assert(kBlockWidth == 8 && BlockId::kExactBit == 1u << 30);
    Float4 area{};
    for (std::size_t lane = 0; lane < kBlockWidth; lane += 4) {
        const CornerLanes a(*this, triangles.corner[0] + lane);
        const CornerLanes b(*this, triangles.corner[1] + lane);
        const CornerLanes c(*this, triangles.corner[2] + lane);
        a.store(block.vertex[0], lane);
        b.store(block.vertex[1], lane);
        c.store(block.vertex[2], lane);
        // 1.0f has bit 29, the lesser neighbor of the flag.
        const IntLanes exact = bits_of(a.exact) & bits_of(b.exact) & bits_of(c.exact);
        IntLanes ids;
        std::memcpy(&ids, triangles.ids + lane, sizeof(ids));
        area += double_areas(a, b, c) * area_weights(ids, lane, triangles.count);
        ids |= (exact & (1 << 29)) << 1;
        std::memcpy(static_cast<void*>(block.ids + lane), &ids, sizeof(ids));
    }
    return sum_of(area);
}

float LocalVertices::area(const LaneTriangles& triangles) const {
    Float4 area{};
    for (std::size_t lane = 0; lane < kBlockWidth; lane += 4) {
        const CornerLanes a(*this, triangles.corner[0] + lane);
        const CornerLanes b(*this, triangles.corner[1] + lane);
        const CornerLanes c(*this, triangles.corner[2] + lane);
        IntLanes ids;
        std::memcpy(&ids, triangles.ids + lane, sizeof(ids));
        area += double_areas(a, b, c) * area_weights(ids, lane, triangles.count);
    }
    return sum_of(area);
}

/// The rounding of a coordinate, of its margin and of their difference take less than the margin's
/// four halves of an ulp.
Box4 LocalVertices::box(const LaneTriangles& triangles) const {
    // One box for each corner: minima do not wait for each other.
    Box4 box, second, third;
    for (std::uint32_t lane = 0; lane < triangles.count; ++lane) {
        box.include_point(all_[triangles.corner[0][lane]]);
        second.include_point(all_[triangles.corner[1][lane]]);
        third.include_point(all_[triangles.corner[2][lane]]);
    }
    box.include(second);
    box.include(third);
    box.lo -= magnitude(box.lo) * 0x1p-22f + pad_;
    box.hi += magnitude(box.hi) * 0x1p-22f + pad_;
    return box;
}

}  // namespace alhazen

#include "alhazen/aggregates/wide_bvh/leaves/leaf_fill.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include "alhazen/aggregates/wide_bvh/leaves/flat_shapes.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/math/constants.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/primitives/triangle_bounds.h"

namespace alhazen {
namespace {

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
bool same_bits(const Vec3& a, const Vec3& b) {
    return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

#ifdef __SSE2__

/// Writes triangles into the lanes of a block.
class LaneWriter {
  public:
    explicit LaneWriter(const LocalFrame& frame)
        : scale_{frame.scale, frame.scale},
          inverse_{frame.inverse_scale, frame.inverse_scale},
          across_{frame.center.x, frame.center.y},
          deep_{frame.center.z, frame.center.z} {}

    /// True if the block holds the triangle unrounded.
    bool operator()(TriangleBlock& block, std::size_t lane, const LeafTriangle& triangle) const {
        __m128i same = _mm_set1_epi32(-1);
        auto& [a, b, c] = block.vertex;
        const auto& [pa, pb, pc] = triangle.corner;
        set(PointLanes(*pa).xy, across_, a[0][lane], a[1][lane], same);
        set(PointLanes(*pb).xy, across_, b[0][lane], b[1][lane], same);
        set(PointLanes(*pc).xy, across_, c[0][lane], c[1][lane], same);
        set(Double2{pa->z, pb->z}, deep_, a[2][lane], b[2][lane], same);
        set(Double2{pc->z, pc->z}, deep_, c[2][lane], c[2][lane], same);
        return _mm_movemask_epi8(same) == 0xFFFF;
    }

  private:
    /// Rounds two coordinates; clears bits of `same` where they change.
    void set(Double2 world, Double2 center, float& first, float& second, __m128i& same) const {
        const Double2 local = scale_ * (world - center);
        const __m128 rounded = _mm_cvtpd_ps(local);
        first = rounded[0];
        second = rounded[1];
        const Double2 exact = _mm_cvtps_pd(rounded);
        const Double2 back = inverse_ * exact + center;
        same =
            _mm_and_si128(same, _mm_cmpeq_epi32(_mm_castpd_si128(back), _mm_castpd_si128(world)));
    }

    Double2 scale_, inverse_, across_, deep_;
};

#else

/// Writes triangles into the lanes of a block.
class LaneWriter {
  public:
    explicit LaneWriter(const LocalFrame& frame) : frame_(frame) {}

    /// True if the block holds the triangle unrounded.
    bool operator()(TriangleBlock& block, std::size_t lane, const LeafTriangle& triangle) const {
        bool exact = true;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vec3& world = *triangle.corner[corner];
            const Vec3 local = frame_.local(world);
            for (int axis = 0; axis < 3; ++axis) {
                block.vertex[corner][axis][lane] = static_cast<float>(local[axis]);
            }
            exact = exact && same_bits(frame_.world(block.corner(corner, lane)), world);
        }
        return exact;
    }

  private:
    LocalFrame frame_;
};

#endif

void leave_free(TriangleBlock& block, std::size_t lane) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            block.vertex[corner][axis][lane] = kUnusedTriangle[corner][axis];
        }
    }
    block.ids[lane] = BlockId::none();
}

/// Factor that covers rounding in double.
constexpr double kMore = 1.0 + 0x1p-40;

/// Rounds a point into a lane; returns a bound of the displacement.
double set_point(float (&rows)[3][kBlockWidth], std::size_t lane, const Vec3& p) {
    double moved = 0;
    for (int axis = 0; axis < 3; ++axis) {
        rows[axis][lane] = static_cast<float>(p[axis]);
        moved += std::abs(p[axis] - static_cast<double>(rows[axis][lane]));
    }
    return moved;
}

/// Calls `fill(lane, id)` for every lane, which returns BlockId::exact; unused lanes repeat the
/// first.
template <class Block, class Fill>
void fill_lanes(Block& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                Fill&& fill) {
    for (std::size_t lane = 0; lane < kBlockWidth; ++lane) {
        const bool used = lane < ids.size();
        const PrimitiveId id = ids[used ? lane : 0];
        const bool exact = fill(lane, id);
        block.ids[lane] = used ? BlockId{id, table.is_opaque(id), exact} : BlockId::none();
    }
}

}  // namespace

void fill_block(TriangleBlock& block, std::span<const LeafTriangle> triangles,
                const LocalFrame& frame) {
    const LaneWriter write(frame);
    std::size_t lane = 0;
    for (const LeafTriangle& triangle : triangles) {
        const bool exact = write(block, lane, triangle);
        block.ids[lane++] = {triangle.id, triangle.opaque, exact};
    }
    for (; lane < kBlockWidth; ++lane) leave_free(block, lane);
}

void fill_block(IndexBlock& block, std::span<const LeafTriangle> triangles, const LocalFrame&) {
    std::size_t lane = 0;
    for (const LeafTriangle& triangle : triangles) {
        block.ids[lane++] = {triangle.id, triangle.opaque, false};
    }
    for (; lane < kBlockWidth; ++lane) block.ids[lane] = BlockId::none();
}

namespace {

template <class Block>
void fill_with_triangles(Block& block, std::span<const PrimitiveId> ids,
                         const PrimitiveTable& table, const LocalFrame& frame) {
    std::array<LeafTriangle, kBlockWidth> triangles;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const auto [a, b, c] = table.corner_positions(table.index(ids[i]));
        triangles[i] = {{a, b, c}, ids[i], table.is_opaque(ids[i])};
    }
    fill_block(block, std::span<const LeafTriangle>(triangles).first(ids.size()), frame);
}

}  // namespace

void fill_block(TriangleBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame& frame) {
    fill_with_triangles(block, ids, table, frame);
}

void fill_block(IndexBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame& frame) {
    fill_with_triangles(block, ids, table, frame);
}

void fill_block(SphereBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame& frame) {
    const auto& spheres = std::get<ShapeColumn<Sphere>>(table.columns).shapes;
    fill_lanes(block, ids, table, [&](std::size_t lane, PrimitiveId id) {
        const Sphere& sphere = spheres[table.index(id)];
        const double moved = set_point(block.center, lane, frame.local(sphere.center));
        block.radius[lane] = round_up(kMore * (sphere.radius * frame.scale) + moved);
        const Sphere held = block.sphere(lane, frame);
        return same_bits(held.center, sphere.center) && same_bits(held.radius, sphere.radius);
    });
    block.lanes = (1u << ids.size()) - 1;
}

void fill_block(FrustumBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame& frame) {
    fill_lanes(block, ids, table, [&](std::size_t lane, PrimitiveId id) {
        const RoundBounds bounds = round_bounds(table, id);
        const double moved = set_point(block.center, lane, frame.local(bounds.center));
        const double turned = set_point(block.axis, lane, bounds.axis);
        const double height = bounds.half_height * frame.scale;
        const double radius = bounds.radius * frame.scale;
        // A point of the shape is at most height + radius from the center, so the error of the axis
        // moves its position by at most `away` along the axis and twice that across it.
        const double away = turned * (height + radius);
        // An error of the shape's test along the axis is one across it, by the slope.
        const double steep = bounds.slope * (4 * kExactTestSlack);
        const bool ball = table.kind(id) == column_of<Sphere>();
        block.half_height[lane] =
            ball ? FrustumBlock::kEndless : round_up(kMore * height + 1.01 * (moved + away));
        block.radius[lane] = round_up(kMore * radius + 1.01 * (moved + 2.0 * away) + steep);
        return false;
    });
    block.lanes = (1u << ids.size()) - 1;
    block.certain = block.balls = 0;
    for (std::size_t lane = 0; lane < ids.size(); ++lane) {
        const std::uint32_t kind = table.kind(ids[lane]);
        block.balls |= std::uint32_t{kind == column_of<Sphere>()} << lane;
        block.certain |= std::uint32_t{kind == column_of<Cylinder>()} << lane;
    }
    block.certain |= block.balls;
}

namespace {

/// The center of a box as rounded to float.
Vec3 center_of(const BoxBlock& block, std::size_t lane) {
    return {block.center[0][lane], block.center[1][lane], block.center[2][lane]};
}

/// The largest of `size(p - center)` over the corners p of a body.
template <class Size>
double largest_of_corners(const SlantedBounds& bounds, const Vec3& center, const LocalFrame& frame,
                          Size&& size) {
    double largest = 0;
    for (int i = 0; i < 8; ++i) {
        Vec3 p = bounds.corner;
        for (int k = 0; k < 3; ++k) {
            if ((i >> k & 1) != 0) p += bounds.edge[k];
        }
        largest = std::max(largest, size(frame.local(p) - center));
    }
    return largest;
}

/// Half the width of the body along the direction of a slab; direction and center as in float.
double half_of(const SlantedBounds& bounds, const BoxBlock& block, std::size_t lane, int slab,
               const LocalFrame& frame) {
    const auto& d = block.direction[slab];
    const Vec3 along{d[0][lane], d[1][lane], d[2][lane]};
    const double half = largest_of_corners(bounds, center_of(block, lane), frame,
                                           [&](const Vec3& p) { return std::abs(dot(along, p)); });
    return kMore * (half + dot(abs(along), frame.scale * bounds.pad));
}

/// The radius of the ball around the center: the smaller one of those around the body and around
/// the primitive's bounding sphere.
double radius_of(const SlantedBounds& bounds, const BoundingSphere& sphere, const BoxBlock& block,
                 std::size_t lane, const LocalFrame& frame) {
    const Vec3 center = center_of(block, lane);
    const double of_body =
        largest_of_corners(bounds, center, frame, [](const Vec3& p) { return length(p); }) +
        length(frame.scale * bounds.pad);
    const double of_sphere =
        length(frame.local(sphere.center) - center) + frame.scale * sphere.radius;
    // Written so that NaN is never chosen.
    return kMore * (of_sphere < of_body ? of_sphere : of_body);
}

/// BoxBlock::inset. Between a corner and the center float rounds once, and so do the halves.
float inset_of(const FlatOutline& outline, bool round, const BoxBlock& block, std::size_t lane,
               const LocalFrame& frame) {
    std::vector<SlabPoint> corners;
    corners.reserve(outline.vertices.size());
    const Vec3 center = center_of(block, lane);
    const auto along = [&](std::size_t slab, const Vec3& p) {
        const auto& d = block.direction[slab];
        return dot(Vec3{d[0][lane], d[1][lane], d[2][lane]}, p);
    };
    for (const Vec3& vertex : outline.vertices) {
        const Vec3 p = frame.local(vertex) - center;
        corners.push_back({along(0, p), along(1, p)});
    }
    const double half_u = block.half[0][lane], half_v = block.half[1][lane];
    const double inset = inset_of(corners, outline.loop_ends, half_u, half_v);
    // Of a polygon the slabs are orthogonal, up to rounding: a disc, where that is larger.
    const double radius = round ? inner_radius_of(corners, outline.loop_ends) : 0.0;
    const double rectangle = inset < 2.0 ? 4.0 * (half_u - inset) * (half_v - inset) : 0.0;
    if (kPi * radius * radius > rectangle) {
        const double less = radius * (1.0 - 0x1p-20) - 2.0 * kExactTestSlack;
        if (less > 0x1p-20 && less < 4.0) return -static_cast<float>(less * (1.0 - 0x1p-23));
    }
    return inset < 2.0 ? round_up(kMore * inset + 2.0 * kExactTestSlack) : BoxBlock::kNoInset;
}

}  // namespace

void fill_block(BoxBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame& frame) {
    fill_lanes(block, ids, table, [&](std::size_t lane, PrimitiveId id) {
        const SlantedBounds bounds = slanted_bounds(table, id);
        const Vec3 middle =
            bounds.corner + 0.5 * bounds.edge[0] + 0.5 * bounds.edge[1] + 0.5 * bounds.edge[2];
        set_point(block.center, lane, frame.local(middle));
        block.radius[lane] = round_up(
            radius_of(bounds, table.sphere(static_cast<std::size_t>(id)), block, lane, frame));
        for (int slab = 0; slab < 3; ++slab) {
            set_point(block.direction[slab], lane, bounds.direction[slab]);
            block.half[slab][lane] = round_up(half_of(bounds, block, lane, slab, frame));
        }
        block.inset[lane] =
            bounds.flat ? inset_of(flat_outline(table, id), table.kind(id) == column_of<Polygon>(),
                                   block, lane, frame)
                        : BoxBlock::kNotFlat;
        return false;
    });
    for (std::size_t lane = ids.size(); lane < kBlockWidth; ++lane) {
        for (auto& half : block.half) half[lane] = -std::numeric_limits<float>::infinity();
    }
}

}  // namespace alhazen

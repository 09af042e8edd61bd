#include "alhazen/aggregates/wide_bvh/leaves/leaf_fill.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {
namespace {

bool same_bits(const Vec3& a, const Vec3& b) {
    const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
    return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
}

/// True when the block holds the very triangle.
bool fill(TriangleBlock& block, std::size_t lane, const std::array<Vec3, 3>& corners,
          const LocalFrame& frame) {
    bool exact = true;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const Vec3 local = frame.local(corners[corner]);
        for (int axis = 0; axis < 3; ++axis) {
            block.vertex[corner][axis][lane] = static_cast<float>(local[axis]);
        }
        exact = exact && same_bits(frame.world(block.corner(corner, lane)), corners[corner]);
    }
    return exact;
}

/// A triangle that few rays come near; those that do are told by the lane's id.
void leave_free(TriangleBlock& block, std::size_t lane) {
    constexpr float kFar[3][3] = {{40, 47, 53}, {41, 45, 52}, {42, 48, 50}};
    for (std::size_t corner = 0; corner < 3; ++corner) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            block.vertex[corner][axis][lane] = kFar[corner][axis];
        }
    }
    block.ids[lane] = BlockId::none();
}

/// For what is rounded in double.
constexpr double kMore = 1.0 + 0x1p-40;

/// Rounds a point into a lane; how far that moves it, at most.
double set_point(float (&rows)[3][kBlockWidth], std::size_t lane, const Vec3& p) {
    double moved = 0;
    for (int axis = 0; axis < 3; ++axis) {
        rows[axis][lane] = static_cast<float>(p[axis]);
        moved += std::abs(p[axis] - static_cast<double>(rows[axis][lane]));
    }
    return moved;
}

/// Calls `fill(lane, id)` for every lane; free lanes repeat the first.
template <class Block, class Fill>
void fill_lanes(Block& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                Fill&& fill) {
    for (std::size_t lane = 0; lane < kBlockWidth; ++lane) {
        const bool used = lane < ids.size();
        const PrimitiveId id = ids[used ? lane : 0];
        fill(lane, id);
        block.ids[lane] = used ? BlockId{id, table.is_opaque(id), false} : BlockId::none();
    }
}

}  // namespace

void fill_block(TriangleBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame& frame) {
    for (std::size_t lane = 0; lane < ids.size(); ++lane) {
        const PrimitiveId id = ids[lane];
        const bool exact = fill(block, lane, table.triangle_vertices(table.index(id)), frame);
        block.ids[lane] = {id, table.is_opaque(id), exact};
    }
    for (std::size_t lane = ids.size(); lane < kBlockWidth; ++lane) leave_free(block, lane);
}

void fill_block(IndexBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame&) {
    for (std::size_t lane = 0; lane < kBlockWidth; ++lane) {
        block.ids[lane] = lane < ids.size() ? BlockId{ids[lane], table.is_opaque(ids[lane]), false}
                                            : BlockId::none();
    }
}

void fill_block(SphereBlock& block, std::span<const PrimitiveId> ids, const PrimitiveTable& table,
                const LocalFrame& frame) {
    const auto& spheres = std::get<ShapeColumn<Sphere>>(table.columns).shapes;
    fill_lanes(block, ids, table, [&](std::size_t lane, PrimitiveId id) {
        const Sphere& sphere = spheres[table.index(id)];
        const double moved = set_point(block.center, lane, frame.local(sphere.center));
        block.radius[lane] = round_up(kMore * (sphere.radius * frame.scale) + moved);
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
        // A point of the shape is at most that far from the center, so turning the axis moves its
        // place along the axis and across it by at most twice this.
        const double away = turned * (height + radius);
        // What the test of the shape is off along the axis, it may be off across it by the slope.
        const double steep = bounds.slope * (4 * kExactTestSlack);
        block.half_height[lane] = round_up(kMore * height + 1.01 * (moved + away));
        block.radius[lane] = round_up(kMore * radius + 1.01 * (moved + 2.0 * away) + steep);
    });
    block.lanes = (1u << ids.size()) - 1;
}

namespace {

/// The center of a box as float has it.
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

/// Half the width of the body along the direction of a slab, as float has that and the center.
double half_of(const SlantedBounds& bounds, const BoxBlock& block, std::size_t lane, int slab,
               const LocalFrame& frame) {
    const auto& d = block.direction[slab];
    const Vec3 along{d[0][lane], d[1][lane], d[2][lane]};
    const double half = largest_of_corners(bounds, center_of(block, lane), frame,
                                           [&](const Vec3& p) { return std::abs(dot(along, p)); });
    return kMore * (half + dot(abs(along), frame.scale * bounds.pad));
}

/// The radius of the ball around the center: the smaller one of that around the body and of that
/// around the sphere which is known of the primitive.
double radius_of(const SlantedBounds& bounds, const BoundingSphere& sphere, const BoxBlock& block,
                 std::size_t lane, const LocalFrame& frame) {
    const Vec3 center = center_of(block, lane);
    const double of_body =
        largest_of_corners(bounds, center, frame, [](const Vec3& p) { return length(p); }) +
        length(frame.scale * bounds.pad);
    const double of_sphere =
        length(frame.local(sphere.center) - center) + frame.scale * sphere.radius;
    // Written so that a NaN is never taken.
    return kMore * (of_sphere < of_body ? of_sphere : of_body);
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
    });
    for (std::size_t lane = ids.size(); lane < kBlockWidth; ++lane) {
        for (auto& half : block.half) half[lane] = -std::numeric_limits<float>::infinity();
    }
}

}  // namespace alhazen

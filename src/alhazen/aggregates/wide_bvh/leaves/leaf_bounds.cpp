#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>

#include "alhazen/aggregates/wide_bvh/leaves/flat_shapes.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {
namespace {

/// Covers the rounding of the box around a polygon, as a factor of its coordinates.
constexpr double kPolygonPad = 0x1p-46;

RoundBounds bounds_of(const Frustum& f) {
    return {f.center, f.axis, f.half_height, std::max(f.base_radius, f.top_radius),
            std::abs(f.slope)};
}

/// The box of a primitive in its own frame, transformed out of it.
SlantedBounds placed_box(const Box3& box, const Affine& outer_from_inner) {
    const Vec3 size = box.hi - box.lo;
    const Mat3& m = outer_from_inner.linear;
    return {outer_from_inner.point(box.lo),
            {size.x * m.x_axis, size.y * m.y_axis, size.z * m.z_axis},
            {unit_or(cross(m.y_axis, m.z_axis), {1, 0, 0}),
             unit_or(cross(m.z_axis, m.x_axis), {0, 1, 0}),
             unit_or(cross(m.x_axis, m.y_axis), {0, 0, 1})},
            {}};
}

SlantedBounds bounds_of(const Rectangle& r) {
    return {r.corner,
            {r.edge_u, r.edge_v, Vec3{}},
            {unit_or(r.u_of, {1, 0, 0}), unit_or(r.v_of, {0, 1, 0}), r.unit_normal},
            {},
            true};
}

/// The distance along each axis by which `box` extends beyond the corners of the bounds.
Vec3 reach_beyond(const SlantedBounds& bounds, const Box3& box) {
    Box3 corners;
    for (int i = 0; i < 8; ++i) {
        Vec3 p = bounds.corner;
        for (int k = 0; k < 3; ++k) {
            if ((i >> k & 1) != 0) p += bounds.edge[k];
        }
        corners.include(p);
    }
    const Vec3 below = abs(corners.lo - box.lo), above = abs(box.hi - corners.hi);
    return {std::max(below.x, above.x), std::max(below.y, above.y), std::max(below.z, above.z)};
}

}  // namespace

bool spheres_join(const PrimitiveTable& table) {
    const auto count = [&](std::uint32_t kind) {
        return table.first(kind + 1) - table.first(kind);
    };
    // Among triangles the schedule counts blocks of spheres as tested in lanes (schedule.h).
    if (count(kTriangleKind) > 0) return false;
    const std::uint32_t others =
        count(column_of<Cylinder>()) + count(column_of<Cone>()) + count(column_of<Disc>());
    return others > 0 && count(column_of<Sphere>()) / kMostSpheresPerFrustum <= others;
}

LeafType leaf_type(const PrimitiveTable& table, PrimitiveId id) {
    const std::uint32_t kind = table.kind(id);
    if (kind == kTriangleKind) return LeafType::Triangles;
    if (table.placement_of(id) != nullptr) return LeafType::Others;
    if (kind == column_of<Sphere>()) {
        return spheres_join(table) ? LeafType::Frustums : LeafType::Spheres;
    }
    if (may_be_in(LeafType::Frustums, kind)) return LeafType::Frustums;
    return LeafType::Others;
}

bool may_be_in(LeafType leaf, std::uint32_t kind) {
    switch (leaf) {
        case LeafType::Triangles:
            return kind == kTriangleKind;
        case LeafType::Spheres:
            return kind == column_of<Sphere>();
        case LeafType::Frustums:
            return kind == column_of<Cylinder>() || kind == column_of<Cone>() ||
                   kind == column_of<Disc>() || kind == column_of<Sphere>();
        case LeafType::Others:
            return kind != kTriangleKind;
    }
    return false;
}

RoundBounds round_bounds(const PrimitiveTable& table, PrimitiveId id) {
    const std::uint32_t kind = table.kind(id);
    if (kind == column_of<Cylinder>()) return bounds_of(shape_of<Cylinder>(table, id).frustum);
    if (kind == column_of<Cone>()) return bounds_of(shape_of<Cone>(table, id).frustum);
    if (kind == column_of<Sphere>()) {
        const Sphere& sphere = shape_of<Sphere>(table, id);
        return {sphere.center, {}, 0, sphere.radius, 0};
    }
    const Disc& disc = shape_of<Disc>(table, id);
    return {disc.center, disc.unit_normal, 0, disc.radius, 0};
}

SlantedBounds slanted_bounds(const PrimitiveTable& table, PrimitiveId id) {
    const Box3 outer = table.box(static_cast<std::uint32_t>(id));
    const Placement* placement = table.placement_of(id);
    SlantedBounds bounds;
    if (table.kind(id) == column_of<Polygon>() && placement == nullptr) {
        bounds = bounds_of(shape_of<Polygon>(table, id));
        bounds.pad = kPolygonPad * (abs(outer.lo) + abs(outer.hi));
    } else if (table.kind(id) == column_of<Rectangle>() && placement == nullptr) {
        bounds = bounds_of(shape_of<Rectangle>(table, id));
        bounds.pad = reach_beyond(bounds, outer);
    } else {
        bounds = placed_box(table.inner_box(id),
                            placement != nullptr ? placement->outer_from_inner : Affine{});
        bounds.pad = reach_beyond(bounds, outer);
    }
    // If the frame takes numbers out of range: the axis-aligned box, which is finite.
    const double reach = max_component(abs(outer.lo)) + max_component(abs(outer.hi));
    if (is_finite(bounds.pad) && max_component(bounds.pad) <= reach) return bounds;
    return placed_box(outer, {});
}

double surface_area(const PrimitiveTable& table, PrimitiveId id) {
    if (table.kind(id) == column_of<Sphere>() && table.placement_of(id) == nullptr) {
        const double radius = shape_of<Sphere>(table, id).radius;
        return 4.0 * kPi * radius * radius;
    }
    switch (leaf_type(table, id)) {
        case LeafType::Triangles: {
            const auto [a, b, c] = table.triangle_vertices(table.index(id));
            return 0.5 * length(cross(b - a, c - a));
        }
        case LeafType::Spheres:
            break;
        case LeafType::Frustums: {
            const RoundBounds bounds = round_bounds(table, id);
            return 2.0 * kPi * bounds.radius * (2.0 * bounds.half_height + bounds.radius);
        }
        case LeafType::Others:
            break;
    }
    const SlantedBounds bounds = slanted_bounds(table, id);
    const auto face = [&](int i, int j) { return length(cross(bounds.edge[i], bounds.edge[j])); };
    return 2.0 * (face(0, 1) + face(1, 2) + face(2, 0));
}

}  // namespace alhazen

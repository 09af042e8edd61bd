/// Bounds of primitives that are tighter than their boxes.
///
/// Source: Akenine-Möller, "Fast 3D Triangle-Box Overlap Testing", Journal of Graphics Tools 6(1),
/// 2001 (triangles: separating axes); Arvo, "A Simple Method for Box-Sphere Intersection Testing",
/// Graphics Gems, 1990; Sutherland and Hodgman, "Reentrant Polygon Clipping", CACM 17(1), 1974.
/// Differs: all tests are conservative: true where rounding leaves the result uncertain.

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "alhazen/primitives/primitive_table.h"

namespace alhazen {
namespace {

/// Rounding error of a coordinate, relative to the largest coordinate it was computed from.
constexpr double kRounding = 0x1p-49;

template <class S, class... T>
consteval std::uint32_t position_in(ShapeTypes<T...>*) {
    constexpr bool kSame[] = {std::is_same_v<S, T>...};
    std::uint32_t i = 0;
    while (!kSame[i]) ++i;
    return i;
}
constexpr std::uint32_t kSphereKind = position_in<Sphere>(static_cast<AnalyticShapes*>(nullptr));

double reach_of(const Box3& box) {
    return std::max(max_component(abs(box.lo)), max_component(abs(box.hi)));
}

bool boxes_overlap(const Box3& a, const Box3& b) {
    return a.lo.x <= b.hi.x && b.lo.x <= a.hi.x && a.lo.y <= b.hi.y && b.lo.y <= a.hi.y &&
           a.lo.z <= b.hi.z && b.lo.z <= a.hi.z;
}

/// True if the surface has a point in the cell.
bool surface_overlaps(const Sphere& sphere, const Box3& cell) {
    const double margin = kRounding * std::max(reach_of(cell), max_component(abs(sphere.center)));
    double near2 = 0, far2 = 0;
    for (int k = 0; k < 3; ++k) {
        const double below = cell.lo[k] - sphere.center[k];
        const double above = sphere.center[k] - cell.hi[k];
        const double near = std::max(0.0, std::max(below, above) - margin);
        const double far = std::max(std::abs(below), std::abs(above)) + margin;
        near2 += near * near;
        far2 += far * far;
    }
    const double radius2 = sphere.radius * sphere.radius;
    return !(near2 > (1.0 + 1e-14) * radius2) && !(far2 < (1.0 - 1e-14) * radius2);
}

/// Overflow never separates.
bool triangle_overlaps(const std::array<Vec3, 3>& corners, const Box3& cell) {
    const Vec3 center = cell.center();
    const Vec3 half = cell.hi - center;
    Vec3 v[3];
    double reach = reach_of(cell);
    for (std::size_t i = 0; i < 3; ++i) {
        v[i] = corners[i] - center;
        reach = std::max(reach, max_component(abs(corners[i])));
    }
    const auto separates = [&](const Vec3& axis) {
        const Vec3 steep = abs(axis);
        const double radius = dot(half, steep);
        const double margin = kRounding * (reach * (steep.x + steep.y + steep.z) + radius);
        const double a = dot(axis, v[0]), b = dot(axis, v[1]), c = dot(axis, v[2]);
        return std::min(a, std::min(b, c)) > radius + margin ||
               std::max(a, std::max(b, c)) < -(radius + margin);
    };
    const Vec3 edges[3] = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
    if (separates(cross(edges[0], edges[1]))) return false;
    for (const Vec3& e : edges) {
        // The cross products of the edge with the axes.
        if (separates({0, -e.z, e.y}) || separates({e.z, 0, -e.x}) || separates({-e.y, e.x, 0})) {
            return false;
        }
    }
    return true;
}

/// A convex polygon, initially a triangle, clipped by axis-aligned planes.
struct ClippedTriangle {
    /// A plane adds one point; if rounding has bent the outline, at most half as many again.
    std::array<Vec3, 32> points;
    std::size_t size = 3;

    void clip(int axis, double plane, bool keeps_lower) {
        const auto inside = [&](const Vec3& p) {
            return keeps_lower ? p[axis] <= plane : p[axis] >= plane;
        };
        std::array<Vec3, 32> kept;
        std::size_t count = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const Vec3 &a = points[i], &b = points[(i + 1) % size];
            if (inside(a)) kept[count++] = a;
            if (inside(a) == inside(b)) continue;
            Vec3 cut = a + ((plane - a[axis]) / (b[axis] - a[axis])) * (b - a);
            cut[axis] = plane;
            kept[count++] = cut;
        }
        points = kept;
        size = count;
    }
};

BoundingSphere placed_sphere(const Affine& to_from, const BoundingSphere& sphere) {
    const Vec3 center = to_from.point(sphere.center);
    // Error terms of the center, whose coordinates are sums of four terms.
    const Vec3 terms = abs(to_from.linear.x_axis) * std::abs(sphere.center.x) +
                       abs(to_from.linear.y_axis) * std::abs(sphere.center.y) +
                       abs(to_from.linear.z_axis) * std::abs(sphere.center.z) +
                       abs(to_from.translation);
    return {center, (1.0 + 1e-15) * (stretch_bound(to_from.linear) * sphere.radius) +
                        2e-15 * max_component(terms)};
}

}  // namespace

BoundingSphere PrimitiveTable::sphere(std::size_t i) const {
    const PrimitiveId id{static_cast<std::uint32_t>(i)};
    if (kind(id) == kSphereKind && placement_of(id) == nullptr) {
        const Sphere& sphere = std::get<ShapeColumn<Sphere>>(columns).shapes[index(id)];
        return {sphere.center, (1.0 + 1e-15) * std::abs(sphere.radius)};
    }
    const BoundingSphere around_box = BoundsSource::sphere(i);
    if (kind(id) != kInstanceKind) return around_box;
    const Instance& instance = instances[index(id)];
    const BoundingSphere placed =
        placed_sphere(instance.placement.outer_from_inner, instance.aggregate->sphere());
    return placed.radius < around_box.radius ? placed : around_box;
}

bool PrimitiveTable::overlaps(std::size_t i, const Box3& cell) const {
    if (!boxes_overlap(box(i), cell)) return false;
    const PrimitiveId id{static_cast<std::uint32_t>(i)};
    const std::uint32_t k = kind(id);
    if (k == kTriangleKind) return triangle_overlaps(triangle_vertices(index(id)), cell);
    if (k == kSphereKind && placement_of(id) == nullptr) {
        const Sphere& sphere = std::get<ShapeColumn<Sphere>>(columns).shapes[index(id)];
        return surface_overlaps(sphere, cell);
    }
    return true;
}

Box3 PrimitiveTable::clipped_box(std::size_t i, const Box3& cell) const {
    const auto corners = triangle(i);
    if (!corners) return BoundsSource::clipped_box(i, cell);
    ClippedTriangle part{{(*corners)[0], (*corners)[1], (*corners)[2]}};
    for (int axis = 0; axis < 3; ++axis) {
        part.clip(axis, cell.lo[axis], false);
        part.clip(axis, cell.hi[axis], true);
    }
    Box3 clipped;
    for (std::size_t p = 0; p < part.size; ++p) clipped.include(part.points[p]);
    return padded(clipped);
}

std::optional<std::array<Vec3, 3>> PrimitiveTable::triangle(std::size_t i) const {
    const PrimitiveId id{static_cast<std::uint32_t>(i)};
    if (kind(id) != kTriangleKind) return std::nullopt;
    return triangle_vertices(index(id));
}

bool PrimitiveTable::blocks_light(std::size_t i) const {
    const PrimitiveId id{static_cast<std::uint32_t>(i)};
    return is_opaque(id) && visible_to(id) == kAllRays;
}

}  // namespace alhazen

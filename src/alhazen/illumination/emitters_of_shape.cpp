#include "alhazen/illumination/emitters_of_shape.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "alhazen/base/overloaded.h"
#include "alhazen/geometry/polygon/triangulate.h"
#include "alhazen/geometry/repair/repaired_polygon.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/primitives/primitive_columns.h"

namespace alhazen {

namespace {

/// The frame of a flat form: `x` and `y` as given; z is the outer normal, along x cross y in the
/// frame of the shape.
Affine flat_frame(const Affine& world, const Vec3& origin, const Vec3& x, const Vec3& y) {
    Affine frame;
    frame.translation = world.point(origin);
    frame.linear.x_axis = world.vector(x);
    frame.linear.y_axis = world.vector(y);
    const Vec3 n = cross(frame.linear.x_axis, frame.linear.y_axis);
    const double side = determinant(world.linear) < 0.0 ? -1.0 : 1.0;
    frame.linear.z_axis = side * unit_or(n, {0, 0, 1});
    return frame;
}

Emitter flat(EmitterForm form, const Affine& world, const Vec3& origin, const Vec3& x,
             const Vec3& y) {
    Emitter e;
    e.form = form;
    e.world_from_own = flat_frame(world, origin, x, y);
    return e;
}

Emitter disc(const Affine& world, const Vec3& center, const Vec3& normal, double radius,
             double inner) {
    const Vec3 n = unit_or(normal, {0, 0, 1}), x = perpendicular(n);
    Emitter e = flat(EmitterForm::Disc, world, center, radius * x, radius * cross(n, x));
    e.inner = inner / radius;
    return e;
}

Emitter curved(EmitterForm form, const Affine& world, const Affine& shape) {
    Emitter e;
    e.form = form;
    e.world_from_own = world * shape;
    return e;
}

Emitter patch(const Affine& world, const BezierNet& net, bool turned) {
    Emitter e = curved(EmitterForm::Patch, world, {});
    e.patch = std::make_shared<const EmittingPatch>(EmittingPatch{net, turned});
    return e;
}

/// The area of triangles in the frame of their shape.
struct PartArea {
    double sum = 0;
    Vec3 vector;  ///< sum of area times normal: shorter than `sum` unless all face one way
};

/// Appends the triangles of corners to the parts of an emitter.
PartArea append_parts(const Affine& world, std::span<const Vec3> corners, EmitterParts& parts) {
    std::vector<std::uint32_t> loop(corners.size());
    for (std::size_t i = 0; i < loop.size(); ++i) loop[i] = static_cast<std::uint32_t>(i);
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangulate(corners, loop, triangles);
    PartArea own;
    double sum = parts.areas.empty() ? 0.0 : parts.areas.back();
    for (const auto& t : triangles) {
        const Vec3 &a = corners[t[0]], &b = corners[t[1]], &c = corners[t[2]];
        const Vec3 area = 0.5 * cross(b - a, c - a);
        own.sum += length(area);
        own.vector += area;
        const Vec3 wa = world.point(a), wb = world.point(b), wc = world.point(c);
        sum += 0.5 * length(cross(wb - wa, wc - wa));
        for (const Vec3& corner : {wa, wb, wc}) parts.corners.push_back(corner);
        parts.areas.push_back(sum);
    }
    return own;
}

/// Largest distance of a polygon's corners from its plane, relative to the root of its area, that
/// is rounding: of floats as far from the origin as a thousand times the size. Farther off, the
/// outline in the plane depends on the direction in which it is seen.
constexpr double kMostOffPlane = 1e-4;

/// The corners of a polygon in its plane, so that no ray to or from a point between them meets it.
std::vector<Vec3> corners_in_plane(const Polygon& p) {
    std::vector<Vec3> corners = p.vertices;
    for (Vec3& corner : corners) corner -= dot(p.normal, corner - p.point) * p.normal;
    return corners;
}

/// The parts of a polygon by the odd-even rule; none if its corners are too far off its plane.
EmitterParts odd_even_parts(const Affine& world, const Polygon& p) {
    const std::vector<Vec3> corners = corners_in_plane(p);
    const RepairedPolygon repaired =
        repaired_polygon(corners, p.loop_ends, {p.normal, dot(p.normal, p.point)});
    EmitterParts parts;
    double area = 0.0;
    for (const std::vector<Vec3>& part : repaired.parts) {
        area += append_parts(world, part, parts).sum;
    }
    if (p.loop_ends.size() <= 1) {
        EmitterParts of_loop;
        const PartArea own = append_parts(world, corners, of_loop);
        // The triangles of a loop that crosses itself cover more than it encloses.
        const bool covers_once = repaired.refused.empty()
                                     ? own.sum <= area * (1.0 + 1e-6)
                                     : own.sum <= length(own.vector) * (1.0 + 1e-9);
        if (covers_once) {
            parts = std::move(of_loop);
            area = own.sum;
        }
    }
    if (p.off_plane <= kMostOffPlane * std::sqrt(area)) return parts;
    return {};
}

/// The emitter of a planar polygon; of one with corners off its plane an emitter without parts.
Emitter polygon(const Affine& world, const Polygon& p) {
    const Vec3 y = cross(p.normal, p.u_axis);
    Emitter e = flat(EmitterForm::Polygon, world, p.point, p.u_axis, y);
    e.parts = std::make_shared<const EmitterParts>(odd_even_parts(world, p));
    return e;
}

// ---- the forms of each shape

using List = std::vector<Emitter>;

void append(const Sphere& s, const Affine& world, List& list) {
    list.push_back(
        curved(EmitterForm::Sphere, world,
               Affine::translate(s.center) * Affine::scale({s.radius, s.radius, s.radius})));
}
void append(const Ellipsoid& s, const Affine& world, List& list) {
    list.push_back(curved(EmitterForm::Sphere, world, {{s.axis_a, s.axis_b, s.axis_c}, s.center}));
}
void append(const Disc& s, const Affine& world, List& list) {
    list.push_back(disc(world, s.center, s.normal, s.radius, s.inner_radius));
}
void append(const Rectangle& s, const Affine& world, List& list) {
    list.push_back(flat(EmitterForm::Rectangle, world, s.corner, s.edge_u, s.edge_v));
}
/// In the order of its parts: -x +x -y +y -z +z.
void append(const BoxShape& s, const Affine& world, List& list) {
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        Vec3 corner = s.lo, x, y;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        x[u] = s.hi[u] - s.lo[u];
        y[v] = s.hi[v] - s.lo[v];
        const bool high = face % 2 == 1;
        if (high) corner[axis] = s.hi[axis];
        list.push_back(high ? flat(EmitterForm::Rectangle, world, corner, x, y)
                            : flat(EmitterForm::Rectangle, world, corner, y, x));
    }
}
/// Its side, and the caps.
void append(const Cylinder& s, const Affine& world, List& list) {
    const Vec3 n = unit_or(s.top - s.base, {0, 0, 1}), x = perpendicular(n);
    list.push_back(curved(EmitterForm::Tube, world,
                          {{s.radius * x, s.radius * cross(n, x), s.top - s.base}, s.base}));
    if (!s.capped) return;
    list.push_back(disc(world, s.base, -n, s.radius, 0.0));
    list.push_back(disc(world, s.top, n, s.radius, 0.0));
}
void append(const Polygon& s, const Affine& world, List& list) {
    list.push_back(polygon(world, s));
}
void append(const BezierPatch& s, const Affine& world, List& list) {
    list.push_back(patch(world, s.net(), false));
}
void append(const PatchMesh& s, const Affine& world, List& list) {
    for (std::size_t i = 0; i < s.patch_count(); ++i) {
        list.push_back(patch(world, s.net(i), i < s.inward.size() && s.inward[i]));
    }
}

std::uint32_t count_of(const BoxShape&) {
    return 6;
}
std::uint32_t count_of(const Cylinder& s) {
    return s.capped ? 3 : 1;
}
std::uint32_t count_of(const PatchMesh& s) {
    return static_cast<std::uint32_t>(s.patch_count());
}
template <class S>
std::uint32_t count_of(const S& s) {
    List* none = nullptr;
    return requires {
        append(s, Affine{}, *none);
    }
    ? 1 : 0;
}

void append_triangle(const PrimitiveTable& table, std::uint32_t triangle, const Affine& world,
                     List& list) {
    const auto [a, b, c] = table.triangle_vertices(triangle);
    Emitter& e = list.emplace_back(flat(EmitterForm::Triangle, world, a, b - a, c - a));
    if (table.mesh_of(triangle).mirrored) {
        e.world_from_own.linear.z_axis = -e.world_from_own.linear.z_axis;
    }
}

}  // namespace

std::uint32_t emitters_of_shape(const PrimitiveTable& table, PrimitiveId id) {
    const std::uint32_t kind = table.kind(id), i = table.index(id);
    if (kind == kInstanceKind) return 0;
    if (kind == kTriangleKind) return table.mesh_of(i).motion ? 0 : 1;
    return with_column(table.columns, kind,
                       [&](const auto& column) { return count_of(column.shapes[i]); });
}

void append_emitters_of_shape(const PrimitiveTable& table, PrimitiveId id,
                              const Affine& world_from_table, std::vector<Emitter>& emitters) {
    const std::uint32_t kind = table.kind(id), i = table.index(id);
    if (kind == kTriangleKind) return append_triangle(table, i, world_from_table, emitters);
    with_column(table.columns, kind, [&](const auto& column) {
        const auto& shape = column.shapes[i];
        const std::uint32_t p = column.placements[i];
        const Affine world = p == kNoPlacement
                                 ? world_from_table
                                 : world_from_table * table.placements[p].outer_from_inner;
        if constexpr (requires { append(shape, world, emitters); }) append(shape, world, emitters);
    });
}

std::optional<Emitter> rectangle_of_halves(const PrimitiveTable& table, PrimitiveId first,
                                           PrimitiveId second) {
    // Largest deviation by rounding of exact corners, relative to the largest coordinate.
    constexpr double kRounding = 8e-16;
    const std::uint32_t one = table.index(first), two = table.index(second);
    if (&table.mesh_of(one) != &table.mesh_of(two)) return std::nullopt;
    const std::array<Vec3, 3> a = table.triangle_vertices(one), b = table.triangle_vertices(two);
    double largest = 0.0;
    for (const Vec3& p : a) largest = std::max(largest, max_component(abs(p)));
    for (std::size_t i = 0; i < 3; ++i) {
        // The corner that is not shared, and the opposite side.
        const Vec3 &corner = a[i], &from = a[(i + 1) % 3], &to = a[(i + 2) % 3];
        const Vec3 x = from - corner, y = to - corner;
        const double xx = length_squared(x), yy = length_squared(y);
        if (!(xx > 0.0 && yy > 0.0) || std::abs(dot(x, y)) > 1e-12 * std::sqrt(xx * yy)) continue;
        for (std::size_t j = 0; j < 3; ++j) {
            // With the same winding the other triangle has that side in the reverse direction.
            if (b[(j + 1) % 3] != to || b[(j + 2) % 3] != from) continue;
            const Vec3 off = b[j] - (from + y);
            if (max_component(abs(off)) > kRounding * largest) return std::nullopt;
            Emitter e;
            e.form = EmitterForm::Rectangle;
            e.world_from_own = flat_frame({}, corner, x, y);
            Vec3& normal = e.world_from_own.linear.z_axis;
            if (table.mesh_of(one).mirrored) normal = -normal;
            return e;
        }
    }
    return std::nullopt;
}

}  // namespace alhazen

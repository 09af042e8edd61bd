#include "alhazen/primitives/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <type_traits>

#include "alhazen/primitives/placed_surface.h"
#include "alhazen/primitives/primitive_columns.h"
#include "alhazen/shapes/core/plain_surface.h"
#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/meshes/triangle_lanes.h"
#include "alhazen/shapes/meshes/triangle_surface.h"

namespace alhazen {

namespace {

constexpr double kEpsilon = 0x1p-53;
inline Vec3 times_abs(const Mat3& m, const Vec3& v) {
    return v.x * abs(m.x_axis) + v.y * abs(m.y_axis) + v.z * abs(m.z_axis);
}

void carry_normals_outward(const Affine& inner, Surface& surface) {
    const bool same = surface.shading_normal == surface.normal;
    const Vec3 normal = normalize(transpose_times(inner.linear, surface.normal));
    if (!same) {
        surface.shading_normal = normalize(transpose_times(inner.linear, surface.shading_normal));
    } else {
        surface.shading_normal = normal;
    }
    surface.normal = normal;
}

/// Transforms a surface out of an inner frame. The new error is the old one plus the rounding of
/// the transform and that of the ray on its way in (which the next ray incurs again).
void carry_outward(const Placement& placement, bool with_uv, Surface& surface) {
    const Affine& outer = placement.outer_from_inner;
    const Affine& inner = placement.inner_from_outer;
    carry_normals_outward(inner, surface);
    if (outer.linear == Mat3{} && inner.linear == Mat3{}) {
        // The general terms below without products with 0 and 1.
        const Vec3 rounded_terms = abs(surface.point) + abs(outer.translation);
        surface.point = surface.point + outer.translation;
        const Vec3 inner_terms = abs(surface.point) + abs(inner.translation);
        surface.error = (surface.error + 4 * kEpsilon * inner_terms) + 4 * kEpsilon * rounded_terms;
        return;
    }
    const Vec3 rounded_terms = times_abs(outer.linear, abs(surface.point)) + abs(outer.translation);
    const Vec3 outer_point = outer.point(surface.point);
    const Vec3 inner_terms = times_abs(inner.linear, abs(outer_point)) + abs(inner.translation);
    surface.error = times_abs(outer.linear, surface.error + 4 * kEpsilon * inner_terms) +
                    4 * kEpsilon * rounded_terms;
    surface.point = outer_point;
    if (!with_uv) return;
    surface.dpdu = outer.linear * surface.dpdu;
    surface.dpdv = outer.linear * surface.dpdv;
    if (surface.is_of_mesh) {
        surface.dpdu2 = outer.linear * surface.dpdu2;
        surface.dpdv2 = outer.linear * surface.dpdv2;
        surface.tangent = outer.linear * surface.tangent;
        surface.bitangent = outer.linear * surface.bitangent;
    }
}

/// Sets the defaults of all extras.
void begin(Surface& surface) {
    if (!surface.has_extras) return;
    surface.tangent = surface.bitangent = {};
    surface.color = {1, 1, 1, 1};
    surface.materials = {};
    surface.weights = {1, 0, 0};
    surface.material_count = 1;
    surface.media = {};
    surface.volume.reset();
    surface.has_extras = false;
}

/// Constructs the result of `shape_surface()` in place, as it is large.
template <class F>
void set_shape_part(Surface& surface, F&& shape_surface) {
    ::new (static_cast<ShapeSurface*>(&surface)) ShapeSurface(shape_surface());
}

/// Copies the first set of coordinates to the second.
void share_coordinates(Surface& surface) {
    surface.uv2 = surface.uv;
    surface.dpdu2 = surface.dpdu;
    surface.dpdv2 = surface.dpdv;
}

/// The largest coordinate of a shape along each axis; along unbounded axes that of the point.
Vec3 reach_of(const Box3& box, const Vec3& point) {
    Vec3 reach;
    for (int k = 0; k < 3; ++k) {
        const double farthest = std::max(std::abs(box.lo[k]), std::abs(box.hi[k]));
        reach[k] = std::isfinite(farthest) ? farthest : std::abs(point[k]);
    }
    return reach;
}

/// reach_of(shape.box(), point).
template <class S>
Vec3 reach_of_shape(const S& shape, const Vec3& point) {
    if constexpr (std::is_same_v<S, Sphere>) {
        if (shape.radius < 0.0) return reach_of(shape.box(), point);
        // As `outward_box` gives: |c| + h is the larger of |c - h| and |c + h|, bit for bit.
        const Vec3 half{shape.radius, shape.radius, shape.radius};
        const Vec3 center = abs(shape.center);
        const Vec3 reach = center + (half + gamma_bound(16) * (center + half));
        constexpr double kLargest = std::numeric_limits<double>::max();
        if (reach.x <= kLargest && reach.y <= kLargest && reach.z <= kLargest) return reach;
    }
    const Vec3 reach = reach_of(shape.box(), point);
    if constexpr (std::is_same_v<S, Quadric>) {
        // Far from its centre the test of an unbounded quadric moves the ray's origin along the
        // ray, which rounds along all axes relative to the point's distance.
        if (!shape.clip_box.bounded()) {
            const double most = max_component(reach);
            return {most, most, most};
        }
    }
    return reach;
}

/// The surface in the shape's own frame. The shape bounds the error of the point; adds the rounding
/// of the next ray's test, which is relative to the size of the shape, not to the position of the
/// point.
template <class S>
void shape_surface(const S& shape, const Ray& ray, const Hit& hit, bool with_uv, Surface& surface) {
    set_shape_part(surface, [&] { return surface_of_shape(shape, ray, hit, with_uv); });
    surface.error += 4 * kEpsilon * reach_of_shape(shape, surface.point);
}

/// Sets the surface of an analytic shape; true if texture coordinates are set.
bool analytic_surface(const PrimitiveTable& table, std::uint32_t kind, std::uint32_t index,
                      const Ray& ray, const Hit& hit, const CoordinateNeed& need,
                      Surface& surface) {
    return with_column(table.columns, kind, [&](const auto& column) {
        surface.is_of_mesh = false;
        const std::uint32_t placement = column.placements[index];
        const bool with_uv = need.of_material(column.materials[index]);
        if (placement == kNoPlacement) {
            shape_surface(column.shapes[index], ray, hit, with_uv, surface);
        } else {
            const Placement& p = table.placements[placement];
            shape_surface(column.shapes[index], transformed(p.inner_from_outer, ray), hit, with_uv,
                          surface);
            carry_outward(p, with_uv, surface);
        }
        surface.materials[0] = column.materials[index];
        surface.part = column.parts.empty() ? 0 : column.parts[index];
        return with_uv;
    });
}

/// Adds the mesh attributes beyond positions, normals and one set of texture coordinates.
void add_vertex_attributes(const TriangleMesh& mesh, std::uint32_t triangle, const Hit& hit,
                           Surface& surface) {
    const auto& corners = mesh.triangles[triangle];
    const std::array<double, 3> weights{1.0 - hit.u - hit.v, hit.u, hit.v};
    if (!mesh.uvs2.empty()) {
        surface.uv2 = {};
        for (std::size_t i = 0; i < 3; ++i) {
            surface.uv2 = surface.uv2 + weights[i] * mesh.uvs2[corners[i]];
        }
        const UvDerivatives derivatives = mesh.uv_derivatives(triangle, mesh.uvs2);
        surface.dpdu2 = derivatives.dpdu;
        surface.dpdv2 = derivatives.dpdv;
    }
    if (!mesh.colors.empty()) {
        surface.has_extras = true;
        surface.color = {0, 0, 0, 0};
        for (std::size_t i = 0; i < 3; ++i) {
            const VertexColor& c = mesh.colors[corners[i]];
            surface.color += weights[i] * Rgba{c.r, c.g, c.b, c.a};
        }
    }
    if (!mesh.tangents.empty()) {
        surface.has_extras = true;
        for (std::size_t i = 0; i < 3; ++i) {
            const VertexTangent& t = mesh.tangents[corners[i]];
            surface.tangent += weights[i] * Vec3{t.x, t.y, t.z};
        }
        // Handedness is constant within a triangle of a well-made mesh.
        surface.bitangent =
            double(mesh.tangents[corners[0]].sign) * cross(surface.shading_normal, surface.tangent);
    }
}

void triangle_surface(const PlacedMesh& placed, std::uint32_t triangle, const Hit& hit,
                      Surface& surface) {
    const TriangleMesh& mesh = *placed.mesh;
    const double reach = set_triangle_surface(mesh, triangle, hit, surface);
    share_coordinates(surface);
    surface.is_of_mesh = true;
    const auto& corners = mesh.triangles[triangle];
    const double rounding = kNextTestRounding * reach;
    surface.error += Vec3{rounding, rounding, rounding};
    if (placed.mirrored) {
        surface.normal = -surface.normal;
        if (mesh.normals.empty()) surface.shading_normal = surface.normal;
    }
    add_vertex_attributes(mesh, triangle, hit, surface);
    surface.materials[0] = placed.material;
    surface.part = placed.part;
    if (!mesh.vertex_materials.empty()) {
        surface.has_extras = true;
        for (std::size_t i = 0; i < 3; ++i) {
            surface.materials[i] = MaterialId{mesh.vertex_materials[corners[i]]};
        }
        surface.weights = {1.0 - hit.u - hit.v, hit.u, hit.v};
        surface.material_count = 3;
    }
}

/// The surface of a triangle whose vertices move.
void moving_triangle_surface(const PlacedMesh& placed, std::uint32_t triangle, const Hit& hit,
                             float time, Surface& surface) {
    PlacedMesh then = placed;
    then.mesh = std::make_shared<const TriangleMesh>(
        placed.motion->triangle_at(*placed.mesh, triangle, time));
    triangle_surface(then, 0, hit, surface);
}

/// Descends the path of instances from level `depth` (outermost = path.size()) inward. True if
/// texture coordinates are set.
bool surface_inside(const Aggregate& aggregate, const Ray& ray, const Hit& hit, std::size_t depth,
                    CoordinateNeed need, float time, Surface& surface) {
    const PrimitiveTable& table = aggregate.primitives();
    // `complete` may replace the material, so the primitive's material does not decide.
    if (need.of_any() && aggregate.changes_materials()) need = CoordinateNeed::all();
    if (depth > 0) {
        const Instance& instance = table.instances[table.index(hit.path[depth - 1])];
        bool with_uv = false;
        if (instance.motion) {
            const Placement placement = instance.motion->at(time);
            with_uv =
                surface_inside(*instance.aggregate, transformed(placement.inner_from_outer, ray),
                               hit, depth - 1, need, time, surface);
            carry_outward(placement, with_uv, surface);
        } else {
            with_uv = surface_inside(*instance.aggregate, inner_ray(instance, ray), hit, depth - 1,
                                     need, time, surface);
            carry_outward(instance.placement, with_uv, surface);
        }
        if (!instance.holds_rest) surface.instance = instance.part;
        if (surface.media.known) surface.media.place_in(instance.part);
        if (instance.of_shared_mesh) surface.part = instance.part;
        aggregate.complete(ray, hit.t, hit.path[depth - 1], surface);
        return with_uv;
    }
    const std::uint32_t kind = table.kind(hit.primitive);
    const std::uint32_t index = static_cast<std::uint32_t>(hit.primitive) - table.first(kind);
    bool with_uv = need.of_any();
    if (kind == kTriangleKind) {
        const PlacedMesh& placed = table.mesh_of(index);
        const std::uint32_t triangle = index - placed.first_triangle;
        if (placed.motion) {
            moving_triangle_surface(placed, triangle, hit, time, surface);
        } else {
            triangle_surface(placed, triangle, hit, surface);
        }
    } else {
        with_uv = analytic_surface(table, kind, index, ray, hit, need, surface);
    }
    surface.instance = surface.part;
    aggregate.complete(ray, hit.t, hit.primitive, surface);
    return with_uv;
}

}  // namespace

Surface surface_at(const Aggregate& aggregate, const Ray& ray, const Hit& hit, float time) {
    Surface surface;
    set_surface(aggregate, ray, hit, CoordinateNeed::all(), surface, time);
    return surface;
}

void set_surface(const Aggregate& aggregate, const Ray& ray, const Hit& hit,
                 const CoordinateNeed& need, Surface& surface, float time) {
    begin(surface);
    const bool with_uv = surface_inside(aggregate, ray, hit, hit.path.size(), need, time, surface);
    if (with_uv && !surface.is_of_mesh) share_coordinates(surface);
}

Hit hit_of_face(const AnyShape& shape, const Placement* placement, const Ray& ray, double t,
                std::uint32_t face) {
    Hit hit;
    hit.t = t;
    hit.part = face;
    if (const auto* rectangle = std::get_if<Rectangle>(&shape)) {
        const Ray own = placement == nullptr ? ray : transformed(placement->inner_from_outer, ray);
        const Vec3 offset = (own.origin - rectangle->corner) + t * own.direction;
        hit.u = std::clamp(dot(rectangle->u_of, offset), 0.0, 1.0);
        hit.v = std::clamp(dot(rectangle->v_of, offset), 0.0, 1.0);
    }
    return hit;
}

void set_shape_surface(const AnyShape& shape, const Placement* placement, const Ray& ray,
                       const Hit& hit, bool with_uv, Surface& surface) {
    begin(surface);
    surface.is_of_mesh = false;
    const Ray own = placement == nullptr ? ray : transformed(placement->inner_from_outer, ray);
    std::visit([&](const auto& s) { shape_surface(s, own, hit, with_uv, surface); }, shape);
    if (placement != nullptr) carry_outward(*placement, with_uv, surface);
    if (with_uv) share_coordinates(surface);
}

void set_mesh_surface(const PlacedMesh& mesh, std::uint32_t triangle, const Placement* placement,
                      const Hit& hit, Surface& surface) {
    begin(surface);
    triangle_surface(mesh, triangle, hit, surface);
    if (placement != nullptr) carry_outward(*placement, true, surface);
}

HitParts parts_of(const Aggregate& aggregate, const Hit& hit) {
    const PrimitiveTable* table = &aggregate.primitives();
    const Instance* outermost = nullptr;
    const Instance* shared_mesh = nullptr;
    for (std::size_t level = hit.path.size(); level-- > 0;) {
        const Instance& instance = table->instances[table->index(hit.path[level])];
        if (outermost == nullptr && !instance.holds_rest) outermost = &instance;
        shared_mesh = instance.of_shared_mesh ? &instance : nullptr;
        table = &instance.aggregate->primitives();
    }
    const std::uint32_t kind = table->kind(hit.primitive);
    const std::uint32_t index = static_cast<std::uint32_t>(hit.primitive) - table->first(kind);
    HitParts parts;
    if (shared_mesh != nullptr) {
        parts.part = shared_mesh->part;
    } else if (kind == kTriangleKind) {
        parts.part = table->mesh_of(index).part;
    } else {
        parts.part = with_column(table->columns, kind, [&](const auto& column) {
            return column.parts.empty() ? 0 : column.parts[index];
        });
    }
    parts.instance = outermost != nullptr ? outermost->part : parts.part;
    return parts;
}

RayMask mask_at(const Aggregate& aggregate, const Hit& hit) {
    const PrimitiveTable* table = &aggregate.primitives();
    RayMask mask = kAllRays;
    for (std::size_t level = hit.path.size(); level-- > 0;) {
        mask &= table->visible_to(hit.path[level]);
        table = &table->instances[table->index(hit.path[level])].aggregate->primitives();
    }
    return mask & table->visible_to(hit.primitive);
}

std::optional<MaterialId> plain_material(const Aggregate& aggregate, const Hit& hit) {
    const Aggregate* innermost = &aggregate;
    for (std::size_t i = hit.path.size(); i-- > 0;) {
        if (innermost->changes_materials()) return std::nullopt;
        const PrimitiveTable& table = innermost->primitives();
        innermost = table.instances[table.index(hit.path[i])].aggregate.get();
    }
    if (innermost->changes_materials()) return std::nullopt;
    const PrimitiveTable& table = innermost->primitives();
    const std::uint32_t kind = table.kind(hit.primitive);
    const std::uint32_t index = static_cast<std::uint32_t>(hit.primitive) - table.first(kind);
    if (kind != kTriangleKind) {
        return with_column(table.columns, kind,
                           [&](const auto& column) { return column.materials[index]; });
    }
    const PlacedMesh& placed = table.mesh_of(index);
    const bool varies = !placed.mesh->vertex_materials.empty() || !placed.mesh->colors.empty();
    return varies ? std::nullopt : std::optional(placed.material);
}

Ray leaving_ray(const ShapeSurface& surface, const Vec3& direction, double t_max) {
    return LeavingRays(surface).along(direction, t_max);
}

}  // namespace alhazen

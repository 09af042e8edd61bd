#include "alhazen/renderers/manifold/normal_change.h"

#include <cmath>
#include <type_traits>

#include "alhazen/primitives/primitive_columns.h"

namespace alhazen {

namespace {

/// (v - (v n) n) / length: the derivative of a unit vector whose unnormalised derivative is v.
Vec3 across(const Vec3& v, const Vec3& n, double length) {
    return (v - dot(v, n) * n) / length;
}

/// A normal and its derivative; empty without a formula.
struct NormalAndChange {
    Vec3 normal;
    Mat3 change;
};
using MaybeChange = std::optional<NormalAndChange>;
constexpr Mat3 kNoChange{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};

template <class S>
inline constexpr bool is_flat_v =
    std::is_same_v<S, Plane> || std::is_same_v<S, Disc> || std::is_same_v<S, Rectangle> ||
    std::is_same_v<S, BoxShape> || std::is_same_v<S, Polygon> || std::is_same_v<S, HalfSpace> ||
    std::is_same_v<S, Polyhedron> || std::is_same_v<S, HeightField>;

template <class S>
inline constexpr bool is_quadric_v =
    std::is_same_v<S, Quadric> || std::is_same_v<S, Ellipsoid> || std::is_same_v<S, Paraboloid> ||
    std::is_same_v<S, Hyperboloid> || std::is_same_v<S, TwoSheetHyperboloid> ||
    std::is_same_v<S, EllipticCylinder> || std::is_same_v<S, EllipticCone>;

/// The gradient's derivative is the matrix of second derivatives; frames are changed by the
/// transposed matrix.
MaybeChange change_on_quadric(const ClippedQuadric& solid, const Vec3& point) {
    const Mat3& local = solid.frame.local_from_object;
    const QuadricForm& form = solid.quadric.form();
    const Vec3 gradient =
        transpose_times(local, form.gradient(local * (point - solid.frame.origin)));
    const double steep = length(gradient);
    if (!(steep > 0.0)) return std::nullopt;
    const Vec3 out = gradient / steep;
    const auto of = [&](const Vec3& axis) {
        const Vec3 v = local * axis;
        const auto half = form.times(Point3<double>{v.x, v.y, v.z});
        return across(transpose_times(local, 2.0 * Vec3{half.x, half.y, half.z}), out, steep);
    };
    return NormalAndChange{out, {of({1, 0, 0}), of({0, 1, 0}), of({0, 0, 1})}};
}

/// `point` and the unit `normal` (of either sign) are in the frame of the shape.
template <class S>
MaybeChange change_on(const S& shape, const ShapeHit& hit, const Vec3& point, const Vec3& normal) {
    if constexpr (is_flat_v<S>) {
        return NormalAndChange{normal, kNoChange};
    } else if constexpr (std::is_same_v<S, Sphere>) {
        const Vec3 out = (point - shape.center) / shape.radius;
        const double r = shape.radius;
        return NormalAndChange{
            out, {across({1, 0, 0}, out, r), across({0, 1, 0}, out, r), across({0, 0, 1}, out, r)}};
    } else if constexpr (std::is_same_v<S, Cylinder>) {
        const Vec3 axis = normalize(shape.top - shape.base);
        if (std::abs(dot(axis, normal)) > 0.5) return NormalAndChange{normal, kNoChange};
        const Vec3 from_base = point - shape.base;
        const Vec3 out = normalize(from_base - dot(from_base, axis) * axis);
        const auto of = [&](const Vec3& v) {
            return across(v - dot(v, axis) * axis, out, shape.radius);
        };
        return NormalAndChange{out, {of({1, 0, 0}), of({0, 1, 0}), of({0, 0, 1})}};
    } else if constexpr (is_quadric_v<S>) {
        if (hit.part != 0) return NormalAndChange{normal, kNoChange};
        return change_on_quadric(shape.solid, point);
    } else {
        return std::nullopt;
    }
}

/// For the normal interpolated over a triangle, in the frame of the mesh.
MaybeChange change_on_triangle(const TriangleMesh& mesh, std::uint32_t triangle, const Hit& hit,
                               const Vec3& flat) {
    if (mesh.normals.empty()) return NormalAndChange{flat, kNoChange};
    const auto& c = mesh.triangles[triangle];
    const Vec3 a = mesh.positions[c[1]] - mesh.positions[c[0]];
    const Vec3 b = mesh.positions[c[2]] - mesh.positions[c[0]];
    const Vec3 normal = cross(a, b);
    const double squared = length_squared(normal);
    if (!(squared > 0.0)) return std::nullopt;
    // The weights' derivatives are dot(dp, ga), dot(dp, gb).
    const Vec3 ga = cross(b, normal) / squared, gb = cross(normal, a) / squared;
    const Vec3 na = mesh.normals[c[1]] - mesh.normals[c[0]];
    const Vec3 nb = mesh.normals[c[2]] - mesh.normals[c[0]];
    const Vec3 sum = mesh.normals[c[0]] + hit.u * na + hit.v * nb;
    const double size = length(sum);
    if (!(size > 0.0)) return std::nullopt;
    const Vec3 n = sum / size;
    const auto of = [&](double along_a, double along_b) {
        return across(along_a * na + along_b * nb, n, size);
    };
    return NormalAndChange{n, {of(ga.x, gb.x), of(ga.y, gb.y), of(ga.z, gb.z)}};
}

/// Transforms it out of a placed frame: n ~ transpose(inner) own, dp_own = inner dp.
MaybeChange carried_outward(const Placement& placement, const MaybeChange& own) {
    if (!own) return own;
    const Mat3& inner = placement.inner_from_outer.linear;
    const Vec3 normal = transpose_times(inner, own->normal);
    const double size = length(normal);
    const Vec3 n = normal / size;
    const Mat3 change = own->change * inner;
    const auto of = [&](const Vec3& column) {
        return across(transpose_times(inner, column), n, size);
    };
    return NormalAndChange{n, {of(change.x_axis), of(change.y_axis), of(change.z_axis)}};
}

MaybeChange change_inside(const Aggregate& aggregate, const Hit& hit, std::size_t depth,
                          const Vec3& point, const Vec3& normal, float time) {
    const PrimitiveTable& table = aggregate.primitives();
    const auto own_normal = [&](const Placement& p) {
        return normalize(transpose_times(p.outer_from_inner.linear, normal));
    };
    if (depth > 0) {
        const Instance& instance = table.instances[table.index(hit.path[depth - 1])];
        const Placement p = placement_at(instance, time);
        return carried_outward(
            p, change_inside(*instance.aggregate, hit, depth - 1, p.inner_from_outer.point(point),
                             own_normal(p), time));
    }
    const std::uint32_t kind = table.kind(hit.primitive), index = table.index(hit.primitive);
    if (kind == kTriangleKind) {
        const PlacedMesh& placed = table.mesh_of(index);
        if (placed.motion) return std::nullopt;
        return change_on_triangle(*placed.mesh, index - placed.first_triangle, hit, normal);
    }
    return with_column(table.columns, kind, [&](const auto& column) -> MaybeChange {
        const std::uint32_t placement = column.placements[index];
        if (placement == kNoPlacement) return change_on(column.shapes[index], hit, point, normal);
        const Placement& p = table.placements[placement];
        return carried_outward(p, change_on(column.shapes[index], hit,
                                            p.inner_from_outer.point(point), own_normal(p)));
    });
}

/// Differences of point and normal between two neighbours of a hit.
struct Difference {
    Vec3 point, normal;
};

/// Neighbours of a hit: by its parameters, for patches and swept shapes, which are evaluated there,
/// or by its position on its ray, for other shapes, which project it onto their surface.
class Neighbours {
  public:
    Neighbours(const Aggregate& aggregate, const Ray& ray, const Hit& hit, const Surface& surface,
               float time)
        : aggregate_(aggregate), ray_(ray), hit_(hit), surface_(surface), time_(time) {}

    [[nodiscard]] Difference by_parameter(double ShapeHit::*parameter) {
        constexpr double kStep = 1e-5;
        const auto at = [&](double step) {
            Hit moved = hit_;
            moved.*parameter += step;
            return set(ray_, moved);
        };
        return between(at(kStep), at(-kStep));
    }
    [[nodiscard]] Difference by_place(const Vec3& along) {
        const double away = length(surface_.point - ray_.origin);
        const double step = 3e-6 * (away + max_component(abs(surface_.point)));
        const auto at = [&](double side) {
            Ray moved = ray_;
            moved.origin += side * along;
            return set(moved, hit_);
        };
        return between(at(step), at(-step));
    }

  private:
    [[nodiscard]] Difference set(const Ray& ray, const Hit& hit) {
        set_surface(aggregate_, ray, hit, CoordinateNeed::none(), neighbour_, time_);
        const bool turned = dot(neighbour_.shading_normal, surface_.shading_normal) < 0.0;
        return {neighbour_.point, turned ? -neighbour_.shading_normal : neighbour_.shading_normal};
    }
    /// Components along the normal are mere rounding and are removed.
    [[nodiscard]] Difference between(const Difference& a, const Difference& b) const {
        const Vec3 moved = a.point - b.point;
        return {moved - dot(moved, surface_.normal) * surface_.normal, a.normal - b.normal};
    }

    const Aggregate& aggregate_;
    const Ray& ray_;
    const Hit& hit_;
    const Surface& surface_;
    float time_;
    Surface neighbour_;
};

}  // namespace

std::optional<Mat3> normal_change_by_differences(const Aggregate& aggregate, const Ray& ray,
                                                 const Hit& hit, const Surface& surface,
                                                 float time) {
    const Vec3& n = surface.normal;
    const Vec3 t = perpendicular(n), b = cross(n, t);
    Neighbours near(aggregate, ray, hit, surface, time);
    Difference found[2];
    int count = 0;
    // Two neighbours that move the point in different directions are sufficient.
    const auto add = [&](const Difference& d) {
        constexpr double kMoves = 1e-9, kSlant = 0.05;
        if (!(length(d.point) > kMoves * max_component(abs(surface.point))) || count == 2) return;
        if (count == 1) {
            const Vec3& other = found[0].point;
            const double area = length(cross(other, d.point));
            if (!(area > kSlant * length(other) * length(d.point))) return;
        }
        found[count++] = d;
    };
    add(near.by_parameter(&ShapeHit::u));
    add(near.by_parameter(&ShapeHit::v));
    if (count < 2) add(near.by_place(t));
    if (count < 2) add(near.by_place(b));
    if (count < 2) return std::nullopt;
    // Solves K points[i] = normals[i], in the coordinates along t and b.
    const double tt = dot(found[0].point, t), tb = dot(found[0].point, b);
    const double bt = dot(found[1].point, t), bb = dot(found[1].point, b);
    const double determinant = tt * bb - tb * bt;
    if (!(std::abs(determinant) > 0.0)) return std::nullopt;
    const Vec3 of_t = (bb * found[0].normal - tb * found[1].normal) / determinant;
    const Vec3 of_b = (tt * found[1].normal - bt * found[0].normal) / determinant;
    return Mat3{t.x * of_t + b.x * of_b, t.y * of_t + b.y * of_b, t.z * of_t + b.z * of_b};
}

std::optional<Mat3> normal_change(const Aggregate& aggregate, const Ray& ray, const Hit& hit,
                                  const Surface& surface, float time) {
    const MaybeChange own =
        change_inside(aggregate, hit, hit.path.size(), surface.point, surface.shading_normal, time);
    if (!own) return normal_change_by_differences(aggregate, ray, hit, surface, time);
    if (dot(own->normal, surface.shading_normal) >= 0.0) return own->change;
    const Mat3& k = own->change;
    return Mat3{-k.x_axis, -k.y_axis, -k.z_axis};
}

}  // namespace alhazen

#include "alhazen/session/technical/feature_curves.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/session/conversion/tessellated.h"
#include "alhazen/session/technical/mesh_edges.h"
#include "alhazen/session/technical/solid_curves.h"
#include "alhazen/session/technical/solid_faces.h"

namespace alhazen {

namespace {

/// Adds curves given in the space of a shape.
class CurvePlacer {
  public:
    CurvePlacer(const Affine& world, const BeamApex& eye, std::vector<FeatureCurve>& curves)
        : world_(world), inverse_(inverse(world)), curves_(curves) {
        eye_ = {inverse_.linear * eye.at + eye.weight * inverse_.translation, eye.weight};
    }
    /// The eye in the space of the shape.
    [[nodiscard]] const BeamApex& eye() const { return eye_; }
    [[nodiscard]] bool faces(const Vec3& normal, const Vec3& point) const {
        return dot(normal, eye_.at - eye_.weight * point) > 0.0;
    }
    void add(FeatureCurve curve) {
        curve.points = {world_.point(curve.points.origin), world_.vector(curve.points.u),
                        world_.vector(curve.points.v)};
        for (CurveForm* form : {&curve.out, &curve.other_out}) {
            for (Vec3* n : {&form->origin, &form->u, &form->v}) {
                *n = transpose_times(inverse_.linear, *n);
            }
        }
        curves_.push_back(curve);
    }
    void add_line(LineStyle style, const Vec3& a, const Vec3& b, const Vec3& out,
                  const Vec3& other_out, double off = 0) {
        FeatureCurve curve;
        curve.points = {a, b - a, {}};
        curve.out.origin = out;
        curve.other_out.origin = other_out;
        curve.style = style;
        curve.off = off;
        add(curve);
    }
    /// Adds an edge where two faces meet.
    void add_edge(const Vec3& a, const Vec3& b, const Vec3& n, const Vec3& m, double off = 0) {
        const bool ends = faces(n, a) != faces(m, a);
        add_line(ends ? LineStyle::Silhouette : LineStyle::Crease, a, b, n, m, off);
    }
    /// Adds the border of a two-sided face.
    void add_border(const Vec3& a, const Vec3& b, const Vec3& n, double off = 0) {
        const Vec3 out = faces(n, a) ? n : -n;
        add_line(LineStyle::Silhouette, a, b, out, out, off);
    }

  private:
    Affine world_, inverse_;
    BeamApex eye_;
    std::vector<FeatureCurve>& curves_;
};

void add_curves(const Sphere& s, CurvePlacer& placer) {
    const BeamApex& eye = placer.eye();
    const Vec3 d = eye.at - eye.weight * s.center;
    const double distance = length(d);
    const double share = eye.weight * s.radius / distance;
    if (!(distance > 0.0) || share >= 1.0) return;
    const Vec3 axis = d / distance, u = normalize(perpendicular(axis)), v = cross(axis, u);
    const double radius = s.radius * std::sqrt(1.0 - share * share);
    const Vec3 up = (s.radius * share) * axis;
    FeatureCurve curve;
    curve.round = true;
    curve.points = {s.center + up, radius * u, radius * v};
    curve.out = curve.other_out = {up, radius * u, radius * v};
    curve.to = 2 * kPi;
    curve.style = LineStyle::Silhouette;
    placer.add(curve);
}

/// Adds the rims and the two outline lines of a frustum.
void add_frustum(const Vec3& base, const Vec3& top, double base_radius, double top_radius,
                 CurvePlacer& placer) {
    const double height = length(top - base), fall = base_radius - top_radius;
    const Vec3 axis = (top - base) / height;
    const Vec3 x = normalize(perpendicular(axis)), y = cross(axis, x);
    const BeamApex& eye = placer.eye();
    const Vec3 e = eye.at - eye.weight * base;
    // The side faces the eye where reach * cos(angle - middle) > least.
    const double reach = height * std::hypot(dot(e, x), dot(e, y));
    const double least = height * base_radius * eye.weight - fall * dot(e, axis);
    const double middle = std::atan2(dot(e, y), dot(e, x));
    std::vector<double> angles;
    if (std::abs(least) < reach) {
        const double half = std::acos(least / reach);
        angles = {middle - half, middle + half};
    }
    for (const double angle : angles) {
        const Vec3 out = std::cos(angle) * x + std::sin(angle) * y;
        const Vec3 normal = height * out + fall * axis;
        placer.add_line(LineStyle::Silhouette, base + base_radius * out, top + top_radius * out,
                        normal, normal);
    }
    if (angles.empty()) angles = {0.0};
    for (const bool at_top : {false, true}) {
        const double radius = at_top ? top_radius : base_radius;
        if (!(radius > 0.0)) continue;
        const Vec3 center = at_top ? top : base, cap = at_top ? axis : -axis;
        for (std::size_t k = 0; k < angles.size(); ++k) {
            FeatureCurve rim;
            rim.round = true;
            rim.points = {center, radius * x, radius * y};
            rim.out = {fall * axis, height * x, height * y};
            rim.other_out = {cap, {}, {}};
            rim.from = angles[k];
            rim.to = k + 1 < angles.size() ? angles[k + 1] : angles[0] + 2 * kPi;
            const double between = 0.5 * (rim.from + rim.to);
            const bool side = reach * std::cos(between - middle) > least;
            rim.style =
                side != placer.faces(cap, center) ? LineStyle::Silhouette : LineStyle::Crease;
            placer.add(rim);
        }
    }
}

void add_curves(const BoxShape& s, CurvePlacer& placer) {
    for (int axis = 0; axis < 3; ++axis) {
        for (int k = 0; k < 4; ++k) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            Vec3 a, n, m;
            a[axis] = s.lo[axis];
            a[u] = (k & 1) != 0 ? s.hi[u] : s.lo[u];
            a[v] = (k & 2) != 0 ? s.hi[v] : s.lo[v];
            Vec3 b = a;
            b[axis] = s.hi[axis];
            n[u] = (k & 1) != 0 ? 1 : -1;
            m[v] = (k & 2) != 0 ? 1 : -1;
            placer.add_edge(a, b, n, m);
        }
    }
}

void add_loop(std::span<const Vec3> loop, const Vec3& normal, CurvePlacer& placer) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
        placer.add_border(loop[k], loop[k + 1 == loop.size() ? 0 : k + 1], normal);
    }
}

/// Adds the curves of a shape in closed form; false if it has none.
bool add_exact(const AnyShape& shape, CurvePlacer& placer) {
    if (const auto* s = std::get_if<Sphere>(&shape)) {
        add_curves(*s, placer);
    } else if (const auto* c = std::get_if<Cylinder>(&shape)) {
        add_frustum(c->base, c->top, c->radius, c->radius, placer);
    } else if (const auto* k = std::get_if<Cone>(&shape)) {
        add_frustum(k->base, k->top, k->base_radius, k->top_radius, placer);
    } else if (const auto* b = std::get_if<BoxShape>(&shape)) {
        add_curves(*b, placer);
    } else if (const auto* r = std::get_if<Rectangle>(&shape)) {
        const std::array<Vec3, 4> loop{r->corner, r->corner + r->edge_u,
                                       r->corner + r->edge_u + r->edge_v, r->corner + r->edge_v};
        add_loop(loop, cross(r->edge_u, r->edge_v), placer);
    } else if (const auto* p = std::get_if<Polygon>(&shape)) {
        Polygon prepared = *p;
        prepared.prepare();
        std::size_t first = 0;
        for (std::size_t l = 0; l < std::max<std::size_t>(p->loop_ends.size(), 1); ++l) {
            const std::size_t end = p->loop_ends.empty() ? p->vertices.size() : p->loop_ends[l];
            add_loop(std::span(p->vertices).subspan(first, end - first), prepared.normal, placer);
            first = end;
        }
    } else {
        return false;
    }
    return true;
}

/// Walks the objects of a description; `triangles` is its tessellation.
class CurveGatherer {
  public:
    CurveGatherer(const SceneDescription& d, const SceneDescription& triangles, const BeamApex& eye,
                  double tolerance)
        : d_(d), triangles_(triangles), eye_(eye), tolerance_(tolerance) {}

    std::vector<FeatureCurve> gather(std::vector<std::string>& left_out) {
        add_object(static_cast<std::size_t>(d_.root), {});
        add_crossings(left_out);
        return std::move(curves_);
    }

  private:
    /// A part or solid with faces, in world space.
    struct Body {
        Part part;
        Box3 box;
    };

    void add_body(Part part, const Affine& placed) {
        part.object_from_part = placed;
        const std::optional<FacedSolid> faced = FacedSolid::of(d_, {&part, 1});
        if (faced) bodies_.push_back({std::move(part), faced->box()});
    }

    /// Adds the curves in which bodies cross.
    void add_crossings(std::vector<std::string>& left_out) {
        constexpr std::size_t kMostPairs = 2000;
        std::sort(bodies_.begin(), bodies_.end(),
                  [](const Body& a, const Body& b) { return a.box.lo.x < b.box.lo.x; });
        std::size_t pairs = 0;
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            const Box3& box = bodies_[i].box;
            for (std::size_t k = i + 1; k < bodies_.size(); ++k) {
                if (bodies_[k].box.lo.x >= box.hi.x) break;
                // Bodies that only touch do not cross.
                const Vec3 shared = intersection(box, bodies_[k].box).size();
                const double least = 1e-9 * length(box.size());
                if (!(std::min({shared.x, shared.y, shared.z}) > least)) continue;
                if (++pairs > kMostPairs) {
                    left_out.push_back(
                        "lines where objects penetrate each other: more than 2000 "
                        "pairs overlap");
                    return;
                }
                add_crossing(bodies_[i].part, bodies_[k].part);
            }
        }
    }
    void add_crossing(const Part& a, const Part& b) {
        const std::array<Part, 2> parts{a, b};
        const std::optional<FacedSolid> both = FacedSolid::of(d_, parts),
                                        one = FacedSolid::of(d_, {&a, 1}),
                                        other = FacedSolid::of(d_, {&b, 1});
        if (both && one && other) add_crossing_curves(*both, *one, *other, eye_, curves_);
    }

    void add_object(std::size_t index, const Affine& world) {
        const bool solid = d_.objects[index].combine != Combine::Group;
        if (solid) {
            const std::optional<FacedSolid> faced = FacedSolid::of(d_, index, world);
            if (faced && add_solid_curves(*faced, eye_, curves_)) {
                Part part;
                part.what = ObjectIndex{static_cast<std::uint32_t>(index)};
                return add_body(std::move(part), world);
            }
        }
        const std::vector<Part>& parts = (solid ? triangles_ : d_).objects[index].parts;
        for (std::size_t k = 0; k < parts.size(); ++k) {
            const Part& part = parts[k];
            if ((part.visible_to & mask_of(RayKind::Eye)) == 0) continue;
            const Affine placed = world * part.object_from_part;
            if (const auto* child = std::get_if<ObjectIndex>(&part.what)) {
                if (!solid) add_object(static_cast<std::size_t>(*child), placed);
                continue;
            }
            CurvePlacer placer(placed, eye_, curves_);
            const auto* shape = std::get_if<AnyShape>(&part.what);
            if (shape != nullptr && add_exact(*shape, placer)) {
                if (!solid) add_body(part, placed);
                continue;
            }
            const auto* mesh = std::get_if<MeshIndex>(&triangles_.objects[index].parts[k].what);
            if (mesh == nullptr) continue;
            const MeshSource source = solid              ? MeshSource::Solid
                                      : shape == nullptr ? MeshSource::Itself
                                                         : MeshSource::Shape;
            add_mesh(*triangles_.meshes[static_cast<std::size_t>(*mesh)].mesh,
                     source == MeshSource::Itself ? 0.0 : tolerance_, source, placer);
        }
    }

    static void add_mesh(const TriangleMesh& mesh, double off, MeshSource source,
                         CurvePlacer& placer) {
        for (const MeshEdge& e : mesh_edges(mesh, placer.eye(), source)) {
            if (e.kind == MeshEdge::Kind::Border) {
                placer.add_border(e.a, e.b, e.out, off);
            } else if (e.kind == MeshEdge::Kind::Edge) {
                placer.add_edge(e.a, e.b, e.out, e.other_out, off);
            } else {
                placer.add_line(LineStyle::Silhouette, e.a, e.b, e.out, e.other_out, off);
            }
        }
    }

    const SceneDescription& d_;
    const SceneDescription& triangles_;
    BeamApex eye_;
    double tolerance_;
    std::vector<FeatureCurve> curves_;
    std::vector<Body> bodies_;
};

}  // namespace

std::vector<FeatureCurve> feature_curves(const SceneDescription& description, const BeamApex& eye,
                                         double tolerance, std::vector<std::string>& left_out) {
    SceneDescription triangles = description;
    for (ObjectDescription& object : triangles.objects) {
        if (object.combine != Combine::Group) continue;
        for (Part& part : object.parts) {
            // Shapes with exact curves need no triangles.
            const auto* s = std::get_if<AnyShape>(&part.what);
            if (s != nullptr &&
                (std::holds_alternative<Sphere>(*s) || std::holds_alternative<Cylinder>(*s) ||
                 std::holds_alternative<Cone>(*s) || std::holds_alternative<Polygon>(*s))) {
                part.what = AnyShape{BoxShape{{0, 0, 0}, {1, 1, 1}}};
            }
        }
    }
    left_out = tessellate(triangles, tolerance, true).kept;
    return CurveGatherer(description, triangles, eye, tolerance).gather(left_out);
}

}  // namespace alhazen

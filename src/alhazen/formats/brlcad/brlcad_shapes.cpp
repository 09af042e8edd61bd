#include "alhazen/formats/brlcad/brlcad_shapes.h"

#include <cmath>

#include "alhazen/formats/brlcad/brlcad_quadrics.h"

namespace alhazen {

namespace {

/// Adds a piece if its shape is valid; otherwise sets the reason.
template <class S>
void add(BrlcadPieces& pieces, S shape, const Affine& solid_from_shape = {}) {
    Diagnostics findings;
    shape.validate({}, findings);
    if (findings.error_count() != 0) {
        pieces.refused = "is not a solid: " + findings.all().front().message;
        return;
    }
    pieces.pieces.push_back({AnyShape(std::move(shape)), solid_from_shape});
}

/// `direction` scaled to the length of `other`.
Vec3 as_long_as(const Vec3& direction, const Vec3& other) {
    return (length(other) / length(direction)) * direction;
}

/// True if two axes that the solid's definition takes as perpendicular are not.
bool is_oblique(const Vec3& a, const Vec3& b) {
    constexpr double kLargestCosine = 1e-4;
    return std::abs(dot(a, b)) > kLargestCosine * length(a) * length(b);
}
/// True if two axes that the definition takes as parallel are not. A zero axis is parallel to all.
bool is_turned(const Vec3& a, const Vec3& b) {
    constexpr double kLargestSine = 1e-4;
    return length(cross(a, b)) > kLargestSine * length(a) * length(b);
}

/// The boundary plane of a half space, through its point nearest to the origin.
OrientedPlane plane_of(const BrlcadHalfSpace& half) {
    return {(half.distance / dot(half.normal, half.normal)) * half.normal, half.normal};
}

struct Maker {
    BrlcadPieces made;

    void doubt_axis(const Vec3& a, const Vec3& height) {
        if (!is_oblique(a, height)) return;
        made.doubt = "A is not perpendicular to H; it is read as an oblique solid";
    }

    void operator()(const BrlcadUnsupported& given) { made.refused = given.reason; }
    void operator()(const BrlcadArb8& arb) { add(made, hexahedron(arb.corners)); }
    void operator()(const BrlcadEllipsoid& given) {
        Ellipsoid ellipsoid;
        ellipsoid.center = given.center;
        ellipsoid.axis_a = given.a;
        ellipsoid.axis_b = given.b;
        ellipsoid.axis_c = given.c;
        if (is_oblique(given.a, given.b) || is_oblique(given.b, given.c) ||
            is_oblique(given.c, given.a)) {
            made.doubt = "its semi-axes are not perpendicular; it is read as an oblique ellipsoid";
        }
        add(made, ellipsoid);
    }
    void operator()(const BrlcadTgc& given) {
        Tgc tgc;
        tgc.base = given.base;
        tgc.height = given.height;
        tgc.axis_a = given.a;
        tgc.axis_b = given.b;
        tgc.axis_c = given.c;
        tgc.axis_d = given.d;
        if (is_oblique(given.a, given.b)) {
            made.doubt =
                "its semi-axes A and B are not perpendicular; it is read as a sheared cone";
        }
        if (is_turned(given.a, given.c) || is_turned(given.b, given.d)) {
            made.doubt =
                "its upper semi-axes C and D are not parallel to A and B; of them only the lengths "
                "are used";
        }
        // Only the lengths of the upper semi-axes are used; they are parallel to those of the base.
        if (length(given.a) > 0.0) tgc.axis_c = as_long_as(given.a, given.c);
        if (length(given.b) > 0.0) tgc.axis_d = as_long_as(given.b, given.d);
        add(made, tgc);
    }
    void operator()(const BrlcadTorus& given) {
        Torus torus;
        torus.center = given.center;
        torus.axis = given.axis;
        torus.major_radius = given.major;
        torus.minor_radius = given.minor;
        add(made, torus);
    }
    void operator()(const BrlcadHalfSpace& given) {
        const OrientedPlane plane = plane_of(given);
        HalfSpace half;
        half.point = plane.point;
        half.normal = plane.normal;
        add(made, half);
    }
    void operator()(const BrlcadPolyhedron& given) {
        Polyhedron polyhedron;
        for (const BrlcadHalfSpace& half : given.planes) {
            polyhedron.planes.push_back(plane_of(half));
        }
        add(made, polyhedron);
    }
    void operator()(const BrlcadParticle& particle) {
        const double height = length(particle.height);
        const double shrink = particle.base_radius - particle.top_radius;
        // If one sphere contains the other, it is the whole solid.
        const bool top = height > shrink;
        const bool base = height > -shrink || !top;
        const auto add_sphere = [&](const Vec3& center, double radius) {
            if (radius == 0.0 && base && top) return;  // the apex of a cone
            Sphere sphere;
            sphere.center = center;
            sphere.radius = radius;
            add(made, sphere);
        };
        const Vec3 end = particle.base + particle.height;
        if (base) add_sphere(particle.base, particle.base_radius);
        if (top) add_sphere(end, particle.top_radius);
        if (!base || !top) return;
        // The cone touches the spheres along circles; s is the sine of its half angle.
        const double s = shrink / height;
        const double c = std::sqrt((1.0 - s) * (1.0 + s));
        const Vec3 along = particle.height / height;
        Cone cone;
        cone.base = particle.base + (s * particle.base_radius) * along;
        cone.top = end + (s * particle.top_radius) * along;
        cone.base_radius = c * particle.base_radius;
        cone.top_radius = c * particle.top_radius;
        add(made, cone);
    }
    void operator()(const BrlcadConicCylinder& given) {
        if (is_oblique(given.height, given.breadth)) {
            made.doubt = "B is not perpendicular to H; it is read as an oblique solid";
        }
        add_quadric(brlcad_quadric(given));
    }
    void operator()(const BrlcadConicDome& given) {
        doubt_axis(given.a, given.height);
        add_quadric(brlcad_quadric(given));
    }
    void operator()(const BrlcadHyperboloid& given) {
        if (!(given.neck > 0.0 && given.neck < 1.0)) {
            made.refused = "is not a solid: its neck ratio must be between 0 and 1";
            return;
        }
        doubt_axis(given.a, given.height);
        add_quadric(brlcad_quadric(given));
    }
    void operator()(const BrlcadSuperellipsoid& given) {
        Superellipsoid super;
        super.center = given.center;
        super.axis_a = given.a;
        super.axis_b = given.b;
        super.axis_c = given.c;
        super.north = given.north;
        super.east = given.east;
        add(made, super);
    }
    void operator()(const BrlcadEllipticTorus& given) {
        if (const std::optional<BrlcadQuartic> quartic = brlcad_quartic(given)) {
            add(made, quartic->shape, quartic->solid_from_shape);
        } else {
            made.refused = "is not a solid: its ellipse has no area or reaches the axis";
        }
    }
    void operator()(const BrlcadMesh& mesh) {
        if (mesh.mesh->triangles.empty()) {
            made.refused = "has no faces";
            return;
        }
        made.closed = mesh.solid && mesh.mesh->closed();
        made.pieces.push_back({mesh.mesh, {}});
    }

  private:
    void add_quadric(const BrlcadQuadric& quadric) {
        if (!is_invertible(quadric.solid_from_shape)) {
            made.refused = "is not a solid: its axes have zero length or are coplanar";
            return;
        }
        add(made, quadric.shape, quadric.solid_from_shape);
    }
};

}  // namespace

BrlcadPieces brlcad_pieces(const BrlcadSolid& solid) {
    Maker maker;
    std::visit(maker, solid.form);
    return std::move(maker.made);
}

Vec2 brlcad_pattern_unit(const BrlcadSolid& solid) {
    constexpr double kHalfSpaceUnit = 5000.0;
    if (std::holds_alternative<BrlcadHalfSpace>(solid.form)) {
        return {kHalfSpaceUnit, kHalfSpaceUnit};
    }
    const auto* arb = std::get_if<BrlcadArb8>(&solid.form);
    Vec2 unit{1, 1};
    if (arb == nullptr) return unit;
    constexpr int kFaces[6][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                  {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    double largest = 0.0;
    for (const auto& face : kFaces) {
        const auto corner = [&](int i) { return arb->corners[static_cast<std::size_t>(face[i])]; };
        const Vec3 area = cross(corner(2) - corner(0), corner(3) - corner(1));
        if (!(length(area) > largest) || !std::isfinite(length(area))) continue;
        largest = length(area);
        const Vec3 normal = area / largest;
        const Vec3 u = perpendicular(normal), v = cross(normal, u);
        const auto extent = [&](const Vec3& axis) {
            double lo = dot(corner(0), axis), hi = lo;
            for (int i = 1; i < 4; ++i) {
                lo = std::fmin(lo, dot(corner(i), axis));
                hi = std::fmax(hi, dot(corner(i), axis));
            }
            return hi - lo;
        };
        unit = {extent(u), extent(v)};
    }
    return unit.x > 0.0 && unit.y > 0.0 ? unit : Vec2{1, 1};
}

}  // namespace alhazen

#include "alhazen/shapes/patches/forms/exact_forms.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

/// An ellipse center + cos a + sin b, a control point of a profile swept around.
struct RingPoint {
    Vec3 center, a, b;
    double weight = 1;
};
using RingProfile = std::vector<RingPoint>;

constexpr double kQuarterWeight = 0.70710678118654752440;

/// Control points (cos, sin, weight) of four quarter circles, consecutive.
constexpr std::array<std::array<double, 3>, 9> kCircle{{{1, 0, 1},
                                                        {1, 1, kQuarterWeight},
                                                        {0, 1, 1},
                                                        {-1, 1, kQuarterWeight},
                                                        {-1, 0, 1},
                                                        {-1, -1, kQuarterWeight},
                                                        {0, -1, 1},
                                                        {1, -1, kQuarterWeight},
                                                        {1, 0, 1}}};

/// Four patches: u around from a to b, v along the profile.
void append_ring(const RingProfile& profile, bool left_handed, std::uint32_t part,
                 std::vector<BezierPiece>& pieces) {
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
        BezierPiece piece;
        piece.part = part;
        piece.net.degree_u = 2;
        piece.net.degree_v = static_cast<int>(profile.size()) - 1;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& [x, y, w] = kCircle[2 * quarter + (left_handed ? 2 - i : i)];
            for (std::size_t j = 0; j < profile.size(); ++j) {
                const RingPoint& ring = profile[j];
                piece.net.at(static_cast<int>(i), static_cast<int>(j)) =
                    homogeneous(ring.center + (x * ring.a + y * ring.b), w * ring.weight);
            }
        }
        pieces.push_back(piece);
    }
}

/// A frame in which profiles are given as (radius, height, weight).
struct RingFrame {
    Vec3 origin, a, b, up;

    [[nodiscard]] bool left_handed() const { return dot(cross(a, b), up) < 0.0; }
    void append(std::span<const std::array<double, 3>> profile, std::uint32_t part,
                std::vector<BezierPiece>& pieces) const {
        RingProfile rings;
        for (const auto& [radius, height, weight] : profile) {
            rings.push_back({origin + height * up, radius * a, radius * b, weight});
        }
        append_ring(rings, left_handed(), part, pieces);
    }
};

using Profile1 = std::array<std::array<double, 3>, 2>;
using Profile2 = std::array<std::array<double, 3>, 3>;

/// A ruled side between two parallel ellipses, and discs inside those with an area if capped. The
/// caps have the parts `base_part` and `base_part + 1`.
void append_ruled(const RingPoint& base, const RingPoint& top, bool capped, std::uint32_t base_part,
                  std::vector<BezierPiece>& pieces) {
    const RingPoint& wide =
        dot(base.a, base.a) * dot(base.b, base.b) >= dot(top.a, top.a) * dot(top.b, top.b) ? base
                                                                                           : top;
    const bool left = dot(cross(wide.a, wide.b), top.center - base.center) < 0.0;
    append_ring({base, top}, left, 0, pieces);
    if (!capped) return;
    const auto has_area = [](const RingPoint& ring) { return cross(ring.a, ring.b) != Vec3{}; };
    if (has_area(base)) append_ring({{base.center, {}, {}, 1.0}, base}, left, base_part, pieces);
    if (has_area(top)) append_ring({top, {top.center, {}, {}, 1.0}}, left, base_part + 1, pieces);
}

void append_frustum(const Vec3& base, const Vec3& top, double base_radius, double top_radius,
                    bool capped, std::vector<BezierPiece>& pieces) {
    const Vec3 axis = unit_or(top - base, Vec3{0, 0, 1});
    const Vec3 a = perpendicular(axis);
    const Vec3 b = cross(axis, a);
    append_ruled({base, base_radius * a, base_radius * b, 1.0},
                 {top, top_radius * a, top_radius * b, 1.0}, capped, 1, pieces);
}

void append_ellipsoid(const RingFrame& frame, std::vector<BezierPiece>& pieces) {
    constexpr double w = kQuarterWeight;
    frame.append(Profile2{{{0, -1, 1}, {1, -1, w}, {1, 0, 1}}}, 0, pieces);
    frame.append(Profile2{{{1, 0, 1}, {1, 1, w}, {0, 1, 1}}}, 0, pieces);
}

/// The solid's surface and its flat ends at heights -1 and 1 of the frame, radius 1.
void append_ends(const RingFrame& frame, std::vector<BezierPiece>& pieces) {
    frame.append(Profile1{{{0, -1, 1}, {1, -1, 1}}}, 5, pieces);
    frame.append(Profile1{{{1, 1, 1}, {0, 1, 1}}}, 6, pieces);
}

/// True if the normal of the lathe at the middle of a curve is to the left of the curve's
/// direction, with the radius to the right and the height upward.
bool normal_is_left(const Lathe& lathe, std::uint32_t part) {
    const ProfileCurve& curve = lathe.profile.curves[part];
    const Vec2 middle = curve.point(0.5);
    const Vec2 along = curve.direction(0.5);
    const Vec3 left{-along.y, 0.0, along.x};
    const Ray ray{{middle.x, 0.0, middle.y}, left, -kInfinity, kInfinity};
    // The crossing there: only the full list tells on which side a closed lathe is.
    ShapeHits hits;
    lathe.intersect(ray, hits);
    ShapeHit hit{kInfinity, 0.5, 0.0, part};
    for (const ShapeHit& found : hits) {
        if (found.part == part && std::abs(found.t) < std::abs(hit.t)) hit = found;
    }
    if (!(std::abs(hit.t) <= 1e-6 * lathe.reach / length(left))) hit = {0.0, 0.5, 0.0, part};
    return dot(lathe.surface(ray, hit).normal, left) > 0.0;
}

}  // namespace

void append_pieces(const Sphere& shape, std::vector<BezierPiece>& pieces) {
    const double r = shape.radius;
    append_ellipsoid({shape.center, {r, 0, 0}, {0, r, 0}, {0, 0, r}}, pieces);
}

void append_pieces(const Ellipsoid& shape, std::vector<BezierPiece>& pieces) {
    append_ellipsoid({shape.center, shape.axis_a, shape.axis_b, shape.axis_c}, pieces);
}

void append_pieces(const Cylinder& shape, std::vector<BezierPiece>& pieces) {
    append_frustum(shape.base, shape.top, shape.radius, shape.radius, shape.capped, pieces);
}

void append_pieces(const Cone& shape, std::vector<BezierPiece>& pieces) {
    append_frustum(shape.base, shape.top, shape.base_radius, shape.top_radius, shape.capped,
                   pieces);
}

void append_pieces(const EllipticCylinder& shape, std::vector<BezierPiece>& pieces) {
    append_ruled({shape.base, shape.axis_a, shape.axis_b, 1.0},
                 {shape.top, shape.axis_a, shape.axis_b, 1.0}, shape.capped, 5, pieces);
}

void append_pieces(const EllipticCone& shape, std::vector<BezierPiece>& pieces) {
    append_ruled({shape.base, shape.axis_a, shape.axis_b, 1.0},
                 {shape.top, shape.top_scale * shape.axis_a, shape.top_scale * shape.axis_b, 1.0},
                 shape.capped, 5, pieces);
}

void append_pieces(const Tgc& shape, std::vector<BezierPiece>& pieces) {
    append_ruled({shape.base, shape.axis_a, shape.axis_b, 1.0},
                 {shape.base + shape.height, shape.axis_c, shape.axis_d, 1.0}, shape.capped, 5,
                 pieces);
}

void append_pieces(const Paraboloid& shape, std::vector<BezierPiece>& pieces) {
    const RingFrame frame{shape.apex, shape.axis_a, shape.axis_b, shape.rim - shape.apex};
    // radius = v, height = v^2.
    frame.append(Profile2{{{0, 0, 1}, {0.5, 0, 1}, {1, 1, 1}}}, 0, pieces);
    if (shape.capped) frame.append(Profile1{{{1, 1, 1}, {0, 1, 1}}}, 6, pieces);
}

void append_pieces(const Hyperboloid& shape, std::vector<BezierPiece>& pieces) {
    const RingFrame frame{0.5 * (shape.base + shape.top), shape.axis_a, shape.axis_b,
                          0.5 * (shape.top - shape.base)};
    // radius^2 = waist^2 + (1 - waist^2) height^2: tangents at the rims meet at radius waist^2.
    const double waist = shape.waist;
    frame.append(Profile2{{{1, -1, 1}, {waist * waist, 0, 1.0 / waist}, {1, 1, 1}}}, 0, pieces);
    if (shape.capped) append_ends(frame, pieces);
}

void append_pieces(const TwoSheetHyperboloid& shape, std::vector<BezierPiece>& pieces) {
    const RingFrame frame{0.5 * (shape.base + shape.top), shape.axis_a, shape.axis_b,
                          0.5 * (shape.top - shape.base)};
    // height^2 = gap^2 + (1 - gap^2) radius^2: the tangents at an apex and at its rim meet at
    // radius gap / (1 + gap).
    const double gap = shape.gap;
    const double x = gap / (1.0 + gap);
    const double w = std::sqrt((1.0 + gap) / (2.0 * gap));
    frame.append(Profile2{{{1, -1, 1}, {x, -gap, w}, {0, -gap, 1}}}, 0, pieces);
    frame.append(Profile2{{{0, gap, 1}, {x, gap, w}, {1, 1, 1}}}, 0, pieces);
    if (shape.capped) append_ends(frame, pieces);
}

void append_pieces(const Torus& shape, std::vector<BezierPiece>& pieces) {
    const Vec3 a = perpendicular(shape.unit_axis);
    const RingFrame frame{shape.center, a, cross(shape.unit_axis, a), shape.unit_axis};
    const double major = shape.major_radius, minor = shape.minor_radius;
    for (std::size_t quarter = 0; quarter < 4; ++quarter) {
        Profile2 profile;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& [x, y, w] = kCircle[2 * quarter + k];
            profile[k] = {major + minor * x, minor * y, w};
        }
        frame.append(profile, 0, pieces);
    }
}

void append_pieces(const Lathe& shape, std::vector<BezierPiece>& pieces) {
    const RingFrame frame{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::uint32_t part = 0; part < shape.profile.curves.size(); ++part) {
        const ProfileCurve& curve = shape.profile.curves[part];
        std::vector<std::array<double, 3>> profile;
        bool on_axis = true, is_point = true;
        for (int k = 0; k <= curve.degree(); ++k) {
            const Vec2& p = curve.control(k);
            profile.push_back({p.x, p.y, 1.0});
            on_axis = on_axis && p.x == 0.0;
            is_point = is_point && p == curve.control(0);
        }
        if (on_axis || is_point) continue;
        // A ring's normal is to the right of its profile's direction.
        const bool reversed = normal_is_left(shape, part);
        if (reversed) std::reverse(profile.begin(), profile.end());
        const std::size_t first = pieces.size();
        frame.append(profile, part, pieces);
        if (!reversed) continue;
        for (std::size_t k = first; k < pieces.size(); ++k)
            std::swap(pieces[k].lo.y, pieces[k].hi.y);
    }
}

void append_pieces(const Disc& shape, std::vector<BezierPiece>& pieces) {
    const RingFrame frame{shape.center, shape.u_axis, cross(shape.unit_normal, shape.u_axis),
                          shape.unit_normal};
    frame.append(Profile1{{{shape.radius, 0, 1}, {shape.inner_radius, 0, 1}}}, 0, pieces);
}

void append_pieces(const Rectangle& shape, std::vector<BezierPiece>& pieces) {
    const Vec3 points[4] = {shape.corner, shape.corner + shape.edge_v, shape.corner + shape.edge_u,
                            shape.corner + shape.edge_u + shape.edge_v};
    pieces.push_back({.net = bezier_net(1, 1, points)});
}

void append_pieces(const BezierPatch& shape, std::vector<BezierPiece>& pieces) {
    pieces.push_back({.net = shape.net()});
}

namespace {

void append_pieces(const PatchPieces& own, std::vector<BezierPiece>& pieces) {
    for (std::size_t k = 0; k < own.size(); ++k) pieces.push_back(own[k]);
}

}  // namespace

void append_pieces(const PatchMesh& shape, std::vector<BezierPiece>& pieces) {
    append_pieces(shape.tree->pieces(), pieces);
}

void append_pieces(const NurbsSurface& shape, std::vector<BezierPiece>& pieces) {
    append_pieces(shape.tree->pieces(), pieces);
}

void append_pieces(const BilinearPatch& shape, std::vector<BezierPiece>& pieces) {
    const Vec3 points[4] = {shape.p00, shape.p01, shape.p10, shape.p11};
    pieces.push_back({.net = bezier_net(1, 1, points)});
}

void append_pieces(const SteinerPatch& shape, std::vector<BezierPiece>& pieces) {
    pieces.push_back({.net = shape.net()});
}

}  // namespace alhazen

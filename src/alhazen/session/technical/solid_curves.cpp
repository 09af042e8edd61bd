#include "alhazen/session/technical/solid_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/session/technical/solid_curve_parts.h"

namespace alhazen {

namespace {

using Kind = SolidFace::Kind;
using Line = std::array<Vec3, 2>;  ///< a point and a direction

constexpr int kCurveSamples = SolidCurveParts::kSamples;
/// Circles in which bodies cross are contacts below this radius, relative to the smaller body:
/// spheres that penetrate each other by 5e-5 of their radius.
constexpr double kContact = 3e-3;

SolidCurve line_curve(const SolidFace& face, const Vec3& from, const Vec3& along) {
    SolidCurve curve;
    curve.face = &face;
    curve.has_form = true;
    curve.form = {from, along, {}};
    return curve;
}
SolidCurve round_curve(const SolidFace& face, const CurveForm& form) {
    SolidCurve curve;
    curve.face = &face;
    curve.has_form = curve.round = true;
    curve.form = form;
    curve.to = 2 * kPi;
    return curve;
}
CurveForm mapped(const Affine& world, const CurveForm& form) {
    return {world.point(form.origin), world.vector(form.u), world.vector(form.v)};
}

/// The frame of a side; `line(angle)` is its generating line, with t in [0, 1].
struct SideFrame {
    explicit SideFrame(const SolidFace& f)
        : face(f), x(normalize(perpendicular(f.axis))), y(cross(f.axis, x)) {}
    [[nodiscard]] Vec3 out(double angle) const { return std::cos(angle) * x + std::sin(angle) * y; }
    [[nodiscard]] Line line(double angle) const {
        const Vec3 o = out(angle);
        return {face.at + face.radius * o, face.height * (face.axis + face.widening * o)};
    }
    const SolidFace& face;
    Vec3 x, y;
};

/// The parameters at which a line meets the surface of a face, in leaf space: at most two, in an
/// order that is consistent along neighbouring lines.
std::array<std::optional<double>, 2> roots_of(const SolidFace& f, const Line& line) {
    const Vec3 w = line[0] - f.at, &d = line[1];
    if (f.kind == Kind::Plane) {
        const double speed = dot(d, f.axis);
        if (!(std::abs(speed) > 1e-12 * length(d))) return {};
        return {-dot(w, f.axis) / speed, std::nullopt};
    }
    double a = dot(d, d), b = dot(w, d), c = dot(w, w);
    if (f.kind == Kind::Sphere) {
        c -= f.radius * f.radius;
    } else {
        const double z = dot(w, f.axis), dz = dot(d, f.axis), k = f.widening;
        const double r = f.radius + k * z;
        a -= dz * dz * (1.0 + k * k);
        b -= z * dz + k * dz * r;
        c -= z * z + r * r;
    }
    const double under = b * b - a * c;
    if (!(under >= 0.0)) return {};
    if (std::abs(a) < 1e-12 * dot(d, d)) {
        if (b == 0.0) return {};
        return {-0.5 * c / b, std::nullopt};
    }
    const double root = std::sqrt(under);
    return {(-b - root) / a, (-b + root) / a};
}

/// Finds the curves, and their parts that are edges or outlines.
class SolidCurveFinder {
  public:
    /// `split`: only curves of a leaf before this one with one from it on; 0: all curves.
    SolidCurveFinder(const FacedSolid& solid, const BeamApex& eye, std::size_t split = 0)
        : solid_(solid), eye_(eye), parts_(solid, eye), split_(split) {}

    bool find() {
        const std::vector<SolidFace>& faces = solid_.faces();
        for (std::size_t i = 0; i < faces.size(); ++i) {
            if (split_ == 0) outline(faces[i]);
            for (std::size_t k = i + 1; k < faces.size(); ++k) {
                if (split_ != 0 && (faces[i].leaf < split_) == (faces[k].leaf < split_)) continue;
                const Box3 both =
                    intersection(solid_.leaf(faces[i]).box, solid_.leaf(faces[k]).box);
                if (both.empty()) continue;
                if (!meet(faces[i], faces[k])) return false;
            }
        }
        return true;
    }
    [[nodiscard]] std::vector<FeatureCurve> take() { return parts_.take(); }

  private:
    // ---- Curves of two faces.

    bool meet(const SolidFace& a, const SolidFace& b) {
        if (a.kind > b.kind) return meet(b, a);
        if (a.kind == Kind::Plane) {
            if (b.kind == Kind::Plane) {
                planes(a, b);
            } else if (b.kind == Kind::Sphere) {
                plane_and_sphere(a, b);
            } else {
                plane_and_side(a, b);
            }
            return true;
        }
        if (b.kind == Kind::Sphere) return spheres(a, b);
        if (a.kind == Kind::Side && radius_of(b) > radius_of(a)) return intersect_sides(a, b);
        return a.kind == Kind::Side ? intersect_sides(b, a) : (trace(b, a), true);
    }
    [[nodiscard]] double radius_of(const SolidFace& f) const {
        return solid_.leaf(f).size > 0.0
                   ? length(solid_.leaf(f).world.vector(f.radius * perpendicular(f.axis)))
                   : 0.0;
    }

    /// A plane transformed to the space of another leaf.
    [[nodiscard]] SolidFace moved(const SolidFace& plane, const SolidLeaf& to) const {
        const SolidLeaf& own = solid_.leaf(plane);
        SolidFace result = plane;
        result.at = to.inverse.point(own.world.point(plane.at));
        result.axis = unit_or(
            transpose_times(to.world.linear, transpose_times(own.inverse.linear, plane.axis)), {});
        return result;
    }

    void planes(const SolidFace& a, const SolidFace& b) {
        const SolidLeaf& leaf = solid_.leaf(a);
        const Vec3 n = solid_.normal(a, {}), m = solid_.normal(b, {}), along = cross(n, m);
        if (!(length_squared(along) > 1e-18)) return;
        const double at_n = dot(n, leaf.world.point(a.at)),
                     at_m = dot(m, solid_.leaf(b).world.point(b.at));
        const Vec3 on = (at_n * cross(m, along) + at_m * cross(along, n)) / length_squared(along);
        parts_.add_within(line_curve(a, on, normalize(along)),
                          intersection(leaf.box, solid_.leaf(b).box));
    }

    void plane_and_sphere(const SolidFace& plane, const SolidFace& sphere) {
        const SolidLeaf& leaf = solid_.leaf(sphere);
        const SolidFace p = moved(plane, leaf);
        const double away = dot(p.at - sphere.at, p.axis);
        const double rest = sphere.radius * sphere.radius - away * away;
        if (!(rest > 0.0)) return;
        const Vec3 u = normalize(perpendicular(p.axis)), v = cross(p.axis, u);
        const double r = std::sqrt(rest);
        add(round_curve(plane, mapped(leaf.world, {sphere.at + away * p.axis, r * u, r * v})));
    }

    void plane_and_side(const SolidFace& plane, const SolidFace& side) {
        const SolidLeaf& leaf = solid_.leaf(side);
        const SolidFace p = moved(plane, leaf);
        const SideFrame frame(side);
        const double along = dot(p.axis, side.axis), away = dot(p.at - side.at, p.axis);
        if (side.widening == 0.0 && std::abs(along) > 1e-9) {
            // t along the axis is linear in the cosine and the sine of the angle.
            const double tx = -side.radius * dot(p.axis, frame.x) / along;
            const double ty = -side.radius * dot(p.axis, frame.y) / along;
            add(round_curve(plane, mapped(leaf.world, {side.at + (away / along) * side.axis,
                                                       side.radius * frame.x + tx * side.axis,
                                                       side.radius * frame.y + ty * side.axis})));
            return;
        }
        const Vec3 apex =
            side.widening == 0.0 ? side.at : side.at - (side.radius / side.widening) * side.axis;
        const bool of_lines =
            side.widening == 0.0 || std::abs(dot(p.at - apex, p.axis)) < 1e-9 * leaf.size;
        if (!of_lines) return trace(side, plane);
        // cos(angle - middle) = share, from the line of the side that lies in the plane.
        const double px = dot(p.axis, frame.x), py = dot(p.axis, frame.y);
        const double reach = std::hypot(px, py);
        const double wanted = side.widening == 0.0 ? away / side.radius : -along / side.widening;
        if (!(std::abs(wanted) <= reach)) return;
        const double middle = std::atan2(py, px), half = std::acos(wanted / reach);
        for (const double angle : {middle - half, middle + half}) {
            const Line line = frame.line(angle);
            add(line_curve(side, leaf.world.point(line[0]), leaf.world.vector(line[1])));
        }
    }

    /// Adds the circle of two spheres. False if they are not spheres in one common space.
    bool spheres(const SolidFace& a, const SolidFace& b) {
        const SolidLeaf &leaf = solid_.leaf(a), &other = solid_.leaf(b);
        if (&leaf == &other) return true;
        const Affine between = leaf.inverse * other.world;
        const double scale = length(between.linear.x_axis);
        for (const Vec3& axis : {between.linear.y_axis, between.linear.z_axis}) {
            if (std::abs(length(axis) - scale) > 1e-9 * scale) return false;
        }
        if (std::abs(std::abs(determinant(between.linear)) - scale * scale * scale) >
            1e-9 * scale * scale * scale) {
            return false;
        }
        const Vec3 d = between.point(b.at) - a.at;
        const double r = scale * b.radius, apart = length(d);
        if (!(apart > 1e-9 * a.radius)) return true;
        const double away = 0.5 * (apart + (a.radius * a.radius - r * r) / apart);
        const double rest = a.radius * a.radius - away * away;
        if (!(rest > 0.0)) return true;
        const Vec3 n = d / apart, u = normalize(perpendicular(n)), v = cross(n, u);
        add(round_curve(
            a, mapped(leaf.world, {a.at + away * n, std::sqrt(rest) * u, std::sqrt(rest) * v})));
        return true;
    }

    bool intersect_sides(const SolidFace& side, const SolidFace& other) {
        const SolidLeaf &leaf = solid_.leaf(side), &to = solid_.leaf(other);
        if (&leaf == &to) return true;
        // Lines of a cylinder parallel to the axis of another lie in it or do not meet it. They lie
        // in it where the value of the other face changes its sign from line to line.
        const Affine between = to.inverse * leaf.world;
        const SideFrame frame(side);
        const bool parallel = side.widening == 0.0 && other.widening == 0.0 &&
                              length(cross(between.vector(side.axis), other.axis)) <
                                  1e-9 * length(between.vector(side.axis));
        if (!parallel) {
            trace(side, other);
            return true;
        }
        const auto value = [&](double angle) {
            return other.value(between.point(frame.line(angle)[0]));
        };
        for (int k = 0; k < kCurveSamples; ++k) {
            double lo = 2 * kPi * k / kCurveSamples, hi = 2 * kPi * (k + 1) / kCurveSamples;
            const bool in = value(lo) < 0.0;
            if ((value(hi) < 0.0) == in) continue;
            for (int n = 0; n < 60; ++n)
                ((value(0.5 * (lo + hi)) < 0.0) == in ? lo : hi) = 0.5 * (lo + hi);
            const Line line = frame.line(lo);
            add(line_curve(side, leaf.world.point(line[0]), leaf.world.vector(line[1])));
        }
        return true;
    }

    /// Adds the curve in which the lines of a side cut another face.
    void trace(const SolidFace& side, const SolidFace& other) {
        const SolidLeaf& leaf = solid_.leaf(side);
        const Affine between = solid_.leaf(other).inverse * leaf.world;
        const SideFrame frame(side);
        for (std::size_t branch = 0; branch < (other.kind == Kind::Plane ? 1u : 2u); ++branch) {
            const auto along = [=, &other](double angle) {
                const Line line = frame.line(angle);
                return roots_of(other, {between.point(line[0]), between.vector(line[1])})[branch];
            };
            std::optional<double> first = along(0.1);
            bool level = first.has_value();
            for (const double angle : {1.2, 2.9, 4.1, 5.6}) {
                const std::optional<double> t = along(angle);
                level = level && t && std::abs(*t - *first) < 1e-9;
            }
            if (level) {
                const double z = *first * side.height, r = side.radius + side.widening * z;
                add(round_curve(
                    side, mapped(leaf.world, {side.at + z * side.axis, r * frame.x, r * frame.y})));
                continue;
            }
            SolidCurve curve;
            curve.face = &side;
            curve.to = 2 * kPi;
            curve.traced = [=, &leaf](double angle) -> std::optional<Vec3> {
                const std::optional<double> t = along(angle);
                // Slightly beyond the ends, to include the rims.
                if (!t || *t < -1e-6 || *t > 1.0 + 1e-6) return std::nullopt;
                const Line line = frame.line(angle);
                return leaf.world.point(line[0] + *t * line[1]);
            };
            add(curve);
        }
    }

    // ---- Outlines.

    void outline(const SolidFace& face) {
        if (face.kind == Kind::Plane) return;
        const SolidLeaf& leaf = solid_.leaf(face);
        const Vec3 at = leaf.inverse.linear * eye_.at + eye_.weight * leaf.inverse.translation;
        const Vec3 e = at - eye_.weight * face.at;
        if (face.kind == Kind::Sphere) {
            const double distance = length(e), share = eye_.weight * face.radius / distance;
            if (!(distance > 0.0) || share >= 1.0) return;
            const Vec3 axis = e / distance, u = normalize(perpendicular(axis)), v = cross(axis, u);
            const double r = face.radius * std::sqrt(1.0 - share * share);
            SolidCurve curve = round_curve(
                face, mapped(leaf.world, {face.at + (face.radius * share) * axis, r * u, r * v}));
            curve.outline = true;
            add(curve);
            return;
        }
        // The side faces the eye where reach * cos(angle - middle) > least.
        const SideFrame frame(face);
        const double reach = std::hypot(dot(e, frame.x), dot(e, frame.y));
        const double least = eye_.weight * face.radius + face.widening * dot(e, face.axis);
        if (!(std::abs(least) < reach)) return;
        const double middle = std::atan2(dot(e, frame.y), dot(e, frame.x));
        const double half = std::acos(least / reach);
        for (const double angle : {middle - half, middle + half}) {
            const Line line = frame.line(angle);
            SolidCurve curve =
                line_curve(face, leaf.world.point(line[0]), leaf.world.vector(line[1]));
            curve.outline = true;
            add(curve);
        }
    }

    void add(const SolidCurve& curve) { parts_.add(curve); }

    const FacedSolid& solid_;
    BeamApex eye_;
    SolidCurveParts parts_;
    std::size_t split_;
};

/// True if both surfaces are smooth at a point of the curve.
bool is_smooth(const FacedSolid& one, const FacedSolid& other, const FeatureCurve& curve,
               double t) {
    const double c = std::cos(t), s = std::sin(t);
    const CurveForm& form = curve.points;
    const Vec3 p = curve.round ? form.origin + c * form.u + s * form.v : form.origin + t * form.u;
    const Vec3 tangent = curve.round ? c * form.v - s * form.u : form.u;
    const SolidWheel a = one.wheel(p, tangent), b = other.wheel(p, tangent);
    return a.surface && b.surface && !a.edge && !b.edge;
}

}  // namespace

bool add_solid_curves(const FacedSolid& solid, const BeamApex& eye,
                      std::vector<FeatureCurve>& curves) {
    SolidCurveFinder finder(solid, eye);
    if (!finder.find()) return false;
    for (const FeatureCurve& curve : finder.take()) curves.push_back(curve);
    return true;
}

void add_crossing_curves(const FacedSolid& both, const FacedSolid& one, const FacedSolid& other,
                         const BeamApex& eye, std::vector<FeatureCurve>& curves) {
    SolidCurveFinder finder(both, eye, one.leaf_count());
    if (!finder.find()) return;
    const double size = std::min(length(one.box().size()), length(other.box().size()));
    for (FeatureCurve& curve : finder.take()) {
        // Round bodies that touch, up to the digits of a file.
        if (curve.round && length(curve.points.u) < kContact * size) continue;
        // Only the ends of a chord lie on the surfaces.
        const bool crosses =
            curve.off > 0.0
                ? is_smooth(one, other, curve, curve.from) || is_smooth(one, other, curve, curve.to)
                : is_smooth(one, other, curve, 0.5 * (curve.from + curve.to));
        if (!crosses) continue;
        curve.style = LineStyle::Silhouette;
        curves.push_back(curve);
    }
}

}  // namespace alhazen

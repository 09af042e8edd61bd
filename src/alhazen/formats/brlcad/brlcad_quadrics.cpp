#include "alhazen/formats/brlcad/brlcad_quadrics.h"

#include <array>
#include <charconv>
#include <cmath>

namespace alhazen {

namespace {

/// Profile of a conic: the squared half width of its section at a depth from 0 (the base) to 1 (the
/// apex) is scale * q(depth) with q(0) = 1. Coefficients of q - 1 by powers of the depth.
struct ConicProfile {
    double linear = -1, square = 0;
};

/// Profile of a parabola, or of a hyperbola whose asymptotes intersect at `c` above the apex:
/// q(s) = ((1 + c - s)^2 - c^2) / ((1 + c)^2 - c^2), all in units of the depth.
ConicProfile profile(bool hyperbolic, double c) {
    if (!hyperbolic) return {};
    const double whole = 1.0 + 2.0 * c;
    return {-2.0 * (1.0 + c) / whole, 1.0 / whole};
}

/// The vector perpendicular to both, of length `wanted`.
Vec3 across(const Vec3& a, const Vec3& b, double wanted) {
    const Vec3 n = cross(a, b);
    return (wanted / length(n)) * n;
}

}  // namespace

BrlcadQuadric brlcad_quadric(const BrlcadConicCylinder& solid) {
    const ConicProfile p = profile(solid.hyperbolic, solid.apex_distance / length(solid.breadth));
    BrlcadQuadric made;
    made.shape.squares = {1, -p.square, 0};
    made.shape.linear = {0, -p.linear, 0};
    made.shape.constant = -1;
    made.shape.clip_box = {{-1, 0, 0}, {1, 1, 1}};
    made.solid_from_shape = {
        {across(solid.height, solid.breadth, solid.half_width), solid.breadth, solid.height},
        solid.base};
    return made;
}

BrlcadQuadric brlcad_quadric(const BrlcadConicDome& solid) {
    const ConicProfile p = profile(solid.hyperbolic, solid.apex_distance / length(solid.height));
    BrlcadQuadric made;
    made.shape.squares = {1, 1, -p.square};
    made.shape.linear = {0, 0, -p.linear};
    made.shape.constant = -1;
    made.shape.clip_box = {{-1, -1, 0}, {1, 1, 1}};
    made.solid_from_shape = {{(solid.radius_a / length(solid.a)) * solid.a,
                              across(solid.height, solid.a, solid.radius_b), solid.height},
                             solid.base};
    return made;
}

BrlcadQuadric brlcad_quadric(const BrlcadHyperboloid& solid) {
    const double n = solid.neck * solid.neck;
    BrlcadQuadric made;
    made.shape.squares = {1, 1, n - 1.0};
    made.shape.constant = -n;
    made.shape.clip_box = {{-1, -1, -1}, {1, 1, 1}};
    const Vec3 half = 0.5 * solid.height;
    made.solid_from_shape = {{solid.a, across(solid.height, solid.a, solid.radius_b), half},
                             solid.base + half};
    return made;
}

namespace {

std::string digits(double value) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// A further term of a sum, with its sign.
std::string term(double factor, const char* power) {
    return (std::signbit(factor) ? " - " : " + ") + digits(std::abs(factor)) + power;
}

}  // namespace

std::optional<BrlcadQuartic> brlcad_quartic(const BrlcadEllipticTorus& solid) {
    if (!(solid.major > 0.0 && solid.minor > 0.0 && length(solid.c) > 0.0 &&
          length(solid.axis) > 0.0)) {
        return std::nullopt;
    }
    // Unit of length: the radius of the circle. The semi-axis c has the component cz along the
    // axis.
    const Vec3 axis = normalize(solid.axis);
    const double c = length(solid.c) / solid.major;
    const double m = solid.minor / solid.major;
    const double cz = dot(solid.c, axis) / solid.major;
    const double cr = std::sqrt(std::fmax(0.0, (c - cz) * (c + cz)));
    const double reach = std::hypot(cr, m * cz / c);
    const double height = std::hypot(cz, m * cr / c);
    if (!(reach < 1.0)) return std::nullopt;
    // a (rho - 1)^2 + 2 b (rho - 1) z + d z^2 = 1, with rho the distance from the axis. Moving the
    // terms odd in rho to one side and squaring leaves only rho^2 = x^2 + y^2.
    const double c4 = c * c * c * c, cm = c * c * m * m;
    const double a = cr * cr / c4 + cz * cz / cm;
    const double b = cr * cz * (1.0 / c4 - 1.0 / cm);
    const double d = cz * cz / c4 + cr * cr / cm;
    BrlcadQuartic made;
    made.shape.expression = "(" + digits(a) + "*(x^2 + y^2)" + term(d, "*z^2") +
                            term(-2.0 * b, "*z") + term(a - 1.0, "") + ")^2 - (x^2 + y^2)*(" +
                            digits(2.0 * a) + term(-2.0 * b, "*z") + ")^2";
    constexpr double kMargin = 1.0 + 1e-6;  // margin: the box is tangent to the solid
    const double side = kMargin * (1.0 + reach);
    made.shape.clip_box = {{-side, -side, -kMargin * height}, {side, side, kMargin * height}};
    const Vec3 other = std::abs(axis.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 x = across(axis, other, solid.major);
    made.solid_from_shape = {{x, cross(axis, x), solid.major * axis}, solid.center};
    return made;
}

}  // namespace alhazen

#include "alhazen/renderers/light_transport/polarized_path.h"

#include <algorithm>

#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

/// The unit normal of the plane through both; if they are collinear, any direction perpendicular to
/// `view`.
Vec3 across_plane(const Vec3& view, const Vec3& direction) {
    const Vec3 across = cross(view, direction);
    return length_squared(across) > 1e-24 ? normalize(across) : perpendicular(view);
}

Spectrum not_negative(const Spectrum& s) {
    return {std::max(0.0, s.a), std::max(0.0, s.b), std::max(0.0, s.c), std::max(0.0, s.d)};
}

}  // namespace

void PolarizedPath::begin(const Vec3& axis) {
    axis_ = axis;
    product_ = {};
    for (std::size_t i = 0; i < 4; ++i) product_[i][i] = Spectrum::all(1);
}

Vec2 PolarizedPath::twice_to_axis(const Vec3& x, const Vec3& view) const {
    double c = dot(x, axis_), s = dot(cross(x, axis_), view);
    const double squared = c * c + s * s;
    if (!(squared > 0.0)) return {1, 0};
    return {(c * c - s * s) / squared, 2.0 * c * s / squared};
}

void PolarizedPath::scatter(const Vec3& view, const Vec3& direction, const PlaneMueller& m) {
    const Vec3 x = across_plane(view, direction);
    const Vec2 twice = twice_to_axis(x, view);
    for (auto& row : product_) {
        // Rotates the frame from x to the axis, after the scattering.
        const Spectrum i = row[0];
        const Spectrum q = twice.x * row[1] - twice.y * row[2];
        const Spectrum u = twice.y * row[1] + twice.x * row[2];
        const Spectrum v = row[3];
        row = {i + q * m.q, i * m.q + q * m.d, u * m.c - v * m.e, u * m.e + v * m.c};
    }
    axis_ = x;
}

void PolarizedPath::depolarize() {
    for (auto& row : product_) row[1] = row[2] = row[3] = {};
}

StokesLight PolarizedPath::arrived() const {
    return {not_negative(product_[0][0]), product_[1][0], product_[2][0], product_[3][0]};
}

StokesLight PolarizedPath::arrived(const Vec3& view, const Vec3& direction,
                                   const PlaneMueller& m) const {
    const Vec2 twice = twice_to_axis(across_plane(view, direction), view);
    const auto first = [&](const std::array<Spectrum, 4>& row) {
        return row[0] + (twice.x * row[1] - twice.y * row[2]) * m.q;
    };
    return {not_negative(first(product_[0])), first(product_[1]), first(product_[2]),
            first(product_[3])};
}

Vec3 picture_axis(const Vec3& direction, const Vec3& up) {
    return unit_or(cross(direction, up), perpendicular(direction));
}

}  // namespace alhazen

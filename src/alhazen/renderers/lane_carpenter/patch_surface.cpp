#include "alhazen/renderers/lane_carpenter/patch_surface.h"

#include <array>
#include <cmath>

namespace alhazen {

namespace {

/// The Bernstein polynomials of a degree at x, and their derivatives.
struct Bernstein {
    std::array<double, kMaxPatchOrder> value, slope;

    Bernstein(int degree, double x) {
        if (degree == 3) {
            set_cubic(x);
            return;
        }
        const double y = 1.0 - x;
        value[0] = 1.0;
        for (int n = 1; n <= degree; ++n) {
            if (n == degree) set_slope(degree);
            double carry = 0.0;
            for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
                const double old = value[k];
                value[k] = carry + y * old;
                carry = x * old;
            }
            value[static_cast<std::size_t>(n)] = carry;
        }
    }

  private:
    void set_cubic(double x) {
        const double y = 1.0 - x, xx = x * x, yy = y * y, xy = 2.0 * x * y;
        value = {yy * y, 3.0 * yy * x, 3.0 * y * xx, xx * x};
        slope = {-3.0 * yy, 3.0 * (yy - xy), 3.0 * (xy - xx), 3.0 * xx};
    }
    /// Computed from the polynomials of one degree less.
    void set_slope(int degree) {
        const double n = degree;
        slope[0] = -n * value[0];
        for (std::size_t k = 1; k < static_cast<std::size_t>(degree); ++k) {
            slope[k] = n * (value[k - 1] - value[k]);
        }
        slope[static_cast<std::size_t>(degree)] = n * value[static_cast<std::size_t>(degree) - 1];
    }
};

struct PatchTangents {
    Vec3 point, du, dv;
};

PatchTangents rational_tangents(const BezierNet& net, double u, double v) {
    const Bernstein bu(net.degree_u, u), bv(net.degree_v, v);
    HomogeneousPoint s{0, 0, 0, 0}, s_u = s, s_v = s;
    const HomogeneousPoint* p = net.points.data();
    for (std::size_t i = 0; i <= static_cast<std::size_t>(net.degree_u); ++i) {
        HomogeneousPoint value{0, 0, 0, 0}, slope = value;
        for (std::size_t j = 0; j <= static_cast<std::size_t>(net.degree_v); ++j, ++p) {
            value = value + bv.value[j] * *p;
            slope = slope + bv.slope[j] * *p;
        }
        s = s + bu.value[i] * value;
        s_u = s_u + bu.slope[i] * value;
        s_v = s_v + bu.value[i] * slope;
    }
    const double share = 1.0 / s.w;
    const Vec3 point{s.x * share, s.y * share, s.z * share};
    return {point, share * (Vec3{s_u.x, s_u.y, s_u.z} - s_u.w * point),
            share * (Vec3{s_v.x, s_v.y, s_v.z} - s_v.w * point)};
}

/// For a patch whose weights are 1.
PatchTangents polynomial_tangents(const BezierNet& net, double u, double v) {
    const Bernstein bu(net.degree_u, u), bv(net.degree_v, v);
    PatchTangents s;
    const HomogeneousPoint* p = net.points.data();
    const auto degree_u = static_cast<std::size_t>(net.degree_u);
    const auto degree_v = static_cast<std::size_t>(net.degree_v);
    for (std::size_t i = 0; i <= degree_u; ++i) {
        double x = 0, y = 0, z = 0, dx = 0, dy = 0, dz = 0;
        for (std::size_t j = 0; j <= degree_v; ++j, ++p) {
            const double a = bv.value[j], b = bv.slope[j];
            x += a * p->x;
            y += a * p->y;
            z += a * p->z;
            dx += b * p->x;
            dy += b * p->y;
            dz += b * p->z;
        }
        const double a = bu.value[i], b = bu.slope[i];
        s.point = {s.point.x + a * x, s.point.y + a * y, s.point.z + a * z};
        s.du = {s.du.x + b * x, s.du.y + b * y, s.du.z + b * z};
        s.dv = {s.dv.x + a * dx, s.dv.y + a * dy, s.dv.z + a * dz};
    }
    return s;
}

PatchTangents tangents_at(const ScanPiece& piece, double u, double v) {
    return piece.polynomial ? polynomial_tangents(piece.net, u, v)
                            : rational_tangents(piece.net, u, v);
}

/// Clamps to [0, 1].
double limited(double x) {
    return x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x;
}

/// The intersection of a ray with the tangent plane: distance, and change of the parameters.
struct TangentStep {
    bool found = false;
    Vec3 point, offset;
    Vec2 change;
};
TangentStep tangent_step(const PatchTangents& at, const Vec3& normal, double squared,
                         const Ray& ray) {
    TangentStep step;
    const double facing = dot(ray.direction, normal);
    const double t = dot(at.point - ray.origin, normal) / facing;
    step.point = ray.at(t);
    step.offset = step.point - at.point;
    // In the tangent plane: offset = a du + b dv.
    const double share = 1.0 / squared;
    step.change = {dot(cross(step.offset, at.dv), normal) * share,
                   dot(cross(at.du, step.offset), normal) * share};
    step.found = t > 0.0 && std::abs(step.change.x) < 0.25 && std::abs(step.change.y) < 0.25 &&
                 facing * facing > 1e-4 * squared;
    return step;
}

/// Converts parameters and derivatives from the square whose edge v = 1 is a corner to those of the
/// triangle (s, t).
void to_triangle(Vec2& uv, Surface& surface) {
    const double rest = 1.0 - uv.y;
    if (rest > 1e-9) {
        const Vec3 ds = surface.dpdu / rest;
        surface.dpdv = surface.dpdv + uv.x * ds;
        surface.dpdu = ds;
    }
    uv.x *= rest;
}

/// The unit normal if the tangents span no plane; for a patch without area it points towards the
/// eye.
Vec3 limit_normal(const ScanPiece& piece, Vec2 uv, const Ray& ray) {
    const Vec3 normal = patch_normal(piece.net, uv.x, uv.y);
    return normal == Vec3{} ? -ray.direction : normal;
}

/// Sets texture coordinates and their derivatives from those of the piece.
void set_coordinates(const ScanSource& source, const ScanPiece& piece, Vec2 uv, Surface& surface) {
    const Vec2 size = piece.hi - piece.lo;
    if (size != Vec2{1, 1}) {
        surface.dpdu = surface.dpdu / size.x;
        surface.dpdv = surface.dpdv / size.y;
    }
    uv = {piece.lo.x + uv.x * size.x, piece.lo.y + uv.y * size.y};
    if (source.is_triangle) to_triangle(uv, surface);
    surface.uv = surface.uv2 = uv;
    surface.dpdu2 = surface.dpdu;
    surface.dpdv2 = surface.dpdv;
}

}  // namespace

void set_patch_surface(const ScanScene& scene, const ScanPiece& piece, Vec2 uv, const Ray& ray,
                       double error, Surface& surface) {
    const ScanSource& source = scene.sources[piece.source];
    PatchTangents at = tangents_at(piece, uv.x, uv.y);
    Vec3 normal = cross(at.du, at.dv);
    double squared = length_squared(normal);
    const auto is_regular = [&] {
        return squared > 1e-16 * length_squared(at.du) * length_squared(at.dv) && squared > 0.0;
    };
    surface.point = at.point;
    for (int round = 0; round < 2 && is_regular(); ++round) {
        const TangentStep step = tangent_step(at, normal, squared, ray);
        if (!step.found) break;
        surface.point = step.point;
        uv = {limited(uv.x + step.change.x), limited(uv.y + step.change.y)};
        if (length_squared(step.offset) <= kShortStep * kShortStep * error * error) break;
        at = tangents_at(piece, uv.x, uv.y);
        normal = cross(at.du, at.dv);
        squared = length_squared(normal);
    }
    if (is_regular()) {
        normal = normal / std::sqrt(squared);
    } else {
        normal = limit_normal(piece, uv, ray);
    }
    surface.normal = source.mirrored != piece.inward ? -normal : normal;
    surface.shading_normal = surface.normal;
    surface.dpdu = at.du;
    surface.dpdv = at.dv;
    set_coordinates(source, piece, uv, surface);
    surface.error = {error, error, error};
}

void set_patch_surface(const ScanScene& scene, const ScanPiece& piece, const PatchBlock& block,
                       std::size_t lane, bool with_uv, Surface& surface) {
    const ScanSource& source = scene.sources[piece.source];
    const Vec2 uv{block.u[lane], block.v[lane]};
    surface.point = PatchBlock::vector(block.point, lane);
    const double sign = source.mirrored != piece.inward ? -1.0 : 1.0;
    double x = block.normal[0][lane], y = block.normal[1][lane], z = block.normal[2][lane];
    if ((block.regular >> lane & 1u) == 0) {
        const Vec3 limit = limit_normal(piece, uv, block.rays[lane]);
        x = limit.x, y = limit.y, z = limit.z;
    }
    // Set by components: a copy of the whole vector would wait for its stores.
    surface.normal = {sign * x, sign * y, sign * z};
    surface.shading_normal = {sign * x, sign * y, sign * z};
    const double error = block.error[lane];
    surface.error = {error, error, error};
    if (!with_uv) return;
    surface.dpdu = PatchBlock::vector(block.du, lane);
    surface.dpdv = PatchBlock::vector(block.dv, lane);
    set_coordinates(source, piece, uv, surface);
}

}  // namespace alhazen

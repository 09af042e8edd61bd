#include "alhazen/shapes/exact_surface.h"

#include <algorithm>
#include <limits>

#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

/// The part of `v` perpendicular to a unit axis. Computed twice, since near the axis the first
/// result is mostly rounding.
Vec3 across_axis(const Vec3& v, const Vec3& axis) {
    const Vec3 once = v - dot(v, axis) * axis;
    return once - dot(once, axis) * axis;
}

}  // namespace

PointOnSurface ExactSurface::nearest(const Vec3& from) const {
    std::optional<PointOnSurface> best;
    for (const Piece& piece : pieces_) {
        const auto found = std::visit([&](const auto& p) { return nearest_of(p, from); }, piece);
        if (found) keep_nearer(best, *found);
    }
    return best.value_or(PointOnSurface{{}, {}, std::numeric_limits<double>::infinity()});
}

std::size_t ExactSurface::bytes() const {
    std::size_t sum = sizeof(*this) + pieces_.capacity() * sizeof(Piece);
    for (const Piece& piece : pieces_) {
        if (const auto* const clipped = std::get_if<Clipped>(&piece)) {
            sum += clipped->region->bytes();
        } else if (const auto* const ring = std::get_if<Annulus>(&piece)) {
            sum += ring->outer->bytes() + (ring->hole ? ring->hole->bytes() : 0);
        } else if (const auto* const flat = std::get_if<Flat>(&piece)) {
            sum += flat->region->bytes();
        }
    }
    return sum;
}

std::optional<PointOnSurface> ExactSurface::nearest_of(const Ball& ball, const Vec3& from) {
    const Vec3 n = unit_or(from - ball.center, {0, 0, 1});
    const Vec3 x = ball.center + ball.radius * n;
    const double d = length(from - ball.center) - ball.radius;
    return PointOnSurface{x, n, d * d};
}

std::optional<PointOnSurface> ExactSurface::nearest_of(const Ring& ring, const Vec3& from) {
    const Vec3 offset = from - ring.center;
    const Vec3 out = unit_or(across_axis(offset, ring.axis), perpendicular(ring.axis));
    const Vec3 on_circle = ring.center + ring.major * out;
    const Vec3 n = unit_or(from - on_circle, out);
    const double d = length(from - on_circle) - ring.minor;
    return PointOnSurface{on_circle + ring.minor * n, n, d * d};
}

std::optional<PointOnSurface> ExactSurface::nearest_of(const Spindle& s, const Vec3& from) {
    const Vec3 offset = from - s.center;
    const double height = dot(offset, s.axis);
    const Vec3 across = across_axis(offset, s.axis);
    const Vec3 out = unit_or(across, perpendicular(s.axis));
    const Vec2 p{length(across), height};
    std::optional<PointOnSurface> best;
    // A line from a to b in the half plane of (distance from the axis, height); outside is to the
    // right.
    const auto line = [&](const Vec2& a, const Vec2& b) {
        const Vec2 d{b.x - a.x, b.y - a.y};
        const double squared = d.x * d.x + d.y * d.y;
        const double t =
            squared > 0.0 ? std::clamp(((p.x - a.x) * d.x + (p.y - a.y) * d.y) / squared, 0.0, 1.0)
                          : 0.0;
        const Vec2 q = t <= 0.5 ? Vec2{a.x + t * d.x, a.y + t * d.y}
                                : Vec2{b.x + (t - 1.0) * d.x, b.y + (t - 1.0) * d.y};
        const double dx = q.x - p.x, dy = q.y - p.y;
        keep_nearer(best, {s.center + q.x * out + q.y * s.axis,
                           unit_or(d.y * out - d.x * s.axis, s.axis), dx * dx + dy * dy});
    };
    const Vec2 base{s.base_radius, -s.half_height}, top{s.top_radius, s.half_height};
    line(base, top);
    if (s.capped) {
        line({0.0, base.y}, base);
        line(top, {0.0, top.y});
    }
    if (s.hollow) best->normal = -best->normal;
    return best;
}

std::optional<PointOnSurface> ExactSurface::nearest_of(const Wall& wall, const Vec3& from) {
    const double d = dot(from - wall.point, wall.normal);
    return PointOnSurface{from - d * wall.normal, wall.normal, d * d};
}

std::optional<PointOnSurface> ExactSurface::nearest_of(const Clipped& clipped, const Vec3& from) {
    std::optional<PointOnSurface> found = clipped.region->nearest(from - clipped.origin);
    if (!found) return found;
    found->point += clipped.origin;
    if (clipped.hollow) found->normal = -found->normal;
    return found;
}

std::optional<PointOnSurface> ExactSurface::nearest_of(const Annulus& annulus, const Vec3& from) {
    const Vec3 x = from - annulus.origin;
    const ClippedRegion::Plane& plane = annulus.outer->planes().front();
    const Vec3 foot = across_axis(x, plane.normal);
    std::optional<PointOnSurface> best;
    if (annulus.outer->value(foot) <= 0.0 && !(annulus.hole && annulus.hole->value(foot) < 0.0)) {
        best = PointOnSurface{foot, plane.normal, length_squared(foot - x)};
    } else {
        for (const ClippedRegion* region : {annulus.outer.get(), annulus.hole.get()}) {
            if (region == nullptr) continue;
            const auto rim = region->nearest_in_plane(x, plane);
            if (rim) keep_nearer(best, *rim);
        }
    }
    if (best) best->point += annulus.origin;
    return best;
}

}  // namespace alhazen

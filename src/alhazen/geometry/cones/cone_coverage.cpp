#include "alhazen/geometry/cones/cone_coverage.h"

#include <algorithm>
#include <cmath>

#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

/// Half angle in radians below which a cone uses the lens of two flat discs.
constexpr double kNarrow = 0.02;

double acos_of(double cosine) {
    return std::acos(std::clamp(cosine, -1.0, 1.0));
}

ConePoint mixed(const ConePoint& a, const ConePoint& b, double t) {
    return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.w + t * (b.w - a.w),
            a.z + t * (b.z - a.z)};
}

/// Clips by the method of Sutherland and Hodgman: keeps the part where `side` is not negative.
template <class In, class Side>
void clip_cone_loop(const In& in, std::vector<ConePoint>& out, Side&& side) {
    out.clear();
    const std::size_t n = in.size();
    for (std::size_t k = 0; k < n; ++k) {
        const ConePoint& a = in[k];
        const ConePoint& b = in[k + 1 == n ? 0 : k + 1];
        const double fa = side(a), fb = side(b);
        if (fa >= 0.0) out.push_back(a);
        if ((fa >= 0.0) != (fb >= 0.0)) out.push_back(mixed(a, b, fa / (fa - fb)));
    }
}

DiscPart part_of(std::span<const ConePoint> loop) {
    DiscPart sum;
    if (loop.size() < 3) return sum;
    const auto flat = [](const ConePoint& p) { return Vec2{p.x / p.w, p.y / p.w}; };
    Vec2 last = flat(loop.back());
    for (const ConePoint& p : loop) {
        const Vec2 next = flat(p);
        sum += edge_part(last, next);
        last = next;
    }
    return sum;
}

/// The part of the disc for a loop within the range: where w > 0 and, for a converging cone, also
/// where w < 0, beyond the focus.
DiscPart part_by_sides(std::vector<ConePoint>& loop, std::vector<ConePoint>& other,
                       bool converges) {
    double largest = 0.0;
    bool all_ahead = true;
    for (const ConePoint& p : loop) largest = std::max(largest, std::abs(p.w));
    const double least = 1e-9 * largest;
    for (const ConePoint& p : loop) all_ahead = all_ahead && p.w > least;
    if (all_ahead) return part_of(loop);
    clip_cone_loop(loop, other, [&](const ConePoint& p) { return p.w - least; });
    DiscPart sum = part_of(other);
    if (converges) {
        clip_cone_loop(loop, other, [&](const ConePoint& p) { return -least - p.w; });
        sum += part_of(other);
    }
    return sum;
}

/// Clips `scratch.a` to the range; the result is in `scratch.a`.
void clip_to_range(const ConeRange& range, ConeScratch& scratch) {
    const auto clip = [&](auto&& side) {
        clip_cone_loop(scratch.a, scratch.b, side);
        scratch.a.swap(scratch.b);
    };
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const ConePoint& p : scratch.a) {
        least = std::min(least, p.z);
        most = std::max(most, p.z);
    }
    if (least < range.z_min) clip([&](const ConePoint& p) { return p.z - range.z_min; });
    if (most > range.z_max) clip([&](const ConePoint& p) { return range.z_max - p.z; });
}

Vec2 clamped_to_disc(const Vec2& p) {
    const double l = std::sqrt(p.x * p.x + p.y * p.y);
    return l > 1.0 ? (1.0 / l) * p : p;
}

ConeCover cover_of_part(const DiscPart& part) {
    if (!(part.area > 1e-12)) return {};
    return {std::min(part.area / kPi, 1.0), clamped_to_disc(part.center())};
}

/// True if the triangle needs no clipping: all corners in front of the apex and within the range.
bool is_plain(const std::array<ConePoint, 3>& c, const ConeRange& range) {
    for (const ConePoint& p : c) {
        if (!(p.z >= range.z_min && p.z <= range.z_max && p.w > 0.0)) return false;
    }
    const double least = std::min({c[0].w, c[1].w, c[2].w});
    const double most = std::max({c[0].w, c[1].w, c[2].w});
    return least > 1e-9 * most;
}

/// True if all corners lie beyond one side of the square around the disc.
bool is_beside(const Vec2& a, const Vec2& b, const Vec2& c) {
    return std::min({a.x, b.x, c.x}) >= 1.0 || std::max({a.x, b.x, c.x}) <= -1.0 ||
           std::min({a.y, b.y, c.y}) >= 1.0 || std::max({a.y, b.y, c.y}) <= -1.0;
}

}  // namespace

double cap_share(double alpha, double beta, double gamma) {
    const double cone = 2.0 * kPi * (1.0 - std::cos(alpha));
    if (gamma >= alpha + beta) return 0.0;
    if (beta >= alpha + gamma) return 1.0;
    if (alpha >= beta + gamma) return 2.0 * kPi * (1.0 - std::cos(beta)) / cone;
    if (alpha + beta + gamma >= 2.0 * kPi) {
        // Each cap leaves out a cap of its own, and these two do not meet.
        return 1.0 - 2.0 * kPi * (1.0 + std::cos(beta)) / cone;
    }
    const double ca = std::cos(alpha), cb = std::cos(beta), cg = std::cos(gamma);
    const double sa = std::sin(alpha), sb = std::sin(beta), sg = std::sin(gamma);
    const double area = 2.0 * kPi - 2.0 * acos_of((cg - ca * cb) / (sa * sb)) -
                        2.0 * ca * acos_of((cb - cg * ca) / (sg * sa)) -
                        2.0 * cb * acos_of((ca - cg * cb) / (sg * sb));
    return std::clamp(area / cone, 0.0, 1.0);
}

SphereDisc sphere_disc(const ConeRay& cone, const ConeMap& map, const Vec3& center, double radius) {
    SphereDisc disc;
    const ConePoint c = map(center);
    const double across = std::sqrt(c.x * c.x + c.y * c.y);
    const double sign = c.w < 0.0 ? -1.0 : 1.0;
    if (across > 0.0) disc.towards = {sign * c.x / across, sign * c.y / across};
    const double growth = std::abs(cone.spread);
    if (growth < 1e-300 || growth * (across + radius + std::abs(c.z)) < 1e-9 * cone.radius) {
        disc.kind = SphereDisc::Kind::Disc;
        disc.radius = radius / cone.radius;
        disc.distance = across / cone.radius;
        return disc;
    }
    // Angles at the apex: that to the centre of the sphere, and the half angle of the sphere.
    const double along = std::abs(c.w) / growth;
    const double to_center = std::sqrt(across * across + along * along);
    if (to_center <= radius) {
        disc.kind = SphereDisc::Kind::All;
        return disc;
    }
    const double alpha = std::atan(growth);
    // A diverging cone covers nothing before its apex.
    const double gamma =
        cone.spread > 0.0 && c.w < 0.0 ? std::atan2(across, -along) : std::atan2(across, along);
    if (cone.spread > 0.0 && c.w < 0.0 && across > 0.0) disc.towards = {c.x / across, c.y / across};
    const double beta = std::asin(radius / to_center);
    if (gamma - beta >= alpha) return disc;
    disc.half_angle = alpha;
    disc.scale = std::tan(0.5 * alpha);
    disc.cap = beta;
    disc.offset = gamma;
    if (alpha > kNarrow) {
        disc.kind = SphereDisc::Kind::Cap;
        return disc;
    }
    const double near = std::tan(0.5 * (gamma - beta)) / disc.scale;
    if (gamma + beta > 3.0) {
        disc.kind = SphereDisc::Kind::HalfPlane;
        disc.distance = near;
        return disc;
    }
    const double far = std::tan(0.5 * (gamma + beta)) / disc.scale;
    disc.kind = SphereDisc::Kind::Disc;
    disc.radius = 0.5 * (far - near);
    disc.distance = 0.5 * (far + near);
    return disc;
}

Vec2 disc_point(const SphereDisc& sphere, double distance) {
    double u = distance;
    if (sphere.scale > 0.0) {
        const double e = distance * sphere.scale, k = sphere.scale;
        u = distance * ((1.0 - k * k) / (1.0 - e * e));
    }
    return clamped_to_disc(u * sphere.towards);
}

ConeCover cover_of(const SphereDisc& sphere) {
    switch (sphere.kind) {
        case SphereDisc::Kind::None:
            return {};
        case SphereDisc::Kind::All:
            return {1.0, {0, 0}};
        case SphereDisc::Kind::HalfPlane: {
            const double h = sphere.distance, area = segment_area(1.0, h);
            if (!(area > 0.0)) return {};
            const double chord = std::max((1.0 - h) * (1.0 + h), 0.0);
            return {area / kPi, disc_point(sphere, 2.0 / 3.0 * chord * std::sqrt(chord) / area)};
        }
        case SphereDisc::Kind::Disc: {
            const DiscPart part = lens(sphere.radius, sphere.distance);
            if (!(part.area > 0.0)) return {};
            return {std::min(part.area / kPi, 1.0), disc_point(sphere, part.center().x)};
        }
        case SphereDisc::Kind::Cap:
            break;
    }
    const double share = cap_share(sphere.half_angle, sphere.cap, sphere.offset);
    const double near = std::max(sphere.offset - sphere.cap, -sphere.half_angle);
    const double far = std::min(sphere.offset + sphere.cap, sphere.half_angle);
    return {share, disc_point(sphere, std::tan(0.25 * (near + far)) / sphere.scale)};
}

ConeCover plane_cover(const ConeRay& cone, const Vec3& point, const Vec3& normal,
                      const ConeRange& range) {
    const Vec3 ex = perpendicular(cone.axis), ey = cross(cone.axis, ex);
    const double height = dot(normal, cone.origin - point), fall = dot(normal, cone.axis);
    const double nx = dot(normal, ex), ny = dot(normal, ey);
    // Height above the plane at distance z along the line through (u, v).
    struct Height {
        double c, u, v;
        double operator()(const Vec2& p) const { return c + u * p.x + v * p.y; }
    };
    const auto height_at = [&](double z) {
        const double r = cone.radius_at(z);
        return Height{height + z * fall, r * nx, r * ny};
    };
    const Height first = height_at(range.z_min);
    const Height last = std::isfinite(range.z_max)
                            ? height_at(range.z_max)
                            : Height{fall, cone.spread * nx, cone.spread * ny};
    DiscPart sum;
    for (const double side : {1.0, -1.0}) {
        std::array<Vec2, 8> loop{Vec2{-2, -2}, Vec2{2, -2}, Vec2{2, 2}, Vec2{-2, 2}};
        std::size_t n = 4;
        const auto clip = [&](const Height& h, double sign) {
            std::array<Vec2, 8> out;
            std::size_t m = 0;
            for (std::size_t k = 0; k < n; ++k) {
                const Vec2 a = loop[k], b = loop[(k + 1) % n];
                const double fa = sign * h(a), fb = sign * h(b);
                if (fa > 0.0) out[m++] = a;
                if ((fa > 0.0) != (fb > 0.0)) out[m++] = a + (fa / (fa - fb)) * (b - a);
            }
            loop = out;
            n = m;
        };
        clip(first, side);
        clip(last, -side);
        if (n >= 3) sum += loop_part({loop.data(), n});
    }
    return cover_of_part(sum);
}

DiscPart loop_cover(const ConeMap& map, std::span<const Vec3> loop, const ConeRange& range,
                    ConeScratch& scratch) {
    scratch.a.clear();
    for (const Vec3& p : loop) scratch.a.push_back(map(p));
    clip_to_range(range, scratch);
    return part_by_sides(scratch.a, scratch.b, map.converges);
}

ConeCover polygon_cover(const ConeMap& map, std::span<const Vec3> vertices,
                        std::span<const std::uint32_t> loop_ends, const ConeRange& range,
                        ConeScratch& scratch, bool* front) {
    DiscPart sum;
    std::size_t first = 0;
    if (loop_ends.empty()) {
        sum = loop_cover(map, vertices, range, scratch);
    } else {
        for (const std::size_t end : loop_ends) {
            sum += loop_cover(map, vertices.subspan(first, end - first), range, scratch);
            first = end;
        }
    }
    if (front != nullptr) *front = sum.area < 0.0;
    if (sum.area < 0.0) sum = {-sum.area, -1.0 * sum.moment};
    return cover_of_part(sum);
}

ConeCover triangle_cover(const std::array<ConePoint, 3>& corners, const ConeRange& range,
                         bool converges, bool& front) {
    DiscPart part;
    if (is_plain(corners, range)) {
        const auto flat = [](const ConePoint& p) { return Vec2{p.x / p.w, p.y / p.w}; };
        const Vec2 a = flat(corners[0]), b = flat(corners[1]), c = flat(corners[2]);
        if (is_beside(a, b, c)) return {};
        part = edge_part(a, b);
        part += edge_part(b, c);
        part += edge_part(c, a);
    } else {
        thread_local ConeScratch scratch;
        scratch.a.assign(corners.begin(), corners.end());
        clip_to_range(range, scratch);
        part = part_by_sides(scratch.a, scratch.b, converges);
    }
    front = part.area < 0.0;
    if (front) part = {-part.area, -1.0 * part.moment};
    return cover_of_part(part);
}

TrianglePlace place_in_triangle(const std::array<ConePoint, 3>& corners, const Vec2& at) {
    // The weights b for which sum b (x, y, w) is parallel to (u, v, 1).
    const auto of = [](const ConePoint& p) { return Vec3{p.x, p.y, p.w}; };
    const Vec3 a = of(corners[0]), b = of(corners[1]), c = of(corners[2]), q{at.x, at.y, 1.0};
    double wa = dot(q, cross(b, c)), wb = dot(q, cross(c, a)), wc = dot(q, cross(a, b));
    const double sum = wa + wb + wc;
    if (sum == 0.0 || !std::isfinite(sum)) {
        return {1.0 / 3, 1.0 / 3, (corners[0].z + corners[1].z + corners[2].z) / 3.0};
    }
    wb = std::clamp(wb / sum, 0.0, 1.0);
    wc = std::clamp(wc / sum, 0.0, 1.0 - wb);
    wa = 1.0 - wb - wc;
    return {wb, wc, wa * corners[0].z + wb * corners[1].z + wc * corners[2].z};
}

}  // namespace alhazen

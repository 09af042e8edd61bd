#include "alhazen/solids/solid_coordinates.h"

#include <cmath>

namespace alhazen {

namespace {

/// The change of the coordinates by a step, in the plane of the derivatives; zero if there are
/// none.
Vec2 change_of(const IsolatedSolid::Coordinates& at, const Vec3& step) {
    const double uu = dot(at.dpdu, at.dpdu), uv = dot(at.dpdu, at.dpdv);
    const double vv = dot(at.dpdv, at.dpdv), det = uu * vv - uv * uv;
    if (!(det > 1e-12 * uu * vv)) return {0, 0};
    const double along_u = dot(at.dpdu, step), along_v = dot(at.dpdv, step);
    return {(vv * along_u - uv * along_v) / det, (uu * along_v - uv * along_u) / det};
}

/// A coordinate plus the whole turns that bring it near to `expected`; if none do (near a pole),
/// near to `beside`, the coordinate at a near place.
double continued(double own, double expected, double beside) {
    constexpr double kFar = 0.25;
    const double turns = std::round(expected - own);
    if (std::abs(expected - (own + turns)) <= kFar) return own + turns;
    return own + std::round(beside - own);
}

}  // namespace

SolidCoordinates::Place SolidCoordinates::place(const Hit& hit) {
    std::vector<std::uint32_t> key{static_cast<std::uint32_t>(hit.primitive), hit.part};
    for (const PrimitiveId id : hit.path) key.push_back(static_cast<std::uint32_t>(id));
    const auto next = static_cast<std::uint32_t>(surfaces_.size());
    const auto [found, is_new] = numbers_.try_emplace(std::move(key), next);
    if (is_new) surfaces_.push_back(hit);
    return {found->second, hit.u, hit.v};
}

Vec2 SolidCoordinates::uv(const Vec3& vertex, const Vec3& at, const Place& place) const {
    if (place.surface == kNoSurface) return {0, 0};
    Hit hit = surfaces_[place.surface];
    hit.u = place.u;
    hit.v = place.v;
    const IsolatedSolid::Coordinates here = solid_.coordinates(at, hit);
    const IsolatedSolid::Coordinates there = solid_.coordinates(vertex, hit);
    // Shapes with parameters of their own stay at those of the hit.
    const Vec2 own = there.uv + change_of(there, vertex - there.point);
    const Vec2 expected = here.uv + change_of(here, vertex - here.point);
    return {continued(own.x, expected.x, here.uv.x), continued(own.y, expected.y, here.uv.y)};
}

bool SolidCoordinates::are_near(const Vec2& a, const Vec2& b) {
    constexpr double kNear = 0.25;
    return std::abs(a.x - b.x) < kNear && std::abs(a.y - b.y) < kNear;
}

}  // namespace alhazen

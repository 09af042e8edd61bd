#include <algorithm>
#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/renderers/cone_tracing/cone_tracer.h"

namespace alhazen {

namespace {

/// The footprint of a piece as seen from a light, as a row of discs along its longer axis.
struct FootprintDiscs {
    static constexpr int kMost = 6;
    struct Disc {
        Vec3 center;
        double radius = 0, weight = 0;
    };
    std::array<Disc, kMost> discs;
    int count = 0;
};

/// `radius`: of the piece, perpendicular to `ray`; `n`: surface normal at `point`; `most`: limit of
/// the number of discs.
FootprintDiscs discs_of_footprint(const Vec3& point, const Vec3& n, const Vec3& ray, double radius,
                                  const Vec3& to_light, int most) {
    constexpr double kLeastCosine = 0.02;
    const double cosine = std::max(std::abs(dot(ray, n)), kLeastCosine);
    const Vec3 in_plane = ray - dot(ray, n) * n;
    const double sine = length(in_plane);
    const Vec3 along = sine > 1e-9 ? in_plane / sine : perpendicular(n);
    // Semi-axes on the surface, and projected towards the light.
    const Vec3 a = (radius / cosine) * along, b = radius * cross(n, along);
    const Vec3 seen_a = a - dot(a, to_light) * to_light, seen_b = b - dot(b, to_light) * to_light;
    const double angle = 0.5 * std::atan2(2.0 * dot(seen_a, seen_b),
                                          length_squared(seen_a) - length_squared(seen_b));
    const double c = std::cos(angle), s = std::sin(angle);
    const Vec3 axis = c * a + s * b;
    const double major = length(c * seen_a + s * seen_b), minor = length(c * seen_b - s * seen_a);
    FootprintDiscs result;
    const double ratio = major / std::max(minor, 1e-3 * major);
    result.count = std::clamp(static_cast<int>(ratio + 0.5), 1, most);
    double sum = 0.0;
    for (int k = 0; k < result.count; ++k) {
        FootprintDiscs::Disc& disc = result.discs[static_cast<std::size_t>(k)];
        const double x = (2.0 * k + 1.0) / result.count - 1.0;
        disc.center = point + x * axis;
        disc.weight = std::sqrt(1.0 - x * x);
        sum += disc.weight;
    }
    for (int k = 0; k < result.count; ++k) {
        FootprintDiscs::Disc& disc = result.discs[static_cast<std::size_t>(k)];
        disc.weight /= sum;
        disc.radius = std::sqrt(disc.weight * major * minor);
    }
    return result;
}

}  // namespace

Rgb ConeTracer::shadow_at(const Seen& seen, const ShadingPoint& point, std::size_t number,
                          const LightSample& light, double light_radius) {
    if (conventions_.shadow_tint == ShadingConventions::ShadowTint::None) return {1, 1, 1};
    const bool towards = dot(point.geometric, light.to_light) > 0.0;
    const bool closed = geometry_.sources[seen.piece.source].closed;
    // True if the shadow cone starts inside the solid.
    const bool within = closed && seen.piece.front != towards;
    if (within && seen.piece.front && point.material->transmissive.is_black() &&
        !geometry_.sources[seen.piece.source].has_alpha) {
        return {};
    }
    // One disc is sufficient for a small part of a cone.
    const int most = seen.depth == 0 && seen.piece.share > 0.5 ? FootprintDiscs::kMost : 1;
    const FootprintDiscs discs =
        discs_of_footprint(point.surface.point, point.geometric, seen.ray.direction, seen.radius,
                           light.to_light, most);
    const bool bounded = std::isfinite(light.distance);
    const Vec3 place = point.surface.point + (bounded ? light.distance : 0.0) * light.to_light;
    Rgb sum;
    for (int k = 0; k < discs.count; ++k) {
        const FootprintDiscs::Disc& disc = discs.discs[static_cast<std::size_t>(k)];
        ConeRay cone{disc.center, light.to_light, disc.radius, 0.0};
        double distance = light.distance;
        if (bounded) {
            distance = length(place - disc.center);
            cone.axis = (place - disc.center) / distance;
            cone.spread = std::min((light_radius - disc.radius) / distance, kWidestSpread);
        }
        ConeStart start = onward(seen, point, cone).start;
        start.kind = RayKind::Shadow;
        start.range.z_max = distance;
        if (closed) start.set_inside(seen.piece.source, within);
        sum += disc.weight *
               let_through(cone, start, {number, k, discs.count, disc.weight}, &seen.path);
    }
    return sum;
}

Rgb ConeTracer::let_through(const ConeRay& cone, const ConeStart& start, const ConeToLight& to,
                            const ConePath* from) {
    ++counters_[RayKind::Shadow].cast;
    ConeRay part = cone;
    Rgb left;
    light_inside_.reset();
    begin_way(cone, start, from);
    for (int k = 0; !find_blocked(part, start, left) && k < kMostNarrowings; ++k) {
        part = narrowed(part);
    }
    if (way_ == Way::ToLight) left = left * volumes_.through(start.range.z_max);
    if (watcher_ != nullptr) watcher_->shadow_cone(part, start.range.z_max, left, to);
    return left;
}

/// Sets the volumes around the start of a shadow cone, and where it leaves the innermost one.
void ConeTracer::begin_way(const ConeRay& cone, const ConeStart& start, const ConePath* from) {
    way_ = Way::Clear;
    volumes_.clear();
    if (from == nullptr) return;
    start_inside(conventions_, tinted_, from->medium, from->inside, from->absorption, volumes_);
    const bool hidden =
        !start.inside.empty() &&
        (geometry_.sources[start.inside.back()].visible_to & mask_of(RayKind::Shadow)) == 0;
    if (volumes_.empty() || hidden) return;
    const bool bounded = std::isfinite(start.range.z_max);
    const bool leaves = !start.inside.empty() &&
                        !(bounded && contains_point(geometry_, start.inside.back(),
                                                    cone.origin + start.range.z_max * cone.axis));
    if (leaves) {
        way_ = Way::ToWall;
    } else if (bounded) {
        way_ = Way::ToLight;
    }
}

bool ConeTracer::find_blocked(const ConeRay& cone, const ConeStart& start, Rgb& result) {
    ConeSurfaces<Rgb> surfaces;
    int pieces = 0;
    Crossed crossed{0.0, !volumes_.empty()};
    search_.begin(cone, start);
    ConePiece piece;
    while (search_.next(piece)) {
        PieceInShadow met;
        if (!cross_piece(piece, cone, start, crossed, met)) continue;
        if (++pieces > kMostPieces) break;
        SurfaceShare part = share_of(piece, start);
        part.coverage = met.coverage;
        std::size_t layer = 0;
        surfaces.add(part, met.tint, layer);
        if (!(surfaces.left().max() >= kLeastTransmittance)) break;
    }
    counters_[RayKind::Shadow].hit += pieces > 0;
    result = surfaces.left();
    return pieces <= kMostPieces;
}

bool ConeTracer::cross_piece(const ConePiece& piece, const ConeRay& cone, const ConeStart& start,
                             Crossed& crossed, PieceInShadow& met) {
    const ConeSource& source = geometry_.sources[piece.source];
    using Tint = ShadingConventions::ShadowTint;
    const bool opaque = conventions_.shadow_tint == Tint::Opaque;
    if (scene_.all_opaque || (opaque && !source.may_pass)) return true;
    ConePath path;
    path.start = start;
    const Seen seen = seen_at(piece, cone, path, 0);
    ShadingPoint point;
    set_point(seen, point, true);
    const MaterialSample& material = *point.material;
    const bool unseen = is_unseen_from_behind(material);
    // Light that comes to the back of a single-sided surface passes it.
    if (unseen && point.entering) return false;
    // Parts of an oblique disc at the start lie behind the surfaces beside it.
    if (unseen && !(piece.z >= start.clear)) return false;
    if (piece.far_side && !source.has_alpha && !unseen) return false;
    met.coverage = material.coverage;
    const Crossed before = crossed;
    if (!material.physical || !material.thin) crossed.last = seen.t;
    if (!piece.front && start.is_inside(piece.source)) crossed.within = false;
    const Rgb& kt = material.transmissive;
    if (opaque || kt.is_black()) return true;
    const bool by_distance = conventions_.shadow_tint == Tint::PerDistance && !material.physical;
    if (!source.closed) {
        // By distance an open surface tints the way to its front, but not inside a body.
        const bool tints = !by_distance || (!point.entering && !before.within);
        if (tints) met.tint = by_distance ? power(kt, std::max(seen.t - before.last, 0.0)) : kt;
        if (!tints) met.tint = {1, 1, 1};
        return true;
    }
    // The front of a solid without alpha stands for its far wall, too, by what passes there.
    const bool whole = piece.front && !source.has_alpha;
    const bool ends_inside = piece.front && light_is_inside(piece.source, cone, start);
    const bool crosses = whole && !ends_inside;
    met.tint = by_distance ? Rgb{1, 1, 1}
               : !crosses  ? kt
                           : kt * (source.varies ? passing_far_wall(seen, source) : kt);
    const bool absorbs = material.physical && !material.thin && !material.absorption.is_black();
    if (!by_distance && !absorbs && (piece.front || way_ != Way::ToWall)) return true;
    const double t_light =
        piece.z > 0.0 ? start.range.z_max * (seen.t / piece.z) : start.range.z_max;
    Rgb way{1, 1, 1};
    if (piece.front) {
        if (!whole && !ends_inside) return true;
        const double length = length_behind(seen, source, t_light, ends_inside);
        crossed.last += length;
        way = by_distance ? power(kt, length) : transmittance(material.absorption, length);
    } else {
        const double length = length_before(seen, source, start);
        if (by_distance) {
            met.tint = power(kt, length);
        } else if (way_ == Way::ToWall && start.inside.back() == piece.source) {
            way = volumes_.through(seen.t);
        } else if (!start.is_inside(piece.source) && length < seen.t) {
            way = transmittance(material.absorption, length);
        }
    }
    // The way is that of all light, whether it passes beside the points that are covered or not.
    const double open = 1.0 - met.coverage;
    met.tint = way * (Rgb{open, open, open} + met.coverage * met.tint);
    met.coverage = 1.0;
    return true;
}

/// What the wall lets through at which the line of a piece leaves the solid that it enters.
Rgb ConeTracer::passing_far_wall(const Seen& seen, const ConeSource& source) const {
    ConeWall wall{.t = chord_of(seen, source)};
    if (source.kind != ConeSource::Kind::Sphere) {
        const Ray rest{seen.ray.at(seen.t), seen.ray.direction, 0.0, kInfinity};
        wall = wall_ahead(geometry_, seen.piece.source, seen.piece.part, rest);
        // Rounding may lose the exit at an edge.
        if (!std::isfinite(wall.t)) wall = {0.0, seen.piece.part, seen.piece.u, seen.piece.v};
    }
    ConePiece piece = seen.piece;
    piece.front = false;
    piece.part = wall.part;
    piece.u = wall.u;
    piece.v = wall.v;
    ShadingPoint point;
    set_point({piece, seen.cone, seen.path, seen.ray, seen.t + wall.t, seen.radius, seen.depth},
              point, true);
    return point.material->transmissive;
}

/// The length of the line of a piece inside the solid that it enters, up to the light.
double ConeTracer::length_behind(const Seen& seen, const ConeSource& source, double t_light,
                                 bool ends_inside) const {
    if (source.kind == ConeSource::Kind::Sphere && !ends_inside) return chord_of(seen, source);
    const Ray rest{seen.ray.at(seen.t), seen.ray.direction, 0.0, std::max(t_light - seen.t, 0.0)};
    const double length = wall_ahead(geometry_, seen.piece.source, seen.piece.part, rest).t;
    return std::isfinite(length) ? length : 0.0;
}

/// The length of the line of a piece inside the solid that it leaves, from the start of the cone.
double ConeTracer::length_before(const Seen& seen, const ConeSource& source,
                                 const ConeStart& start) const {
    if (!source.has_alpha && start.is_inside(seen.piece.source)) return seen.t;
    const Ray back{seen.ray.at(seen.t), -seen.ray.direction, 0.0, seen.t};
    return wall_ahead(geometry_, seen.piece.source, seen.piece.part, back).t;
}

bool ConeTracer::light_is_inside(std::uint32_t number, const ConeRay& cone,
                                 const ConeStart& start) {
    if (geometry_.sources[number].kind == ConeSource::Kind::Plane) return true;
    if (!std::isfinite(start.range.z_max)) return false;
    if (!light_inside_ || light_inside_->source != number) {
        const Vec3 light = cone.origin + start.range.z_max * cone.axis;
        light_inside_ = LightInside{number, contains_point(geometry_, number, light)};
    }
    return light_inside_->inside;
}

}  // namespace alhazen

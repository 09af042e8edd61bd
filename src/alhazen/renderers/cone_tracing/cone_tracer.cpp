#include "alhazen/renderers/cone_tracing/cone_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "alhazen/primitives/placed_surface.h"
#include "alhazen/renderers/core/refraction.h"
#include "alhazen/renderers/core/rough_lobe.h"

namespace alhazen {

namespace {

/// Largest number of shaded pieces per surface, for the cone of a pixel and for secondary cones.
constexpr std::size_t kShadedPieces = 4, kShadedPiecesOnward = 1;
/// A cone that meets more pieces is narrowed.
constexpr int kMostPieces = 192;
constexpr int kMostNarrowings = 16;  ///< afterwards the nearest pieces are taken
/// Pieces of a smaller share of the pixel start no secondary cones.
constexpr double kLeastConeShare = 1.0 / 256;

/// The cone with half the width.
ConeRay narrowed(const ConeRay& cone) {
    return {cone.origin, cone.axis, 0.5 * cone.radius, 0.5 * cone.spread};
}
/// The side of a square of the area of a disc of radius 1.
constexpr double kSideOfDisc = 1.7724538509055159;

Ray line_of(const ConeRay& cone, const Vec2& at) {
    const Vec3 ex = perpendicular(cone.axis), ey = cross(cone.axis, ex);
    const Vec3 across = at.x * ex + at.y * ey;
    return {cone.origin + cone.radius * across, cone.axis + cone.spread * across};
}

/// Adds a solid to the solids that contain the start of a cone, or removes it.
void set_inside(ConeStart& start, std::uint32_t source, bool inside) {
    SolidsAround around;
    for (const std::uint32_t k : start.inside) {
        if (k != source) around.push_back(k);
    }
    if (inside && !around.full()) around.push_back(source);
    start.inside = around;
}

/// Coordinates of a vector in the plane of two others, relative to them.
Vec2 in_edges(const Vec3& v, const Vec3& a, const Vec3& b) {
    const double aa = dot(a, a), bb = dot(b, b), ab = dot(a, b);
    const double det = aa * bb - ab * ab;
    if (!(det > 1e-14 * aa * bb)) return {};
    const double va = dot(v, a), vb = dot(v, b);
    return {(bb * va - ab * vb) / det, (aa * vb - ab * va) / det};
}

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

/// Radius of a disc with the light's projected area along `direction`; 0 for a point light.
double radius_of(const Light& light, const Vec3& direction) {
    const auto* area = std::get_if<AreaLight>(&light);
    if (area == nullptr) return 0.0;
    return std::sqrt(area->surface->projected_area(direction) * std::numbers::inv_pi);
}

}  // namespace

ConeRay cone_to_light(const Vec3& point, const Vec3& center, double radius) {
    const Vec3 offset = center - point;
    const double d = length(offset);
    const double spread =
        d > radius ? radius / std::sqrt((d - radius) * (d + radius)) : kWidestSpread;
    return {point, offset / d, 0.0, std::min(spread, kWidestSpread)};
}

ConeTracer::ConeTracer(const RenderJob& job, const ConeScene& scene, bool tables,
                       RayCounters& counters)
    : job_(job),
      scene_(job.scene),
      conventions_(job.scene.conventions.shading),
      geometry_(scene),
      counters_(counters),
      ambient_(ambient_terms(job.scene.lights)),
      depth_(job.camera),
      search_(scene, tables) {}

Rgb ConeTracer::trace_eye(const ConeRay& cone, PixelGeometry* geometry) {
    if (eye_ != cone.origin) {
        eye_ = cone.origin;
        eye_path_.start.inside = solids_around(geometry_, cone.origin);
    }
    return trace(cone, eye_path_, 0, geometry);
}

Rgb ConeTracer::trace(const ConeRay& whole, const ConePath& path, int depth,
                      PixelGeometry* geometry) {
    ++counters_[path.start.kind].cast;
    if (job_.stop_requested()) return {};
    while (frames_.size() <= static_cast<std::size_t>(depth)) frames_.emplace_back();
    std::vector<SeenPiece>& pieces = frames_[static_cast<std::size_t>(depth)];
    ConeRay cone = whole;
    double left = 1.0;
    for (int k = 0; !gather(cone, path, depth, pieces, left) && k < kMostNarrowings; ++k) {
        cone = narrowed(cone);
    }
    if (watcher_ != nullptr) watcher_->begin_cone(whole, cone, path, depth);
    Rgb sum = left * scene_.background;
    counters_[path.start.kind].hit += !pieces.empty();
    const SeenPiece* largest = nullptr;
    for (const SeenPiece& s : pieces) {
        if (largest == nullptr || s.weight > largest->weight) largest = &s;
    }
    for (const SeenPiece& s : pieces) {
        Seen seen = seen_at(s.piece, cone, path, depth);
        ShadingPoint point;
        set_point(seen, point);
        if (geometry != nullptr && &s == largest) {
            geometry->add_ids(point.surface);
            geometry->add(point, depth_);
        }
        ConePath within = path;
        within.contribution = s.weight * path.contribution;
        const Seen weighted{s.piece, cone, within, seen.ray, seen.t, seen.radius, depth};
        if (watcher_ != nullptr) {
            watcher_->begin_piece(s.piece, s.weight, seen.radius, seen.t, point);
        }
        Rgb color = color_of(weighted, point);
        if (!path.absorption.is_black()) color = color * transmittance(path.absorption, seen.t);
        if (watcher_ != nullptr) watcher_->end_piece(color);
        sum += s.weight * color;
    }
    if (watcher_ != nullptr) watcher_->end_cone(left, sum);
    return sum;
}

bool ConeTracer::gather(const ConeRay& cone, const ConePath& path, int depth,
                        std::vector<SeenPiece>& pieces, double& left) {
    pieces.clear();
    ConeSurfaces surfaces;
    left = 1.0;
    int count = 0;
    search_.begin(cone, path.start);
    ConePiece piece;
    while (search_.next(piece)) {
        if (++count > kMostPieces) return false;
        const ConeSource& source = geometry_.sources[piece.source];
        double share = piece.share;
        if (source.may_pass) {
            ShadingPoint point;
            set_point(seen_at(piece, cone, path, depth), point);
            share *= point.material->coverage;
        }
        std::size_t surface = 0;
        const double weight = surfaces.add(source.surface, piece.front, share, surface);
        if (!(weight > 0.0)) continue;
        pieces.push_back({piece, weight, surface});
        left = surfaces.left();
        if (!(left >= kLeastTransmittance)) break;
    }
    thin_out(pieces, depth == 0 ? kShadedPieces : kShadedPiecesOnward);
    return true;
}

ConeTracer::Seen ConeTracer::seen_at(const ConePiece& piece, const ConeRay& cone,
                                     const ConePath& path, int depth) const {
    Ray ray = line_of(cone, piece.at);
    const double scale = length(ray.direction);
    ray.direction = ray.direction / scale;
    const double size = std::sqrt(std::min(piece.share, 1.0));
    return {piece, cone, path, ray, piece.z * scale, std::abs(cone.radius_at(piece.z)) * size,
            depth};
}

void ConeTracer::set_point(const Seen& seen, ShadingPoint& point) {
    const ConeSource& source = geometry_.sources[seen.piece.source];
    const Placement* placement = source.placed ? &source.placement : nullptr;
    if (source.kind == ConeSource::Kind::Mesh) {
        Hit hit;
        hit.t = seen.t;
        hit.u = seen.piece.u;
        hit.v = seen.piece.v;
        set_mesh_surface(source.mesh, seen.piece.part, placement, hit, point.surface);
    } else {
        set_shape_surface(*source.shape, placement, seen.ray,
                          hit_of_face(*source.shape, placement, seen.ray, seen.t, seen.piece.part),
                          !scene_.textures.empty() || job_.aovs != nullptr, point.surface);
        point.surface.materials[0] = source.material;
    }
    point.surface.part = source.part;
    point.surface.instance = source.instance;
    complete_shading_point(scene_, seen.ray, {seen.path.inside, kSideOfDisc * seen.radius}, {},
                           point);
}

Rgb ConeTracer::color_of(const Seen& seen, const ShadingPoint& point) {
    if (point.material->unlit) return point.material->emission;
    Rgb color = unshadowed_terms(conventions_, ambient_, point) + direct_light(seen, point);
    if (seen.depth < conventions_.max_depth) {
        if (conventions_.trace_reflections) color += reflected(seen, point);
        if (conventions_.trace_refractions) color += transmitted(seen, point);
    }
    return color * tint_along(conventions_, point, scene_.is_closed(point.surface.part), tinted_,
                              seen.path.medium, seen.t);
}

Rgb ConeTracer::direct_light(const Seen& seen, const ShadingPoint& point) {
    Rgb sum;
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
        const Light& light = scene_.lights[i];
        if (!illuminates(light)) continue;
        const LightSample l = sample(light, point.surface.point, conventions_.clamp_attenuation);
        const double cosine = dot(point.normal, l.to_light);
        if (!(cosine > 0.0) || l.intensity.is_black()) continue;
        const Rgb fraction = reflected_fraction(conventions_, point, l, cosine);
        if (fraction.is_black()) continue;
        sum += fraction * l.intensity * shadow_at(seen, point, i, l, radius_of(light, l.to_light));
    }
    return sum;
}

Rgb ConeTracer::shadow_at(const Seen& seen, const ShadingPoint& point, std::size_t number,
                          const LightSample& light, double light_radius) {
    if (conventions_.shadow_tint == ShadingConventions::ShadowTint::None) return {1, 1, 1};
    const bool towards = dot(point.geometric, light.to_light) > 0.0;
    const bool closed = geometry_.sources[seen.piece.source].closed;
    // True if the shadow cone starts inside the solid.
    const bool within = closed && seen.piece.front != towards;
    if (within && seen.piece.front && point.material->transmissive.is_black()) return {};
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
        if (closed) set_inside(start, seen.piece.source, within);
        sum += disc.weight * let_through(cone, start, {number, k, discs.count, disc.weight});
    }
    return sum;
}

Rgb ConeTracer::let_through(const ConeRay& cone, const ConeStart& start, const ConeToLight& to) {
    ++counters_[RayKind::Shadow].cast;
    ConeRay part = cone;
    Rgb left;
    for (int k = 0; !find_blocked(part, start, left) && k < kMostNarrowings; ++k) {
        part = narrowed(part);
    }
    if (watcher_ != nullptr) watcher_->shadow_cone(part, start.range.z_max, left, to);
    return left;
}

bool ConeTracer::find_blocked(const ConeRay& cone, const ConeStart& start, Rgb& result) {
    ConeSurfaces surfaces;
    std::array<double, ConeSurfaces::kMost> filled{};
    std::array<Rgb, ConeSurfaces::kMost> passed{};
    std::size_t count = 0;
    int pieces = 0;
    search_.begin(cone, start);
    ConePiece piece;
    while (search_.next(piece)) {
        if (++pieces > kMostPieces) break;
        double share = piece.share;
        const Rgb tint = transmittance_of(piece, cone, start, share);
        std::size_t k = 0;
        surfaces.add(geometry_.sources[piece.source].surface, piece.front, share, k);
        count = std::max(count, k + 1);
        const double own = std::min(share, 1.0 - filled[k]);
        filled[k] += own;
        passed[k] += own * tint;
        Rgb left{1, 1, 1};
        for (std::size_t i = 0; i < count; ++i) {
            const double open = 1.0 - filled[i];
            left = left * (Rgb{open, open, open} + passed[i]);
        }
        if (!(left.max() >= kLeastTransmittance)) break;
    }
    counters_[RayKind::Shadow].hit += pieces > 0;
    Rgb left{1, 1, 1};
    for (std::size_t i = 0; i < count; ++i) {
        const double open = std::max(1.0 - filled[i], 0.0);
        left = left * (Rgb{open, open, open} + passed[i]);
    }
    result = left;
    return pieces <= kMostPieces;
}

Rgb ConeTracer::transmittance_of(const ConePiece& piece, const ConeRay& cone,
                                 const ConeStart& start, double& share) {
    const ConeSource& source = geometry_.sources[piece.source];
    using Tint = ShadingConventions::ShadowTint;
    if (scene_.all_opaque || (conventions_.shadow_tint == Tint::Opaque && !source.may_pass)) {
        return {};
    }
    ConePath path;
    path.start = start;
    ShadingPoint point;
    const Seen seen = seen_at(piece, cone, path, 0);
    set_point(seen, point);
    share *= point.material->coverage;
    const Rgb& kt = point.material->transmissive;
    if (conventions_.shadow_tint == Tint::Opaque || kt.is_black()) return {};
    if (conventions_.shadow_tint == Tint::PerDistance && !point.material->physical) {
        if (source.kind != ConeSource::Kind::Sphere) return piece.front ? kt : Rgb{1, 1, 1};
        const Vec3 from = seen.ray.at(seen.t) - source.point;
        const double chord = 2.0 * std::abs(dot(from, seen.ray.direction));
        return power(kt, piece.front ? chord : seen.t);
    }
    // Light crosses the boundary of a solid twice.
    return source.closed && piece.front ? kt * kt : kt;
}

double ConeTracer::least_contribution() const {
    return std::max(conventions_.min_contribution, kLeastConeShare);
}

ConePath ConeTracer::onward(const Seen& seen, const ShadingPoint& point,
                            const ConeRay& cone) const {
    ConePath path;
    path.start.source = seen.piece.source;
    path.start.part = seen.piece.part;
    path.start.inside = seen.path.start.inside;
    path.inside = seen.path.inside;
    path.absorption = seen.path.absorption;
    path.medium = seen.path.medium;
    // The disc at the start is oblique to the surface: its lower half lies below.
    const double cosine = std::max(std::abs(dot(cone.axis, point.geometric)), 0.05);
    const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
    path.start.clear = cone.radius * (sine / cosine + 0.05);
    path.start.range.z_min = 1e-9 * (1.0 + max_component(abs(point.surface.point)));
    return path;
}

SectionCurvatures ConeTracer::curvatures(const Seen& seen, const ShadingPoint& point) const {
    const ConeSource& source = geometry_.sources[seen.piece.source];
    const double side = point.entering ? 1.0 : -1.0;
    if (source.kind == ConeSource::Kind::Sphere) {
        return {side / source.radius, side / source.radius};
    }
    if (source.kind != ConeSource::Kind::Mesh) return {};
    const TriangleMesh& mesh = *source.mesh.mesh;
    if (mesh.normals.empty()) return {};
    // Derivative of the interpolated normal along the edges.
    const auto& corner = mesh.triangles[seen.piece.part];
    const auto position = [&](std::size_t k) {
        return source.placement.outer_from_inner.point(mesh.positions[corner[k]]);
    };
    const auto normal = [&](std::size_t k) {
        const Vec3 n =
            transpose_times(source.placement.inner_from_outer.linear, mesh.normals[corner[k]]);
        return normalize(n);
    };
    const Vec3 a = position(1) - position(0), b = position(2) - position(0);
    const Vec3 na = normal(1) - normal(0), nb = normal(2) - normal(0);
    const Vec3& n = point.geometric;
    const Vec3 in_plane = seen.ray.direction - dot(seen.ray.direction, n) * n;
    const double sine = length(in_plane);
    const Vec3 along = sine > 1e-6 ? in_plane / sine : perpendicular(n);
    const auto section = [&](const Vec3& d) {
        const Vec2 c = in_edges(d, a, b);
        return dot(c.x * na + c.y * nb, d);
    };
    // Vertex normals face outward; they are reversed for a cone from behind.
    const double sign = dot(normal(0), n) < 0.0 ? -1.0 : 1.0;
    return {sign * section(along), sign * section(cross(n, along))};
}

Rgb ConeTracer::reflected(const Seen& seen, const ShadingPoint& point) {
    const Rgb& kr = point.material->reflective;
    const bool cast = !kr.is_black() || (conventions_.transmitting_surfaces_reflect &&
                                         !point.material->transmissive.is_black());
    const Rgb contribution = seen.path.contribution * kr;
    if (!cast || contribution.max() < least_contribution()) return {};
    Vec3 direction = mirror(seen.ray.direction, point.normal);
    if (conventions_.correct_interpolated_normals && dot(direction, point.geometric) < 0.0) {
        direction = mirror(seen.ray.direction, point.geometric);
    }
    const double cosine = std::max(std::abs(dot(seen.ray.direction, point.normal)), 0.02);
    const double scale = std::sqrt(std::min(seen.piece.share, 1.0));
    const double sign = seen.cone.radius_at(seen.piece.z) < 0.0 ? -1.0 : 1.0;
    const double exact = mirrored_spread(seen.radius, sign * scale * seen.cone.spread, cosine,
                                         curvatures(seen, point));
    const double dull = lobe_half_angle(point.material->roughness);
    const ConeRay cone{point.surface.point, direction, seen.radius, widened_spread(exact, dull)};
    ConePath path = onward(seen, point, cone);
    path.start.kind = RayKind::Reflection;
    path.contribution = contribution;
    return kr * trace(cone, path, seen.depth + 1);
}

bool ConeTracer::refracts(const ShadingPoint& point, const Ray& ray, double& eta,
                          Vec3& direction) const {
    const double air = conventions_.air_index;
    eta = refracts_inward(conventions_, point) ? air / point.material->index
                                               : point.material->index / air;
    if (!refract(ray.direction, point.normal, eta, direction)) return false;
    return !conventions_.correct_interpolated_normals || !(dot(direction, point.geometric) > 0.0) ||
           refract(ray.direction, point.geometric, eta, direction);
}

Rgb ConeTracer::transmitted(const Seen& seen, const ShadingPoint& point) {
    const MaterialSample& material = *point.material;
    const Rgb& kt = point.passing;
    const Rgb contribution = seen.path.contribution * kt;
    if (kt.is_black() || contribution.max() < least_contribution()) return {};
    const double scale = std::sqrt(std::min(seen.piece.share, 1.0));
    const double sign = seen.cone.radius_at(seen.piece.z) < 0.0 ? -1.0 : 1.0;
    ConeRay cone{point.surface.point, seen.ray.direction, seen.radius,
                 sign * scale * seen.cone.spread};
    double eta = 1.0;
    if (!material.thin) {
        if (!refracts(point, seen.ray, eta, cone.axis)) {
            ++counters_.total_internal;
            return {};
        }
        const double cosine = std::max(std::abs(dot(seen.ray.direction, point.normal)), 0.02);
        const double behind = std::max(std::abs(dot(cone.axis, point.normal)), 0.02);
        const RefractedCone beyond =
            refracted_cone(cone.radius, cone.spread, cosine, behind, eta, curvatures(seen, point));
        cone.radius = beyond.radius;
        cone.spread = beyond.spread;
    }
    cone.spread = widened_spread(cone.spread, lobe_half_angle(material.roughness));
    ConePath path = onward(seen, point, cone);
    path.start.kind = RayKind::Refraction;
    path.contribution = contribution;
    const std::uint32_t source = seen.piece.source;
    const std::size_t media = tinted_.mark();
    if (!material.thin) {
        path.inside = point.entering;
        path.absorption = point.entering ? material.absorption : Rgb{};
        const bool closed = scene_.is_closed(point.surface.part);
        path.medium = tinted_medium_behind(point, closed, tinted_, seen.path.medium);
        keep_absorption(point, closed, tinted_, path.medium, path.inside, path.absorption);
    }
    if (geometry_.sources[source].closed) {
        set_inside(path.start, source, seen.piece.front);
    }
    const bool tinted = material.physical || conventions_.refraction_tint ==
                                                 ShadingConventions::RefractionTint::PerEvent;
    const Rgb beyond = trace(cone, path, seen.depth + 1);
    tinted_.release(media);
    return tinted ? kt * beyond : beyond;
}

}  // namespace alhazen

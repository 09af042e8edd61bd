#include "alhazen/renderers/cone_tracing/cone_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "alhazen/primitives/placed_surface.h"
#include "alhazen/renderers/core/refraction.h"
#include "alhazen/renderers/core/rough_lobe.h"
#include "alhazen/renderers/volumes/volume_bounds.h"

namespace alhazen {

namespace {

/// Largest number of shaded pieces per surface, for the cone of a pixel and for secondary cones.
constexpr std::size_t kShadedPieces = 4, kShadedPiecesOnward = 1;
/// The side of a square of the area of a disc of radius 1.
constexpr double kSideOfDisc = 1.7724538509055159;
/// Pieces of a smaller share of the pixel start no secondary cones.
constexpr double kLeastConeShare = 1.0 / 256;

/// Joins a point with faces that are known.
class KnownFaces final : public SurfaceOptics {
  public:
    KnownFaces(TouchingFaces& touching, const OtherFaces& others)
        : touching_(touching), others_(others) {}
    void set_media(const Arrival& arrival, ShadingPoint& point) override {
        touching_.join(others_, arrival, point);
    }

  private:
    TouchingFaces& touching_;
    const OtherFaces& others_;
};

Ray line_of(const ConeRay& cone, const Vec2& at) {
    const Vec3 ex = perpendicular(cone.axis), ey = cross(cone.axis, ex);
    const Vec3 across = at.x * ex + at.y * ey;
    return {cone.origin + cone.radius * across, cone.axis + cone.spread * across};
}

/// Coordinates of a vector in the plane of two others, relative to them.
Vec2 in_edges(const Vec3& v, const Vec3& a, const Vec3& b) {
    const double aa = dot(a, a), bb = dot(b, b), ab = dot(a, b);
    const double det = aa * bb - ab * ab;
    if (!(det > 1e-14 * aa * bb)) return {};
    const double va = dot(v, a), vb = dot(v, b);
    return {(bb * va - ab * vb) / det, (aa * vb - ab * va) / det};
}

/// Radius of a disc with the light's projected area along `direction`; 0 for a point light.
double radius_of(const Light& light, const Vec3& direction) {
    const auto* area = std::get_if<AreaLight>(&light);
    if (area == nullptr) return 0.0;
    return std::sqrt(area->surface->projected_area(direction) * std::numbers::inv_pi);
}

}  // namespace

ConeTracer::ConeTracer(const RenderJob& job, const ConeScene& scene, bool tables,
                       RayCounters& counters)
    : job_(job),
      scene_(job.scene),
      conventions_(job.scene.conventions.shading),
      geometry_(scene),
      counters_(counters),
      ambient_(ambient_terms(job.scene.lights)),
      depth_(job.camera),
      search_(scene, tables),
      touching_(job.scene, tinted_) {}

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
    if (!path.absorption.is_black()) sum = sum * transmittance_to_infinity(path.absorption);
    counters_[path.start.kind].hit += !pieces.empty();
    const SeenPiece* largest = nullptr;
    for (const SeenPiece& s : pieces) {
        if (largest == nullptr || s.weight > largest->weight) largest = &s;
    }
    for (const SeenPiece& s : pieces) {
        Seen seen = seen_at(s.piece, cone, path, depth);
        ShadingPoint point;
        const std::size_t media = tinted_.mark();
        set_point(seen, point, false);
        join_touching(seen, point);
        if (geometry != nullptr && &s == largest) {
            geometry->add_ids(point.surface);
            geometry->add(point, depth_);
        }
        ConePath within = path;
        within.contribution = s.weight * path.contribution;
        within.start.inside = s.inside;
        const Seen weighted{s.piece, cone, within, seen.ray, seen.t, seen.radius, depth};
        if (watcher_ != nullptr) {
            watcher_->begin_piece(s.piece, s.weight, seen.radius, seen.t, point);
        }
        Rgb color = color_of(weighted, point);
        tinted_.release(media);
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
    ConeSurfaces<double> surfaces;
    left = 1.0;
    int count = 0;
    ConeStart here = path.start;
    search_.begin(cone, path.start);
    ConePiece piece;
    while (search_.next(piece)) {
        const ConeSource& source = geometry_.sources[piece.source];
        SurfaceShare part = share_of(piece, path.start);
        if (source.may_pass) {
            ShadingPoint point;
            set_point(seen_at(piece, cone, path, depth), point, false);
            const MaterialSample& material = *point.material;
            const bool unseen = !point.entering && material.single_sided;
            if (unseen && material.coverage == 0.0) {
                if (part.two_sided) here.set_inside(piece.source, piece.front);
                continue;
            }
            // Without alpha only the front of a single-sided solid is seen past its back.
            if (piece.far_side && !source.has_alpha && !is_unseen_from_behind(material)) continue;
            part.coverage = material.coverage;
        }
        if (++count > kMostPieces) return false;
        std::size_t layer = 0;
        const double weight = surfaces.add(part, 0.0, layer);
        if (weight > 0.0) pieces.push_back({piece, weight, layer, here.inside});
        // What is seen past a wall of a solid with alpha lies on its other side.
        if (part.two_sided) here.set_inside(piece.source, piece.front);
        if (!(weight > 0.0)) continue;
        left = surfaces.left();
        if (!(left >= kLeastTransmittance)) break;
    }
    thin_out(pieces, depth == 0 ? kShadedPieces : kShadedPiecesOnward);
    return true;
}

SurfaceShare ConeTracer::share_of(const ConePiece& piece, const ConeStart& start) const {
    const ConeSource& source = geometry_.sources[piece.source];
    return {source.surface, piece.front, source.closed && source.has_alpha,
            start.is_inside(piece.source), piece.share};
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

void ConeTracer::set_point(const Seen& seen, ShadingPoint& point, bool meets_backs,
                           SurfaceOptics* optics) const {
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
    complete_shading_point(scene_, seen.ray,
                           {.inside = seen.path.inside,
                            .width = kSideOfDisc * seen.radius,
                            .meets_backs = meets_backs,
                            .medium = seen.path.medium,
                            .mask = mask_of(seen.path.start.kind)},
                           {.optics = optics}, point);
}

std::optional<ConePiece> ConeTracer::piece_at(const Seen& seen, std::uint32_t source,
                                              const Ray& to_wall) const {
    const ConeSource& other = geometry_.sources[source];
    if (source == seen.piece.source) return std::nullopt;
    if ((other.visible_to & mask_of(seen.path.start.kind)) == 0) return std::nullopt;
    const ConeWall wall = wall_ahead(geometry_, source, ConeStart::kNone, to_wall);
    if (!std::isfinite(wall.t)) return std::nullopt;
    ConePiece piece = seen.piece;
    piece.source = source;
    piece.part = wall.part;
    piece.u = wall.u;
    piece.v = wall.v;
    return piece;
}

void ConeTracer::join_touching(const Seen& seen, ShadingPoint& point) {
    const bool bounds =
        may_bound_volume(scene_.material_of(point.surface)) && !point.material->thin;
    const ConeSource& own = geometry_.sources[seen.piece.source];
    if (!bounds || !own.closed) return;
    if (own.kind != ConeSource::Kind::Plane &&
        LeavingRays::margin(point.surface) < geometry_.solids[own.solid].apart) {
        return;
    }
    const Vec3& along = seen.ray.direction;
    const Vec3 before = leaving_ray(point.surface, -along).origin;
    const Vec3 behind = leaving_ray(point.surface, along).origin;
    const SolidsAround left = solids_around(geometry_, before);
    const SolidsAround entered = solids_around(geometry_, behind);
    const auto is_in = [](std::uint32_t source, const SolidsAround& solids) {
        return std::find(solids.begin(), solids.end(), source) != solids.end();
    };
    OtherFaces others;
    ShadingPoint at;
    /// Adds the face at a piece. True if it is opaque.
    const auto add = [&](const ConePiece& piece, bool entering, bool around) {
        set_point({piece, seen.cone, seen.path, seen.ray, seen.t, seen.radius, seen.depth}, at,
                  false);
        const Material& material = scene_.material_of(at.surface);
        if (at.material->coverage < 1.0 || at.material->thin) return false;
        if (material.is_opaque()) return true;
        if (!may_bound_volume(material)) return false;
        others.push_back({.inside = volume_of(scene_, at),
                          .entering = entering,
                          .around = around,
                          .physical = at.material->physical,
                          .kt = at.material->transmissive});
        return false;
    };
    // From within a solid its wall is ahead. Larger ones are taken for those around smaller ones.
    bool around = is_in(seen.piece.source, entered);
    for (std::size_t k = entered.size(); k-- > 0;) {
        around = around && entered[k] != seen.piece.source;
        if (is_in(entered[k], left)) continue;
        const std::optional<ConePiece> piece = piece_at(seen, entered[k], {behind, -along});
        if (piece && add(*piece, true, around)) {
            return set_point(
                {*piece, seen.cone, seen.path, seen.ray, seen.t, seen.radius, seen.depth}, point,
                false);
        }
    }
    for (const std::uint32_t source : left) {
        if (is_in(source, entered)) continue;
        const std::optional<ConePiece> piece = piece_at(seen, source, {before, along});
        if (piece) (void)add(*piece, false, false);
    }
    if (others.empty()) return;
    KnownFaces known(touching_, others);
    set_point(seen, point, false, &known);
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

double ConeTracer::least_contribution() const {
    return std::max(conventions_.min_contribution, kLeastConeShare);
}

RayMedium ConeTracer::medium_along(const Seen& seen, const ShadingPoint& point,
                                   const Vec3& direction) {
    if (!goes_behind(point, direction) || !bounds_media(point)) return seen.path;
    return medium_behind(point, scene_.is_closed(point.surface.part), &tinted_, seen.path);
}

ConePath ConeTracer::onward(const Seen& seen, const ShadingPoint& point, const ConeRay& cone) {
    ConePath path;
    path.start.source = seen.piece.source;
    path.start.part = seen.piece.part;
    path.start.inside = seen.path.start.inside;
    static_cast<RayMedium&>(path) = medium_along(seen, point, cone.axis);
    // The disc at the start is oblique to the surface: its lower half lies below.
    const double cosine = std::max(std::abs(dot(cone.axis, point.geometric)), 0.05);
    const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
    path.start.clear = cone.radius * (sine / cosine + 0.05);
    const double side = dot(cone.axis, point.geometric) < 0.0 ? -1.0 : 1.0;
    path.start.plane = ConePlane{point.surface.point, side * point.geometric};
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
    // Where a cone may pass the front of a solid it reaches the back from inside.
    const ConeSource& source = geometry_.sources[seen.piece.source];
    const bool behind = goes_behind(point, direction);
    if (source.closed && (source.has_alpha || (behind && bounds_media(point)))) {
        path.start.set_inside(seen.piece.source, seen.piece.front == behind);
    }
    return kr * trace(cone, path, seen.depth + 1);
}

bool ConeTracer::refracts(const ShadingPoint& point, const Ray& ray, double& eta,
                          Vec3& direction) const {
    const double air = conventions_.air_index;
    eta = point.behind.known                     ? point.behind.eta
          : refracts_inward(conventions_, point) ? air / point.material->index
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
    const std::size_t media = tinted_.mark();
    ConePath path = onward(seen, point, cone);
    path.start.kind = RayKind::Refraction;
    path.contribution = contribution;
    const std::uint32_t source = seen.piece.source;
    if (point.behind.joined) {
        path.start.inside = solids_around(geometry_, leaving_ray(point.surface, cone.axis).origin);
    } else if (geometry_.sources[source].closed) {
        path.start.set_inside(source, seen.piece.front == goes_behind(point, cone.axis));
    }
    const bool tinted = material.physical || conventions_.refraction_tint ==
                                                 ShadingConventions::RefractionTint::PerEvent;
    const Rgb beyond = trace(cone, path, seen.depth + 1);
    tinted_.release(media);
    return tinted ? kt * beyond : beyond;
}

}  // namespace alhazen

#pragma once
/// Local shading: the terms of the shading equation that need only shadow rays.
///
/// Source: UW CSE 457, "Ray Tracing" lecture and Trace project: I = ke + sum_j [ ka ILa_j + Ashadow
/// Adist IL_j Bj (kd (N.L) + ks (N.H)^ns) ]; Whitted 1980; Phong 1975; Blinn 1977.
/// Differs: variants of the formats are read from ShadingConventions.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "alhazen/base/inline_vector.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/renderers/core/material_cache.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

/// The medium behind a surface; known for solids of several media and with ExactOptics.
struct BehindSurface {
    bool known = false;
    bool inside = false;  ///< there is a medium, not air
    double eta = 1;       ///< index on this side / index behind
    Rgb absorption;
    std::uint32_t medium = 0;  ///< of ExactOptics, if used; where `joined`, else of TintedMedia
    bool joined = false;       ///< faces of several parts are crossed at once
    Rgb kt{1, 1, 1};           ///< of a unit of length
};

/// The ray that leaves `surface`, of unit `direction`, by the conventions of the scene.
[[nodiscard]] inline Ray onward_ray(const ShadingConventions& conventions,
                                    const LeavingRays& surface, const Vec3& direction,
                                    double t_max = std::numeric_limits<double>::infinity()) {
    Ray ray = surface.along(direction, t_max);
    ray.t_min = std::min(std::max(ray.t_min, conventions.min_distance), t_max);
    return ray;
}

/// The highlight of a thin sheet at the place of another surface.
struct SheetHighlight {
    Rgb specular;
    double shininess = 0;
    bool by_cosine = false;  ///< times N.L
};

/// A hit ready for shading; directions are on the side from which the ray came.
struct ShadingPoint {
    ShadingPoint() = default;
    ShadingPoint(const ShadingPoint&) = delete;  // `material` may point into it
    ShadingPoint& operator=(const ShadingPoint&) = delete;
    /// Returns the point's own sample for modification; copies a shared one first.
    [[nodiscard]] MaterialSample& own_material() {
        if (material != &own) {
            own = *material;
            material = &own;
        }
        return own;
    }

    Surface surface;
    const MaterialSample* material = &own;  ///< `own`, or a shared sample
    MaterialSample own;
    RayMask seen_by = kAllRays;  ///< the part; unknown to `complete_shading_point`
    bool inside = false;         ///< the ray ran inside a transparent solid
    bool entering = true;        ///< the ray hit the outside (by the geometric normal)
    BehindSurface behind;
    Rgb passing;          ///< kt of the surface; at a wall, of both media
    Rgb sheets{1, 1, 1};  ///< of `passing`, the share of thin sheets at the place of a boundary
    InlineVector<SheetHighlight, 3> highlights;  ///< of those, beside that of the material
    /// kt of the medium that a solid of several media states on this side; else of the surface.
    Rgb medium;
    bool medium_is_physical = false;  ///< it has an absorption; kt is not applied by distance
    Vec3 geometric;                   ///< unit geometric normal towards the ray's origin
    Vec3 normal;                      ///< unit shading normal, turned towards the ray's origin
    Vec3 view;                        ///< unit, towards the ray's origin
    double way = 0;                   ///< from the start of the ray
    bool has_map = false;             ///< `normal` is that of a normal map
    Vec3 mapped;                      ///< with one: its unit normal, as the surface has it
    bool coat_is_tilted = false;      ///< a clear coat has another normal than `normal`
    Vec3 coat_mapped;                 ///< then: its unit normal, as the surface has it
};

/// Evaluates the material at the surface. `footprint`: that of the ray's cone in both sets of
/// texture coordinates.
[[nodiscard]] MaterialSample material_at(const Scene& scene, const Surface& surface,
                                         const std::array<UvFootprint, 2>& footprint = {},
                                         const SolidAperture& aperture = {});

/// The directions of u and v in a surface, of any lengths; zero where undefined.
struct SurfaceDirections {
    Vec3 u, v;
};
/// The derivatives of the point by the coordinates with which `picture` is read: those of its set,
/// after its transform.
[[nodiscard]] SurfaceDirections directions_of(const Surface& surface, const ImageTexture& picture);
/// The directions from which the grooves of the material (the first of blended ones) count: the
/// tangents of the mesh; without them those of the normal map, without a map those of set 0.
///
/// Source: glTF 2.0, tangents of meshes without them; KhronosGroup/glTF-Sample-Viewer,
/// getNormalInfo, which leaves the set of the anisotropy texture out.
[[nodiscard]] SurfaceDirections groove_directions(const Scene& scene, const Surface& surface);

/// The normal that a viewer in the unit direction `view` sees: `mapped` of a point whose
/// interpolated normal is `shading`, on the viewer's side; rotated to face the viewer where it does
/// not.
[[nodiscard]] Vec3 mapped_normal_seen(const Vec3& mapped, const Vec3& shading, const Vec3& view);

/// The semi-axes of the ellipse that a cone of cross-section `width`^2 around `direction` cuts out
/// of the surface.
[[nodiscard]] SolidAperture aperture_at(const Surface& surface, const Vec3& direction,
                                        double width);

/// The medium on one side of the surface (`surface.media`), with textures evaluated at the surface.
[[nodiscard]] MaterialSample medium_at(const Scene& scene, const Surface& surface, MaterialId id);

/// The footprint of a cone of diameter `width` around `direction` on the surface, in both sets of
/// texture coordinates.
[[nodiscard]] std::array<UvFootprint, 2> footprint_at(const Surface& surface, const Vec3& direction,
                                                      double width);

/// The state of a ray at a surface.
struct Arrival {
    /// True if the ray runs inside a solid, by the history of the ray, not by the normal: an open
    /// surface has a back but no inside.
    bool inside = false;
    double width = 0;  ///< of the ray's cone at the hit
    float time = 0;    ///< RayQuery::time
    /// True if the ray hits the backs of single-sided surfaces: in light transport, all but eye
    /// rays.
    bool meets_backs = false;
    std::uint32_t medium = 0;  ///< of the ray; read by PointNeeds::optics
    RayMask mask = kAllRays;   ///< parts that the ray sees; read by PointNeeds::optics
};

/// Optics of surfaces, in place of the coefficients kr and kt of the equation.
class SurfaceOptics {
  public:
    /// Completes a point: its reflection, its transmission and the medium behind it. May replace
    /// the surface by another at the same place.
    virtual void set_media(const Arrival& arrival, ShadingPoint& point) = 0;

  protected:
    SurfaceOptics() = default;
    SurfaceOptics(const SurfaceOptics&) = default;
    SurfaceOptics& operator=(const SurfaceOptics&) = default;
    ~SurfaceOptics() = default;
};

/// Completes a point without other optics: sets the media before and behind the surface and the
/// material as seen from there.
void set_media_of_material(const Scene& scene, ShadingPoint& point);

/// Parts of a shading point that the caller needs.
struct PointNeeds {
    CoordinateNeed coordinates = CoordinateNeed::all();
    MaterialCache* constant = nullptr;  ///< shared samples; may be null
    SurfaceOptics* optics = nullptr;    ///< null: coefficients kr and kt of the equation
};

/// Sets all of `point`. `ray.direction` must be unit. The material is evaluated for this ray:
/// textures filtered, Fresnel reflectance at its angle, coverage 0 on the back of a single-sided
/// surface.
void set_shading_point(const Scene& scene, const Ray& ray, const Hit& hit, const Arrival& arrival,
                       const PointNeeds& needs, ShadingPoint& point);

/// True if the ray hit the back of a single-sided surface (Arrival::meets_backs).
[[nodiscard]] inline bool is_hit_from_behind(const ShadingPoint& point) {
    return !point.entering && is_unseen_from_behind(*point.material);
}

/// True if a refracted ray goes from air into the body: by the side of the geometric normal, or of
/// the interpolated one if that is not corrected (ShadingConventions).
[[nodiscard]] inline bool refracts_inward(const ShadingConventions& conventions,
                                          const ShadingPoint& point) {
    if (conventions.correct_interpolated_normals) return point.entering;
    return dot(point.view, point.surface.shading_normal) > 0.0;
}

/// As `set_shading_point` with `point.surface` already set, for renderers that find surfaces
/// without rays.
void complete_shading_point(const Scene& scene, const Ray& ray, const Arrival& arrival,
                            const PointNeeds& needs, ShadingPoint& point);

/// The surface that a ray sees.
struct VisibleHit {
    Hit hit;
    ShadingPoint point;
    double t = 0;  ///< from the origin of the ray; `hit.t` counts from the last surface passed
};

/// Finds the first surface along an eye ray with a coverage above 0. At most kMaxPassedSurfaces
/// surfaces of coverage 0 are passed.
[[nodiscard]] bool first_visible_hit(const Scene& scene, const Ray& ray, const RayCone& cone,
                                     bool inside, TraversalStats* stats, VisibleHit& found);
inline constexpr int kMaxPassedSurfaces = 4096;

/// Rays end behind partly covering surfaces when their transmittance is below this.
inline constexpr double kLeastTransmittance = 1.0 / 4096;

/// [light] Ambient terms for `unshadowed_terms`; independent of the point.
[[nodiscard]] std::vector<Rgb> ambient_terms(std::span<const Light> lights);

/// Emission and the ambient terms of all lights.
[[nodiscard]] Rgb unshadowed_terms(const ShadingConventions& conventions,
                                   std::span<const Rgb> ambient, const ShadingPoint& point);

/// `matt`, kd (N.L), and ks highlight, if its cosine is positive.
[[nodiscard]] Rgb with_highlight(const ShadingConventions& conventions, const MaterialSample& m,
                                 double highlight_cosine, double cosine, const Rgb& matt);

/// kd (N.L) + ks highlight for a light as seen from the point, with N.L = `cosine` > 0.
[[nodiscard]] Rgb reflected_fraction(const ShadingConventions& conventions,
                                     const ShadingPoint& point, const LightSample& light,
                                     double cosine);

/// Emission, the ambient terms and the unoccluded light of all lights.
[[nodiscard]] Rgb unhindered_light(const Scene& scene, std::span<const Rgb> ambient,
                                   const ShadingPoint& point);

}  // namespace alhazen

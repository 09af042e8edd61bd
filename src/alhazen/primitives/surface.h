#pragma once
/// The surface at the nearest hit: computed once per ray.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray.h"
#include "alhazen/primitives/aggregate.h"
#include "alhazen/shading/materials/material.h"
#include "alhazen/shapes/core/shape.h"

namespace alhazen {

/// The media on both sides of a surface along its ray, for CSG of several media; the outside has no
/// material.
struct SurfaceMedia {
    bool known = false;
    std::optional<MaterialId> before, after;
    std::uint64_t solid = 0;  ///< identifies the placed solid

    /// Changes `solid` for one within the instance of that part.
    void place_in(std::uint32_t part) { solid = solid * 0x9E3779B97F4A7C15u + part; }
};

/// A surface point in world space. `normal` is the geometric normal, outward for closed shapes;
/// both normals are unit; `error` bounds the distance of `point` from the true surface,
/// componentwise.
struct Surface : ShapeSurface {
    Vec2 uv2;           ///< second set of texture coordinates; `uv` if there is none
    Vec3 dpdu2, dpdv2;  ///< derivatives of the point by uv2
    /// Interpolated from the vertices' tangents; unit before interpolation and placement; both zero
    /// for surfaces without tangents.
    Vec3 tangent, bitangent;
    Rgba color{1, 1, 1, 1};   ///< vertex colour; white if there is none
    bool is_of_mesh = false;  ///< false: `uv2` equals `uv`
    /// True if colour, tangents, weights, media or volume differ from the defaults. Most surfaces
    /// have no extras and are computed faster.
    bool has_extras = false;
    /// One material, or those of a triangle's vertices with their weights.
    std::array<MaterialId, 3> materials{};
    std::array<double, 3> weights{1, 0, 0};
    int material_count = 1;
    SurfaceMedia media;
    /// The material of the volume that the surface bounds, if it is not the surface's own: a wall
    /// that a subtracted part of another material cuts into a solid.
    std::optional<MaterialId> volume;
    /// Number of the hit part: parts are numbered through the objects of the description, in order.
    std::uint32_t part = 0;
    /// Number of the part that placed it in the scene: the outermost instance, or `part` itself.
    std::uint32_t instance = 0;
};

/// The material of the volume that the surface bounds.
[[nodiscard]] inline MaterialId volume_material(const Surface& surface) {
    return surface.volume ? *surface.volume : surface.materials[0];
}

/// Selects the surfaces whose texture coordinates and derivatives are computed, the most expensive
/// members for shapes. For other surfaces they are undefined.
class CoordinateNeed {
  public:
    [[nodiscard]] static CoordinateNeed all() { return {true, {}}; }
    [[nodiscard]] static CoordinateNeed none() { return {false, {}}; }
    /// Only surfaces of materials that read them; `reads`: [material], must outlive the object.
    [[nodiscard]] static CoordinateNeed of(std::span<const std::uint8_t> reads) {
        return {!reads.empty(), reads};
    }

    [[nodiscard]] bool of_any() const { return any_; }
    [[nodiscard]] bool of_material(MaterialId id) const {
        return any_ && (reads_.empty() || reads_[static_cast<std::size_t>(id)] != 0);
    }

  private:
    CoordinateNeed(bool any, std::span<const std::uint8_t> reads) : any_(any), reads_(reads) {}

    bool any_;
    std::span<const std::uint8_t> reads_;
};

/// The surface at `hit`, which the world-space `ray` found in `aggregate` at `time`
/// (RayQuery::time).
[[nodiscard]] Surface surface_at(const Aggregate& aggregate, const Ray& ray, const Hit& hit,
                                 float time = 0.0f);
/// Writes into `surface`, as the type is large, only the texture coordinates that `need` selects.
void set_surface(const Aggregate& aggregate, const Ray& ray, const Hit& hit,
                 const CoordinateNeed& need, Surface& surface, float time = 0.0f);

/// Surface::part and Surface::instance of a hit, without its surface.
struct HitParts {
    std::uint32_t part = 0, instance = 0;
    friend bool operator==(const HitParts&, const HitParts&) = default;
};
[[nodiscard]] HitParts parts_of(const Aggregate& aggregate, const Hit& hit);

/// The bits that the masks of the primitive hit and of all instances around it share.
[[nodiscard]] RayMask mask_at(const Aggregate& aggregate, const Hit& hit);

/// The material of the surface at a hit, if the primitive alone determines it: without vertex
/// colours, and without an enclosing solid that shows another material.
[[nodiscard]] std::optional<MaterialId> plain_material(const Aggregate& aggregate, const Hit& hit);

/// The ray that leaves the surface along `direction`, up to `t_max`. It starts outside the error
/// bound of the point, on the side the direction points to, and excludes t = 0, so that it does not
/// hit the surface again, nor others that are placed there.
///
/// Source: Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th ed., section 6.8.6.
/// Differs: the margin is 32 times the bound, which contains the rounding of the next intersection
/// test, and no less than 3 times the bound along any axis (docs/design/secondary_rays.md).
[[nodiscard]] Ray leaving_ray(const ShapeSurface& surface, const Vec3& direction,
                              double t_max = std::numeric_limits<double>::infinity());

/// `leaving_ray` for many rays of one surface.
class LeavingRays {
  public:
    /// The margin, relative to the bound along the normal.
    static constexpr double kErrorsAway = 32.0;
    /// The least bound along the normal, relative to the largest one along an axis. The turned
    /// faces of other parts at the same place round relative to all coordinates, also where those
    /// along the normal are 0.
    static constexpr double kLeastPart = 0x1.8p-4;
    /// The first t: positive, and far enough from the subnormal numbers to keep arithmetic fast.
    static constexpr double kBeyondZero = 0x1p-500;

    /// The distance of the starts from the point, along the normal.
    [[nodiscard]] static double margin(const ShapeSurface& surface) {
        const Vec3& e = surface.error;
        const double least = kLeastPart * std::max(std::max(e.x, e.y), e.z);
        return kErrorsAway * std::max(dot(abs(surface.normal), e), least);
    }
    // Implicit, so that a surface may be passed.
    LeavingRays(const ShapeSurface& surface) : normal_(surface.normal) {
        const double margin = LeavingRays::margin(surface);
        // The sums round by half an ulp, far less than the margin.
        outside_ = surface.point + margin * surface.normal;
        inside_ = surface.point + (-margin) * surface.normal;
    }
    [[nodiscard]] Ray along(const Vec3& direction,
                            double t_max = std::numeric_limits<double>::infinity()) const {
        return {dot(direction, normal_) >= 0.0 ? outside_ : inside_, direction, kBeyondZero, t_max};
    }

  private:
    Vec3 normal_, outside_, inside_;
};

}  // namespace alhazen

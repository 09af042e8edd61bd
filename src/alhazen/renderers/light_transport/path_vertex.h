#pragma once
/// Vertices of subpaths: points on surfaces or inside volumes.
///
/// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, chapters 8 and
/// 10; Pauly, Kollig and Keller, "Metropolis Light Transport for Participating Media", EGWR 2000.
/// Conventions: densities are by area on surfaces and by volume in volumes. In a volume there is no
/// cosine, the phase function replaces the BSDF, and the throughput includes the scattered share.

#include <cmath>

#include "alhazen/base/unmade.h"
#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/light_transport/free_flight.h"
#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/renderers/light_transport/volume_scattering.h"

namespace alhazen {

struct InsideVolume {
    Vec3 along;             ///< unit, direction of arrival of the path
    double anisotropy = 0;  ///< of the volume
    Spectrum extinction;    ///< of the volume, at the initial wavelengths of the path
};

/// A point where a subpath scatters, or where it ends at a light.
struct PathVertex {
    /// Not defaulted: that would zero the large object first.
    PathVertex() {}  // NOLINT(modernize-use-equals-default)

    Unmade<ShapeSurface> surface;  ///< in a volume only its point is set
    ScatterPoint scatter;          ///< on a surface
    bool in_volume = false;
    Unmade<InsideVolume> volume;  ///< in a volume
    Spectrum throughput;          ///< of the path up to the vertex
    bool hero_only = false;  ///< `throughput` is of the hero, and stands for all four wavelengths
    double density = 0;      ///< with which its own subpath samples it
    double reverse = 0;      ///< with which the other subpath would; needs two more vertices
    double back = 0;         ///< by solid angle, towards the vertex before; needs one more vertex
    double forward = 1;      ///< share of walks from the vertex before that reach it and stop
    double backward = 1;     ///< share of walks from it that reach the vertex before and stop
    RayMask seen_by = kAllRays;      ///< rays that see its surface, 0: no strategy connects it; set
                                     ///< by paths from lights
    bool singular = false;           ///< the path continued by a singular lobe
    MediumStack media;               ///< in front of it
    Spectrum emission;               ///< emitted towards the path
    Illumination::EmitDensity emit;  ///< for `emission`
    double joined = 0;               ///< density of drawing it as light for the vertex before
    double distance = 0;             ///< from the vertex before
    double coverage = 1;             ///< probability with which the path stopped at it

    [[nodiscard]] const Vec3& point() const { return surface.value.point; }
    /// The unit direction to the vertex before.
    [[nodiscard]] Vec3 view() const { return in_volume ? -volume.value.along : scatter.view(); }
    [[nodiscard]] LitPoint lit() const {
        if (in_volume) return LitPoint::inside_volume(point());
        return {point(), scatter.normal(), scatter.is_lit_from_both_sides()};
    }
    [[nodiscard]] bool connects() const { return in_volume || scatter.has_density(); }
    /// Factor from a density by area perpendicular to `direction` to one at the vertex: |cosine|.
    [[nodiscard]] double facing(const Vec3& direction) const {
        return in_volume ? 1.0 : std::abs(dot(direction, scatter.geometric()));
    }
    /// For light from `direction`: BSDF * |cosine|, or the phase function.
    [[nodiscard]] Spectrum value(const Vec3& direction, Transport transport) const {
        return in_volume ? Spectrum::all(phase(direction)) : scatter.value(direction, transport);
    }
    /// Density of continuing along `direction`, and of continuing to the view from there.
    [[nodiscard]] double density_along(const Vec3& direction) const {
        return in_volume ? phase(direction) : scatter.density(direction);
    }
    [[nodiscard]] double density_back(const Vec3& direction) const {
        return in_volume ? phase(direction) : scatter.reverse_density(direction);
    }
    [[nodiscard]] double importance_correction(const Vec3& direction) const {
        return in_volume ? 1.0 : scatter.importance_correction(direction);
    }
    /// True if eye rays from `direction` see it.
    [[nodiscard]] bool is_seen_from(const Vec3& direction) const {
        if ((seen_by & mask_of(RayKind::Eye)) == 0) return false;
        return in_volume || scatter.is_seen_from(direction);
    }
    /// The kind of a ray of the path that leaves it along `direction`.
    [[nodiscard]] RayKind kind_along(const Vec3& direction) const {
        return in_volume || dot(direction, scatter.geometric()) < 0.0 ? RayKind::Refraction
                                                                      : RayKind::Reflection;
    }
    /// Probability that a walk along `way` reaches the vertex; in a volume the density by length of
    /// stopping there.
    [[nodiscard]] double reached(const FreeFlight& way) const {
        return in_volume ? way.stopping(volume.value.extinction) : way.passing();
    }
    [[nodiscard]] Ray leaving(const Vec3& direction, double t_max) const {
        return in_volume ? Ray{point(), direction, 0.0, t_max}
                         : leaving_ray(surface.value, direction, t_max);
    }
    /// The volumes around a ray that leaves the vertex along `direction`; `behind` is storage.
    [[nodiscard]] const MediumStack& media_along(const Vec3& direction, MediumStack& behind) const {
        if (in_volume || !(dot(direction, scatter.geometric()) < 0.0)) return media;
        behind = media;
        scatter.cross(behind);
        return behind;
    }

  private:
    [[nodiscard]] double phase(const Vec3& direction) const {
        return henyey_greenstein(dot(volume.value.along, direction), volume.value.anisotropy);
    }
};

}  // namespace alhazen

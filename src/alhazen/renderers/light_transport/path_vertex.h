#pragma once
/// Where a subpath scatters: a point of a surface, or one inside of a volume.
///
/// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, chapters 8 and
/// 10; Pauly, Kollig and Keller, "Metropolis Light Transport for Participating Media", EGWR 2000.
/// Conventions: densities are by area on surfaces, by volume in volumes; there is no cosine in a
/// volume, the phase function takes the place of the BSDF, and the throughput has the share that is
/// scattered.

#include <cmath>

#include "alhazen/base/unmade.h"
#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/light_transport/free_flight.h"
#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/renderers/light_transport/volume_scattering.h"

namespace alhazen {

struct InsideVolume {
    Vec3 along;             ///< unit, in which the path came
    double anisotropy = 0;  ///< of the volume
    Spectrum extinction;    ///< of it, at the wavelengths with which the path began
};

/// A point where a subpath scatters, or where it ends at a light.
struct PathVertex {
    /// Not defaulted: all of it, which is large, would be zeroed first.
    PathVertex() {}  // NOLINT(modernize-use-equals-default)

    Unmade<ShapeSurface> surface;  ///< in a volume the point alone
    ScatterPoint scatter;          ///< of a surface
    bool in_volume = false;
    Unmade<InsideVolume> volume;  ///< there alone
    Spectrum throughput;          ///< of the path up to the vertex
    bool hero_only = false;  ///< `throughput` is of the hero, and stands for all four wavelengths
    double density = 0;      ///< with which its own side finds it
    double reverse = 0;      ///< with which the other side would, once it has two more vertices
    double back = 0;         ///< by solid angle, of what it was found from, once it has one more
    double forward = 1;      ///< share of walks from the vertex before that come here and stop
    double backward = 1;     ///< of walks from here that come to that before and stop
    bool singular = false;   ///< the path went on from it by a singular lobe
    MediumStack media;       ///< in front of it
    Spectrum emission;       ///< of it towards the path
    Illumination::EmitDensity emit;  ///< of that light
    double joined = 0;               ///< density with which it is drawn for the vertex before
    double distance = 0;             ///< from the vertex before
    double coverage = 1;             ///< with which the path stopped there

    [[nodiscard]] const Vec3& point() const { return surface.value.point; }
    /// Unit, to where the path came from.
    [[nodiscard]] Vec3 view() const { return in_volume ? -volume.value.along : scatter.view(); }
    [[nodiscard]] LitPoint lit() const {
        if (in_volume) return LitPoint::inside_volume(point());
        return {point(), scatter.normal(), scatter.transmits()};
    }
    [[nodiscard]] bool connects() const { return in_volume || scatter.has_density(); }
    /// |cosine| that makes a density across `direction` one of the vertex.
    [[nodiscard]] double facing(const Vec3& direction) const {
        return in_volume ? 1.0 : std::abs(dot(direction, scatter.geometric()));
    }
    /// For light from `direction`: value * |cosine|, or the phase function.
    [[nodiscard]] Spectrum value(const Vec3& direction, Transport transport) const {
        return in_volume ? Spectrum::all(phase(direction)) : scatter.value(direction, transport);
    }
    /// With which the path goes on along `direction`, and with which one from there goes back.
    [[nodiscard]] double density_along(const Vec3& direction) const {
        return in_volume ? phase(direction) : scatter.density(direction);
    }
    [[nodiscard]] double density_back(const Vec3& direction) const {
        return in_volume ? phase(direction) : scatter.reverse_density(direction);
    }
    [[nodiscard]] double importance_correction(const Vec3& direction) const {
        return in_volume ? 1.0 : scatter.importance_correction(direction);
    }
    [[nodiscard]] bool is_seen_from(const Vec3& direction) const {
        return in_volume || scatter.is_seen_from(direction);
    }
    /// Share of walks along a way to the vertex that stop there, in a volume by length.
    [[nodiscard]] double reached(const FreeFlight& way) const {
        return in_volume ? way.stopping(volume.value.extinction) : way.passing();
    }
    [[nodiscard]] Ray leaving(const Vec3& direction, double t_max) const {
        return in_volume ? Ray{point(), direction, 0.0, t_max}
                         : leaving_ray(surface.value, direction, t_max);
    }
    /// The volumes around a ray that leaves it along `direction`; `behind` has room for them.
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

#pragma once
/// A record of one path of a picture.
///
/// Conventions: colours are linear contributions to the pixel: weights and densities are applied.
/// The sum of `found` and `arrived` over the vertices is `radiance`, within rounding. Recording
/// changes no pixel.

#include <cstdint>
#include <limits>
#include <vector>

#include "alhazen/geometry/ray.h"
#include "alhazen/geometry/ray_mask.h"
#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// How a path continued from a vertex, or why it ended there.
enum class PathStep : std::uint8_t {
    Scattered,   ///< scattered into a direction drawn by a density
    Mirrored,    ///< scattered into the singular direction of a mirror or of smooth glass
    Straight,    ///< passed a thin sheet, an uncovered surface or a null boundary
    Escaped,     ///< ended: no surface was hit
    Deepest,     ///< ended: largest number of scatterings
    Absorbed,    ///< ended: no light is scattered
    Roulette,    ///< ended: Russian roulette
    PassedMost,  ///< ended: kMaxPassedSurfaces surfaces passed straight
};
inline constexpr const char* kPathStepNames[] = {"scattered", "mirrored",   "straight",
                                                 "escaped",   "deepest",    "absorbed",
                                                 "roulette",  "passed_most"};

/// A ray of the path and its end.
struct RecordedVertex {
    RayKind kind = RayKind::Eye;
    Ray ray;
    double t = std::numeric_limits<double>::infinity();  ///< of the end; infinite: escaped
    Rgb throughput;                                      ///< of the path where the ray begins
    bool in_volume = false;      ///< the path was scattered in a volume at `t`
    bool has_surface = false;    ///< a surface was hit: at `t`, or behind it if `in_volume`
    Vec3 normal;                 ///< shading normal of the surface, unit
    std::uint32_t part = 0;      ///< Surface::part
    std::uint32_t material = 0;  ///< of the surface
    Rgb found;                   ///< emission and environment light that the ray hit
    bool asked_light = false;    ///< a shadow ray was sent
    Ray shadow;                  ///< towards the light, which is at its t_max
    Rgb offered, arrived;        ///< light along `shadow`, before and after occlusion
    PathStep step = PathStep::Absorbed;
};

struct PathRecord {
    std::uint32_t sample = 0;  ///< number of the sample to record; the crop must be one pixel
    std::vector<RecordedVertex> vertices;
    Rgb radiance;
};

}  // namespace alhazen

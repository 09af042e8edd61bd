#pragma once
/// One path of a picture as its renderer followed it, for explanations.
///
/// Conventions: colours are linear and in the pixel: weights and densities are applied. The sum of
/// `found` and `arrived` over the vertices is `radiance`, within rounding. Recording changes no
/// pixel.

#include <cstdint>
#include <limits>
#include <vector>

#include "alhazen/geometry/ray.h"
#include "alhazen/geometry/ray_mask.h"
#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// How a path went on from a vertex, or why not.
enum class PathStep : std::uint8_t {
    Scattered,   ///< into all directions, by a density
    Mirrored,    ///< into the one direction of a mirror or of smooth glass
    Straight,    ///< through a thin sheet, a surface that is not there, or a volume
    Escaped,     ///< it met nothing
    Deepest,     ///< no more scatterings are asked for
    Absorbed,    ///< no light goes on
    Roulette,    ///< ended by chance, for it carried little
    PassedMost,  ///< it passed straight through kMaxPassedSurfaces surfaces
};
inline constexpr const char* kPathStepNames[] = {"scattered", "mirrored",   "straight",
                                                 "escaped",   "deepest",    "absorbed",
                                                 "roulette",  "passed_most"};

/// A ray of the path, and what happened where it ended.
struct RecordedVertex {
    RayKind kind = RayKind::Eye;
    Ray ray;
    double t = std::numeric_limits<double>::infinity();  ///< of the end; infinite: it has none
    Rgb throughput;                                      ///< of the path where the ray begins
    bool in_volume = false;      ///< it was scattered at `t`, before any surface
    bool has_surface = false;    ///< at `t`, or farther where it was scattered in a volume
    Vec3 normal;                 ///< of the surface, towards the ray
    std::uint32_t part = 0;      ///< Surface::part
    std::uint32_t material = 0;  ///< of the surface
    Rgb found;                   ///< light that the ray came upon: emission, the environment
    bool asked_light = false;    ///< a shadow ray was sent
    Ray shadow;                  ///< to the light, which is at its t_max
    Rgb offered, arrived;        ///< light on this way, if nothing blocks it; and what came
    PathStep step = PathStep::Absorbed;
};

struct PathRecord {
    std::uint32_t sample = 0;  ///< which to record; of all pixels of the crop, so of one
    std::vector<RecordedVertex> vertices;
    Rgb radiance;
};

}  // namespace alhazen

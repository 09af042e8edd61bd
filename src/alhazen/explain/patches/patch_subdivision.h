#pragma once
/// The subdivision of a patch for a ray: parts whose boxes the ray misses are dropped, others are
/// divided into four, down to the size of a pixel.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980, section
/// "Object representation and hidden surface elimination"; Rubin and Whitted, "A 3-Dimensional
/// Representation for Fast Rendering of Complex Scenes", SIGGRAPH 1980 (boxes).
/// Differs: for display, beside the crossings that the certified search of the shape reports
/// (docs/design/patches.md); boxes instead of spheres; a pixel is 2^-10 of the box of the patch.
/// Conventions: Bezier patches, the patches of patch meshes and the pieces of NURBS surfaces,
/// placed or inside instances; trimmed crossings are omitted. u and v are in the unit square of the
/// patch.

#include <string>
#include <vector>

#include "alhazen/geometry/ray.h"
#include "alhazen/session/load.h"

namespace alhazen {

/// The part [u, u + 1] x [v, v + 1] / 2^level of a patch.
struct PatchPart {
    int level = 0, u = 0, v = 0;
    bool met = false;  ///< the ray meets its box
};

struct PatchSubdivision {
    std::string shape, part;
    std::size_t piece = 0;  ///< index of the patch in its shape
    int degree_u = 0, degree_v = 0;
    std::vector<PatchPart> parts;  ///< ordered by level; at most 4000
    bool cut = false;              ///< true: there were more parts
    struct Crossing {
        double t = 0, u = 0, v = 0;
    };
    std::vector<Crossing> crossings;  ///< ascending; t >= 0
};

/// At most six of the patches whose boxes the ray meets: those with crossings first, ordered by
/// their first crossing.
[[nodiscard]] std::vector<PatchSubdivision> patch_subdivisions(const LoadedScene& loaded,
                                                               const Ray& ray);

}  // namespace alhazen

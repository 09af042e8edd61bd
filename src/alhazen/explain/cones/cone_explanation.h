#pragma once
/// The tree of cones of a pixel of `cone_tracing`, with the surfaces that cover each cone.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, section 3 (the parts of a cone that
/// objects cover).
/// Differs: recorded from the renderer while it traces.
/// Conventions: radiance of a cone = sum over its pieces of weight * color + left * background. A
/// pixel is one cone.

#include <string>
#include <vector>

#include "alhazen/geometry/cones/cone_ray.h"
#include "alhazen/renderers/cone_tracing/cone_tracer.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

struct ConeNode;

/// A piece of a cone that a surface covers.
struct ConePart {
    std::string object;
    Vec3 point;        ///< middle of the piece
    Vec2 at;           ///< the middle in the disc of the cone
    double t = 0;      ///< parameter of the middle
    double share = 0;  ///< fraction of the cone that the piece covers by itself
    /// Fraction of the cone for which the piece is seen; several pieces represent a whole surface.
    double weight = 0;
    double radius = 0;  ///< radius of a disc of the size of the piece
    Rgb color;
    std::vector<ConeNode> cones;  ///< that leave it: shadow, reflected and refracted cones
};

struct ConeNode {
    RayKind kind = RayKind::Eye;
    int depth = 0;
    ConeRay cone;
    double narrowed = 1;  ///< width of the part that was searched, relative to the whole cone
    double length = 0;    ///< up to the last piece or the light; infinite if nothing ends it
    std::vector<ConePart> parts;
    double left = 1;  ///< fraction of the cone that nothing covers
    Rgb radiance;     ///< for a shadow cone the transmitted fraction of the light
    ConeToLight to;   ///< for a shadow cone
};

struct ConeExplanation {
    std::string unavailable;  ///< reason if there is no tree; else empty
    ConeNode tree;
    bool cut = false;  ///< true: some cones are omitted, as there are more than 2000
};

/// The tree of cones of a pixel of a frame. The job must have its description.
[[nodiscard]] ConeExplanation explain_cones(const RenderJob& job, int x, int y, int width,
                                            int height);

}  // namespace alhazen

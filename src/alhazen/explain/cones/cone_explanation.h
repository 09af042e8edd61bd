#pragma once
/// The tree of cones behind a pixel of `cone_tracing`: what each covers, and with what colour.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, section 3 (the parts of a cone that
/// objects cover).
/// Differs: recorded from the renderer while it traces.
/// Conventions: radiance of a cone = sum over its pieces of weight * color + left * background. The
/// pixel is one cone.

#include <string>
#include <vector>

#include "alhazen/geometry/cones/cone_ray.h"
#include "alhazen/renderers/cone_tracing/cone_tracer.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

struct ConeNode;

/// A part of a cone that a surface covers.
struct ConePart {
    std::string object;
    Vec3 point;        ///< its middle
    Vec2 at;           ///< the same, in the disc of the cone
    double t = 0;      ///< of the middle
    double share = 0;  ///< of the cone, that the piece covers alone
    double weight =
        0;  ///< of the cone, that is seen of it; several pieces stand for all of a surface
    double radius = 0;  ///< of a disc of the size of the piece
    Rgb color;
    std::vector<ConeNode> cones;  ///< that leave it: towards lights, reflected, refracted
};

struct ConeNode {
    RayKind kind = RayKind::Eye;
    int depth = 0;
    ConeRay cone;
    double narrowed = 1;  ///< width of the part that was searched, of the whole cone
    double length = 0;    ///< to the last piece, or to the light; infinite where nothing ends it
    std::vector<ConePart> parts;
    double left = 1;  ///< of the cone, that nothing covers
    Rgb radiance;     ///< of a shadow cone: of the light, what comes through
    ConeToLight to;   ///< of a shadow cone
};

struct ConeExplanation {
    std::string unavailable;  ///< why there is no tree
    ConeNode tree;
    bool cut = false;  ///< cones are left out: there are more than 2000
};

/// The cone of a pixel of a frame. The job must have its description.
[[nodiscard]] ConeExplanation explain_cones(const RenderJob& job, int x, int y, int width,
                                            int height);

}  // namespace alhazen

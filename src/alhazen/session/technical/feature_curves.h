#pragma once
/// The curves of a technical drawing in space: edges of solids and outlines of round shapes.
///
/// Source: Appel, "The Notion of Quantitative Invisibility and the Machine Rendering of Solids",
/// ACM National Conference 1967 (contours: where a surface turns away from the eye); Hertzmann and
/// Zorin, "Illustrating Smooth Surfaces", SIGGRAPH 2000 (contours of meshes: where interpolated
/// normals are perpendicular to the view).
/// Differs: outlines and rims of spheres, cylinders and cones are circles and lines in closed form,
/// computed from the eye in the space of the shape; a placement turns them into ellipses.
/// Conventions: world space. Edges of boxes, rectangles and polygons are exact; all other shapes
/// and solids are drawn by their tessellation.

#include <vector>

#include "alhazen/geometry/facets/beam_projection.h"
#include "alhazen/imaging/drawing/drawing.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// origin + cos(t) u + sin(t) v if round, otherwise origin + t u.
struct CurveForm {
    Vec3 origin, u, v;
};

struct FeatureCurve {
    bool round = false;
    CurveForm points;
    /// Outward directions of the two surfaces that meet, of any length.
    CurveForm out, other_out;
    double from = 0, to = 1;
    LineStyle style = LineStyle::Crease;
    double off = 0;  ///< largest distance of the surface from the curve
};

/// The curves that `eye` (in world space) sees. Parts without a tessellation within `tolerance`
/// (unbounded ones) are omitted and named in `left_out`. Separate spheres, cylinders, cones, boxes
/// and solids of these have lines where they penetrate each other; other shapes have none there.
[[nodiscard]] std::vector<FeatureCurve> feature_curves(const SceneDescription& description,
                                                       const BeamApex& eye, double tolerance,
                                                       std::vector<std::string>& left_out);

}  // namespace alhazen

#pragma once
/// A technical drawing of any scene: lines on white, hidden ones dashed or left out.
///
/// Source: Appel, "The Notion of Quantitative Invisibility and the Machine Rendering of Solids",
/// ACM National Conference 1967.
/// Differs: what hides a point of a curve is found by a ray to the exact scene, not by counting
/// edges that cross the curve in the picture: solids of constructive geometry hide as they are.
/// Where a curve goes out of sight is found by halving.
/// Conventions: circles and ellipses stay ellipses where all of them lies before the eye. All
/// surfaces are opaque; mirrors show nothing.

#include "alhazen/imaging/drawing/drawing.h"
#include "alhazen/session/load.h"
#include "alhazen/session/render.h"

namespace alhazen {

struct TechnicalOptions {
    double tolerance = 0;  ///< of triangles in place of shapes without exact outlines, scene units
    bool hidden = false;   ///< hidden lines are dashed; else left out
};

/// The scene needs its aggregate. `options`: sizes and camera are heeded. Throws Error (Usage)
/// without an aggregate or a positive tolerance.
[[nodiscard]] Drawing technical_drawing(const LoadedScene& loaded, const RenderOptions& options,
                                        const TechnicalOptions& technical);

}  // namespace alhazen

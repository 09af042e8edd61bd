#pragma once
/// A technical drawing of any scene: lines on white, hidden lines dashed or omitted.
///
/// Source: Appel, "The Notion of Quantitative Invisibility and the Machine Rendering of Solids",
/// ACM National Conference 1967.
/// Differs: rays to the exact scene find which points of a curve are hidden, not a count of edges
/// that cross the curve in the picture: CSG solids occlude exactly. Bisection finds where a curve
/// becomes hidden.
/// Conventions: circles and ellipses stay ellipses if they lie entirely in front of the eye. All
/// surfaces are opaque; mirrors show nothing.

#include "alhazen/imaging/drawing/drawing.h"
#include "alhazen/session/load.h"
#include "alhazen/session/render.h"

namespace alhazen {

struct TechnicalOptions {
    double tolerance = 0;  ///< of the tessellation of shapes without exact outlines, scene units
    bool hidden = false;   ///< true: hidden lines are dashed; false: omitted
};

/// Draws a scene that has its aggregate. Of `options`, sizes and camera are used. Throws Error
/// (Usage) without an aggregate or a positive tolerance.
[[nodiscard]] Drawing technical_drawing(const LoadedScene& loaded, const RenderOptions& options,
                                        const TechnicalOptions& technical);

}  // namespace alhazen

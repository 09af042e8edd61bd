#pragma once
/// Draws a loaded scene of planar facets as vector graphics, by beams.

#include "alhazen/imaging/drawing/drawing.h"
#include "alhazen/session/load.h"
#include "alhazen/session/render.h"

namespace alhazen {

enum class DrawingLook {
    Shaded,     ///< regions in the colours of `whitted`
    Lined,      ///< the same, with lines
    Technical,  ///< lines on white
};

/// Of `options`, sizes, camera, depth, threads and stop are used. Throws Error: Usage if parts have
/// no planar facets, or as `render`.
[[nodiscard]] Drawing draw_scene(const LoadedScene& loaded, const RenderOptions& options,
                                 DrawingLook look);

}  // namespace alhazen

#pragma once
/// Renders the crop of a film by adaptive supersampling (adaptive_grid.h).
///
/// Conventions: pixel (i, j) is the square between the film coordinates i / width and (i + 1) /
/// width, and likewise for rows, regardless of the scene's convention for single samples. Pixels
/// and counts are independent of the threads and the tile size. AOVs: the geometry of a pixel is
/// that at its four corners; a ray is counted for the first pixel that needs it.

#include "alhazen/renderers/antialias/single_rays.h"

namespace alhazen {

/// RenderJob::antialias must be set. Throws Error (Usage) for layers that cannot be divided among
/// pixels that share their rays. After a stop the film is unchanged and no part is complete.
[[nodiscard]] RenderReport render_adaptively(const SingleRayRenderer& renderer,
                                             const RenderJob& job, Film& film);

}  // namespace alhazen

#pragma once
/// Pixel-selected ray tracing: traces rays for some pixels and interpolates between them where they
/// agree. For fast previews.
///
/// Source: T. Akimoto, K. Mase and Y. Suenaga, "Pixel-Selected Ray Tracing", IEEE Computer Graphics
/// and Applications 11(4), 1991.
/// Differs: only first hits are compared, not trees of rays. The sides of a cell are tested as
/// well: it is divided if a ray of a smaller neighbour disagrees with the interpolated shade.
/// Conventions: a traced pixel has the same bits as without selection. Pixels are independent of
/// the threads and the tile size. Objects between the rays of a cell are missed.

#include "alhazen/renderers/antialias/single_rays.h"

namespace alhazen {

/// RenderJob::antialias must be set, with a step. Throws Error (Usage) for layers, which require
/// rays for all pixels. After a stop no part is complete.
[[nodiscard]] RenderReport render_selected_pixels(const SingleRayRenderer& renderer,
                                                  const RenderJob& job, Film& film);

}  // namespace alhazen

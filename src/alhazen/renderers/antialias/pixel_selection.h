#pragma once
/// Pixel-selected ray tracing: rays for some pixels, and shades between them where they agree. For
/// pictures that must be there soon.
///
/// Source: T. Akimoto, K. Mase and Y. Suenaga, "Pixel-Selected Ray Tracing", IEEE Computer Graphics
/// and Applications 11(4), 1991.
/// Differs: of the trees of rays only the first hits are compared. The sides of a cell are looked
/// at, too: where a ray of a smaller neighbour disagrees with the shade that the cell gives it, the
/// cell is divided.
/// Conventions: a pixel that is traced has the bits that it has without selection.
/// Pixels depend neither on the threads nor on the tile size. What lies between the rays of a cell
/// is missed.

#include "alhazen/renderers/antialias/single_rays.h"

namespace alhazen {

/// RenderJob::antialias must be set, with a step. Throws Error (Usage) for layers, which are for
/// pixels with rays of their own. After a stop no part is done.
[[nodiscard]] RenderReport render_selected_pixels(const SingleRayRenderer& renderer,
                                                  const RenderJob& job, Film& film);

}  // namespace alhazen

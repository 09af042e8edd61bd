#pragma once
/// Pixels of beams under a filter wider than a pixel: the part of each pixel that a piece covers is
/// shaded once, and weighted by the integral of the kernel over it.
///
/// Source: film/filter_integral.h. Conventions: those of pixel_polygon.h. A part has its mean
/// colour (pixel_quadrature.h), as without a filter. Threads: one tile renderer for each thread.

#include <memory>

#include "alhazen/renderers/beam_tracing/beam_pixels.h"
#include "alhazen/renderers/beam_tracing/beam_scene.h"
#include "alhazen/renderers/core/tiles.h"

namespace alhazen {

/// A frame enlarged by the radius of a filter, and its camera.
class WiderFrame {
  public:
    /// The frame of the film, with the border of `job.antialias` if `filtered`.
    WiderFrame(const RenderJob& job, const Film& film, bool filtered);

    [[nodiscard]] const RenderJob& job() const { return job_; }
    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] const PixelBox& crop() const { return crop_; }
    /// Width of the border on each side, in pixels.
    [[nodiscard]] int border() const { return border_; }

  private:
    RenderJob job_;
    int border_ = 0;
    int width_, height_;
    PixelBox crop_;
};

/// Creates renderers for tiles of the film within the frame.
[[nodiscard]] std::unique_ptr<TileRenderer> beam_filter_renderer(const WiderFrame& frame,
                                                                 const BeamScene& scene,
                                                                 const BeamTree& tree,
                                                                 const BeamPixels& pixels,
                                                                 const BeamBands& bands);

}  // namespace alhazen

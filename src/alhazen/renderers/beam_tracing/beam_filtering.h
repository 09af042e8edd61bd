#pragma once
/// Pixels of beams under a filter that reaches into the pixels around: the part of each pixel that
/// a piece covers is shaded once, and weighed with the integral of the kernel over it.
///
/// Source: film/filter_integral.h. Conventions: those of beam_raster.h. A part has the colour of
/// its own middle, a whole pixel the mean of the four points of Gauss' rule, as without a filter.
/// Threads: a tile renderer for each.

#include <memory>

#include "alhazen/imaging/film/filter_integral.h"
#include "alhazen/renderers/beam_tracing/beam_pixels.h"
#include "alhazen/renderers/beam_tracing/beam_scene.h"
#include "alhazen/renderers/core/tiles.h"

namespace alhazen {

/// A frame with a border of the reach of a filter, and the camera that sees it.
class WiderFrame {
  public:
    /// The frame of the film, with the border of `job.antialias` where `filtered`.
    WiderFrame(const RenderJob& job, const Film& film, bool filtered);

    [[nodiscard]] const RenderJob& job() const { return job_; }
    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] const PixelBox& crop() const { return crop_; }
    /// Pixels on each side.
    [[nodiscard]] int border() const { return border_; }

  private:
    RenderJob job_;
    int border_ = 0;
    int width_, height_;
    PixelBox crop_;
};

/// For the tiles of the film within the frame.
[[nodiscard]] std::unique_ptr<TileRenderer> beam_filter_renderer(const WiderFrame& frame,
                                                                 const BeamScene& scene,
                                                                 const BeamTree& tree,
                                                                 const BeamPixels& pixels,
                                                                 const BeamBands& bands);

/// The parts of a region in the pixels of a row. Loops are cut by the lines between pixels.
class PixelParts {
  public:
    struct Part {
        int i = 0;         ///< column
        double share = 0;  ///< of the pixel
        Vec2 middle;       ///< from the centre of the pixel, in pixels, y up
        /// Ends of the part's loops in `points`; coordinates as those of `middle`.
        std::size_t first_loop = 0, end_loop = 0;
    };
    /// Columns between successive `edges`, from `first` on, between the heights `lo` and `hi`.
    void find(const PolygonSet& region, int first, std::span<const double> edges, double lo,
              double hi);

    [[nodiscard]] std::span<const Part> parts() const { return parts_; }
    [[nodiscard]] std::span<const Vec2> loop(std::size_t k) const {
        const std::size_t begin = k == 0 ? 0 : ends_[k - 1];
        return std::span(points_).subspan(begin, ends_[k] - begin);
    }

  private:
    /// Of the strip.
    void add_pixel(const Vec2& corner, const Vec2& size, int number);

    std::vector<Part> parts_;
    std::vector<Vec2> points_;
    std::vector<std::size_t> ends_;
    std::vector<Vec2> strip_;
    std::vector<std::size_t> strip_ends_;
    std::vector<Vec2> one_, other_;
};

}  // namespace alhazen

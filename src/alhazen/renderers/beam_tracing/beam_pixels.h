#pragma once
/// Positions of the pixels of a frame in the window of beams, and an index of pieces by row.
///
/// Conventions: those of beam_caster.h; rows count from the top.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/renderers/beam_tracing/beam_tree.h"
#include "alhazen/renderers/core/samplers.h"

namespace alhazen {

/// Sample points and pixel edges of a frame, in the window. The camera's film is the frame.
class BeamPixels {
  public:
    [[nodiscard]] static double to_window(double film) { return (2.0 * film - 1.0) * kBeamFilm; }

    BeamPixels(const RenderJob& job, int width, int height) {
        const PointSampler middle(job, width, height);
        for (int i = 0; i < width; ++i) xs_.push_back(to_window(middle.at(i, 0).x));
        for (int j = 0; j < height; ++j) ys_.push_back(to_window(middle.at(0, j).y));
        for (int i = 0; i <= width; ++i) edges_.push_back(to_window(double(i) / width));
        for (int j = 0; j <= height; ++j) rows_.push_back(to_window(1.0 - double(j) / height));
    }
    [[nodiscard]] std::span<const double> xs(int first, int end) const {
        return std::span(xs_).subspan(static_cast<std::size_t>(first),
                                      static_cast<std::size_t>(end - first));
    }
    [[nodiscard]] std::span<const double> edges(int first, int end) const {
        return std::span(edges_).subspan(static_cast<std::size_t>(first),
                                         static_cast<std::size_t>(end - first + 1));
    }
    [[nodiscard]] double y(int j) const { return ys_[static_cast<std::size_t>(j)]; }
    [[nodiscard]] double top(int j) const { return rows_[static_cast<std::size_t>(j)]; }
    [[nodiscard]] double bottom(int j) const { return rows_[static_cast<std::size_t>(j) + 1]; }

    /// The part of the window around the pixels of a crop.
    [[nodiscard]] PolygonSet around(const PixelBox& crop) const {
        const auto down = [](double x) {
            return static_cast<std::int32_t>(std::max(std::floor(x) - 2.0, -1.0 * kLatticeLimit));
        };
        const auto up = [](double x) {
            return static_cast<std::int32_t>(std::min(std::ceil(x) + 2.0, 1.0 * kLatticeLimit));
        };
        const auto i0 = static_cast<std::size_t>(crop.x0), i1 = static_cast<std::size_t>(crop.x1);
        const double x_lo = std::min(edges_[i0], xs_[i0]), x_hi = std::max(edges_[i1], xs_[i1 - 1]);
        const double y_lo = std::min(bottom(crop.y1 - 1), y(crop.y1 - 1));
        const double y_hi = std::max(top(crop.y0), y(crop.y0));
        return lattice_rectangle({down(x_lo), down(y_lo)}, {up(x_hi), up(y_hi)});
    }

  private:
    std::vector<double> xs_, ys_, edges_, rows_;
};

/// Pieces indexed by the rows of pixels that they touch, in bands.
class BeamBands {
  public:
    static constexpr int kRows = 16;
    BeamBands(const BeamTree& tree, const BeamPixels& pixels, const PixelBox& crop) : crop_(crop) {
        bands_.resize(static_cast<std::size_t>((crop.y1 - crop.y0 + kRows - 1) / kRows));
        for (std::uint32_t k = 0; k < tree.pieces.size(); ++k) {
            const LatticeBox& box = tree.pieces[k].seen.region.bounds();
            // Rows count downwards: the bands at or below the top of the box.
            for (std::size_t b = 0; b < bands_.size(); ++b) {
                const int first = crop.y0 + static_cast<int>(b) * kRows;
                const int last = std::min(first + kRows, crop.y1) - 1;
                const double hi = std::max(pixels.top(first), pixels.y(first));
                const double lo = std::min(pixels.bottom(last), pixels.y(last));
                if (box.lo.y <= hi && box.hi.y >= lo) bands_[b].push_back(k);
            }
        }
    }
    [[nodiscard]] std::span<const std::uint32_t> pieces_of(int j) const {
        return bands_[static_cast<std::size_t>((j - crop_.y0) / kRows)];
    }

  private:
    PixelBox crop_;
    std::vector<std::vector<std::uint32_t>> bands_;
};

}  // namespace alhazen

#pragma once
/// The samples of a crop, on the grid of edges: one sample per pixel in columns and rows, or
/// several samples anywhere in each pixel.
///
/// Conventions: those of PixelSampler and ScreenView. Rows and columns count from the corner of the
/// crop. With several samples per pixel, row j is the interval [j, j + 1) of the frame.

#include <algorithm>
#include <cmath>
#include <vector>

#include "alhazen/imaging/film/film.h"
#include "alhazen/renderers/core/samplers.h"
#include "alhazen/renderers/lane_carpenter/screen_view.h"

namespace alhazen {

/// The integers from begin up to, but not including, end.
struct IndexRange {
    int begin = 0, end = 0;
    [[nodiscard]] bool empty() const { return begin >= end; }
};

class SampleGrid {
  public:
    SampleGrid(const RenderJob& job, const Film& film, const ScreenView& view)
        : SampleGrid(job, film, film.crop(), view) {}
    /// The samples of any crop of the frame of `film`.
    SampleGrid(const RenderJob& job, const Film& film, const PixelBox& crop, const ScreenView& view)
        : crop_(crop),
          view_(view),
          point_(job, film.frame_width(), film.frame_height()),
          jitter_(job, film.frame_width(), film.frame_height()),
          several_(job.samples_per_pixel > 1),
          frame_width_(film.frame_width()),
          frame_height_(film.frame_height()) {
        for (int i = 0; i < columns(); ++i) xs_.push_back(grid_at(i, 0, 0).x);
        for (int j = 0; j < rows(); ++j) ys_.push_back(grid_at(0, j, 0).y);
        if (columns() > 1) {
            columns_per_unit_ = (columns() - 1) / (double(xs_.back()) - xs_.front());
            // Rounding of columns, half a unit each; that of positions on lines is much smaller.
            column_slack_ = 2.0 * columns_per_unit_;
        }
    }

    [[nodiscard]] int columns() const { return crop_.width(); }
    [[nodiscard]] int rows() const { return crop_.height(); }
    [[nodiscard]] bool several() const { return several_; }
    [[nodiscard]] int samples() const { return several_ ? jitter_.count() : 1; }

    /// Film coordinates of a sample.
    [[nodiscard]] Vec2 film_at(int column, int row, int sample) const {
        const int i = crop_.x0 + column, j = crop_.y0 + row;
        return several_ ? jitter_.at(i, j, sample) : point_.at(i, j);
    }
    [[nodiscard]] FixedPoint grid_at(int column, int row, int sample) const {
        const Vec2 p = film_at(column, row, sample);
        return {view_.to_grid(p.x * frame_width_), view_.to_grid((1.0 - p.y) * frame_height_)};
    }
    /// Grid coordinate of the samples in a column, or in a row; with one sample per pixel.
    [[nodiscard]] std::int32_t x(int column) const { return xs_[static_cast<std::size_t>(column)]; }
    [[nodiscard]] std::int32_t y(int row) const { return ys_[static_cast<std::size_t>(row)]; }

    [[nodiscard]] const std::int32_t* xs() const { return xs_.data(); }
    /// The fractional column at `x`, accurate to column_slack(); with one sample per pixel.
    [[nodiscard]] double column_of(double x) const { return (x - xs_.front()) * columns_per_unit_; }
    [[nodiscard]] double column_slack() const { return column_slack_; }

    /// Extent of the samples, in pixels of the frame.
    [[nodiscard]] double left() const {
        return several_ ? crop_.x0 : (xs_.front() - 1.0) / view_.grid_per_pixel();
    }
    [[nodiscard]] double right() const {
        return several_ ? crop_.x1 : (xs_.back() + 1.0) / view_.grid_per_pixel();
    }
    [[nodiscard]] double top() const {
        return several_ ? crop_.y0 : (ys_.front() - 1.0) / view_.grid_per_pixel();
    }
    [[nodiscard]] double bottom() const {
        return several_ ? crop_.y1 : (ys_.back() + 1.0) / view_.grid_per_pixel();
    }

    /// Rows that may have samples in [lo, hi], in pixels of the frame.
    [[nodiscard]] IndexRange rows_in(double lo, double hi) const {
        return range(ys_, crop_.y0, lo, hi);
    }
    [[nodiscard]] IndexRange columns_in(double lo, double hi) const {
        return range(xs_, crop_.x0, lo, hi);
    }

  private:
    /// Indices of the samples at positions in [lo - 1 grid unit, hi + 1 grid unit].
    [[nodiscard]] IndexRange range(const std::vector<std::int32_t>& at, int first, double lo,
                                   double hi) const {
        const int count = static_cast<int>(at.size());
        const auto near = [&](double pixel) {
            return static_cast<int>(std::clamp(pixel - first, 0.0, double(count)));
        };
        const double unit = 1.0 / view_.grid_per_pixel();
        if (several_) {
            // Rows and columns are whole pixels.
            return {near(std::ceil(lo - unit) - 1.0), near(std::floor(hi + unit) + 1.0)};
        }
        const double scale = view_.grid_per_pixel();
        const double least = lo * scale - 1.0, most = hi * scale + 1.0;
        const std::int32_t* const places = at.data();
        // Samples lie near the middle of pixels: the loops below seldom iterate.
        IndexRange result{near(lo + 0.5), near(hi + 0.5)};
        while (result.begin > 0 && places[result.begin - 1] >= least) --result.begin;
        while (result.begin < count && places[result.begin] < least) ++result.begin;
        while (result.end < count && places[result.end] <= most) ++result.end;
        while (result.end > result.begin && places[result.end - 1] > most) --result.end;
        return result;
    }

    PixelBox crop_;
    ScreenView view_;
    PointSampler point_;
    JitteredSampler jitter_;
    bool several_;
    int frame_width_, frame_height_;
    std::vector<std::int32_t> xs_, ys_;
    double columns_per_unit_ = 0, column_slack_ = 1;
};

}  // namespace alhazen

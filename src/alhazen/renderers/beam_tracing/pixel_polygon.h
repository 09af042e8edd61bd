#pragma once
/// The parts of pixels that regions of the window cover, as polygons.
///
/// Source: Sutherland and Hodgman, "Reentrant Polygon Clipping", Communications of the ACM 17,
/// 1974. Conventions: coordinates are in pixels from the centre of the pixel, y up. Loops have the
/// inside on their left. A part is independent of the requesting tile.

#include <cstddef>
#include <span>
#include <vector>

#include "alhazen/geometry/polygon_sets/polygon_set.h"
#include "alhazen/math/vec.h"

namespace alhazen {

/// The part of a loop on one side of a line across an axis: coordinate >= at, or <= at.
void cut_loop(std::span<const Vec2> loop, int axis, double at, bool above,
              std::vector<Vec2>& result);

/// Consecutive loops.
struct PixelPolygon {
    std::vector<Vec2> points;
    std::vector<std::size_t> ends;

    [[nodiscard]] std::span<const Vec2> loop(std::size_t k) const {
        const std::size_t begin = k == 0 ? 0 : ends[k - 1];
        return std::span(points).subspan(begin, ends[k] - begin);
    }
    void add(std::span<const Vec2> loop) {
        points.insert(points.end(), loop.begin(), loop.end());
        ends.push_back(points.size());
    }
    /// The quarter of the cell with the corners at `lo` and `hi`.
    [[nodiscard]] PixelPolygon within(const Vec2& lo, const Vec2& hi) const;
};

/// A whole pixel.
[[nodiscard]] PixelPolygon whole_pixel();

/// The part of a region in a row of pixels.
class RowStrip {
  public:
    /// Sets the strip between two heights of the window.
    void set(const PolygonSet& region, double lo, double hi);
    /// The covered part of the pixel between two lines.
    void cut(double left, double right, PixelPolygon& result);

    /// Horizontal extent; left() > right() if empty.
    [[nodiscard]] double left() const { return left_; }
    [[nodiscard]] double right() const { return right_; }

  private:
    PixelPolygon strip_;
    double lo_ = 0, hi_ = 0, left_ = 0, right_ = 0;
    std::vector<Vec2> one_, other_;
};

}  // namespace alhazen

#pragma once
/// Rasterisation of polygons of the window: sample points inside, or exact coverage of each pixel.
///
/// Source: the closed form of the box filter: areas and first moments to the right of each edge
/// (Green's theorem), summed along each row of pixels.
/// Conventions: a point on an edge belongs to the region above it or to its right, so that regions
/// without gap and overlap share no point. Rows count from the top.
/// Complexity: O(edges * rows + pixels).

#include <vector>

#include "alhazen/geometry/polygon_sets/polygon_set.h"
#include "alhazen/imaging/film/film.h"
#include "alhazen/math/vec.h"

namespace alhazen {

/// A pixel of a region.
struct BeamSample {
    int i = 0, j = 0;
    double share = 1;  ///< covered fraction of the pixel
    Vec2 at;           ///< in the window: the sample point, or the centroid of the part
};

/// Appends the samples of a row; `xs` are the sample points of the columns from `first` on.
void add_points(const PolygonSet& region, int j, double y, int first, std::span<const double> xs,
                std::vector<double>& crossings, std::vector<BeamSample>& samples);

/// Coverage of the pixels of one row.
class RowAreas {
  public:
    /// Starts a row between `lo` and `hi`, with columns between successive `edges`.
    void begin(double lo, double hi, std::span<const double> edges);
    void add(const PolygonSet& region);
    /// Appends the pixels of row `j`, the first of which has column `first`, and resets the row.
    void take(int j, int first, std::vector<BeamSample>& samples);

  private:
    /// Area, and integrals of x and y.
    struct Moments {
        double area = 0, x = 0, y = 0;
    };
    void add_edge(double x0, double y0, double x1, double y1);
    void add_within(std::size_t column, double x0, double y0, double x1, double y1, double sign);

    double lo_ = 0, hi_ = 0;
    std::span<const double> edges_;
    /// Sums of height differences and of their squares, as multiples of 2^-28 of a lattice unit.
    /// They are independent of how an edge is divided, so that a pixel is independent of its tile.
    struct Heights {
        std::int64_t height = 0;
        Int128 square = 0;

        void add(double lo, double hi, double sign);
    };
    std::vector<Moments> own_;   ///< [column] to the right of edges in it
    std::vector<Heights> full_;  ///< [column] of edges that end left of it
};

}  // namespace alhazen

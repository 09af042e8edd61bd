#pragma once
/// Sets of points that keep their distance, on the torus: the unit square without borders.
///
/// Source: Cook, 1986 (Poisson discs by throwing darts); McCool and Fiume, "Hierarchical Poisson
/// Disk Sampling Distributions", Graphics Interface 1992 (a shrinking radius); Mitchell,
/// "Spectrally Optimal Sampling for Distribution Ray Tracing", SIGGRAPH 1991 (best candidates).
/// Differs: at most kMostCandidates candidates for a point.
/// Conventions: distances are those on the torus.
/// Complexity: O(n) darts and O(n) candidates, each in constant time on average.

#include <cstdint>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The smallest distance of two images of the points on the torus, squared.
[[nodiscard]] double torus_distance_squared(const Vec2& a, const Vec2& b);

/// Points in a grid of cells.
class TorusPoints {
  public:
    explicit TorusPoints(std::uint32_t expected);

    void add(const Vec2& p);
    [[nodiscard]] const std::vector<Vec2>& points() const { return points_; }
    /// The squared distance to the nearest point, or any value below `enough` where that is less;
    /// at most 1.
    [[nodiscard]] double nearest_squared(const Vec2& p, double enough) const;

  private:
    [[nodiscard]] std::uint32_t cell_of(double x) const;
    void make_cells(std::uint32_t side);
    [[nodiscard]] double nearest_in_ring(const Vec2& p, int ring, double best) const;

    std::uint32_t side_ = 1;                         ///< cells of a row
    std::vector<std::vector<std::uint32_t>> cells_;  ///< numbers of points
    std::vector<Vec2> points_;
};

struct DiscSet {
    std::vector<Vec2> points;
    double radius = 0;  ///< no two points are nearer
};
/// Random points of which no two are nearer than the radius, which shrinks until all have room. In
/// the order of the darts.
[[nodiscard]] DiscSet poisson_disc_set(std::uint64_t key, std::uint32_t count);

/// Each point is the farthest from those before it of many candidates: each beginning of the list
/// is a good set.
[[nodiscard]] std::vector<Vec2> best_candidate_set(std::uint64_t key, std::uint32_t count);

}  // namespace alhazen

#pragma once
/// Sets of points with a minimum distance on the torus (the unit square with opposite sides
/// joined).
///
/// Source: Cook, 1986 (Poisson discs by throwing darts); McCool and Fiume, "Hierarchical Poisson
/// Disk Sampling Distributions", Graphics Interface 1992 (a shrinking radius); Mitchell,
/// "Spectrally Optimal Sampling for Distribution Ray Tracing", SIGGRAPH 1991 (best candidates).
/// Differs: tries at most kMostCandidates candidates for a point.
/// Conventions: distances are those on the torus.
/// Complexity: O(n) darts and O(n) candidates, each in constant time on average.

#include <cstdint>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The squared distance between the nearest images of two points on the torus.
[[nodiscard]] double torus_distance_squared(const Vec2& a, const Vec2& b);

/// A grid of points on the torus, for queries of the nearest point.
class TorusPoints {
  public:
    explicit TorusPoints(std::uint32_t expected);

    void add(const Vec2& p);
    [[nodiscard]] const std::vector<Vec2>& points() const { return points_; }
    /// The squared distance to the nearest point, at most 1; any value below `enough` if the
    /// squared distance is below it.
    [[nodiscard]] double nearest_squared(const Vec2& p, double enough) const;

  private:
    [[nodiscard]] std::uint32_t cell_of(double x) const;
    void make_cells(std::uint32_t side);
    [[nodiscard]] double nearest_in_ring(const Vec2& p, int ring, double best) const;

    std::uint32_t side_ = 1;                         ///< number of cells in a row
    std::vector<std::vector<std::uint32_t>> cells_;  ///< [cell] indices of its points
    std::vector<Vec2> points_;
};

struct DiscSet {
    std::vector<Vec2> points;
    double radius = 0;  ///< lower bound of the distance of two points
};
/// Random points, in the order of their darts, of which no two are nearer than the radius. The
/// radius shrinks until all points have room.
[[nodiscard]] DiscSet poisson_disc_set(std::uint64_t key, std::uint32_t count);

/// Each point is, of many candidates, the one farthest from those before it: each prefix of the
/// list is a good set.
[[nodiscard]] std::vector<Vec2> best_candidate_set(std::uint64_t key, std::uint32_t count);

}  // namespace alhazen

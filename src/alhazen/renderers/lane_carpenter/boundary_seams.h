#pragma once
/// Weights of the boundary curves of patches that cancel where two sides agree.
///
/// Conventions: a curve of two patches has a random weight on one side and its negative on the
/// other, by the direction of the curve; a curve of one patch has 0. Curves are shared if their
/// control points are equal.

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "alhazen/renderers/lane_carpenter/scan_scene.h"

namespace alhazen {

class BoundarySeams {
  public:
    explicit BoundarySeams(const ScanScene& scene);
    /// The weights of the four sides of a piece.
    [[nodiscard]] std::array<std::uint64_t, 4> of(std::uint32_t piece) const;

  private:
    struct Side {
        std::uint32_t piece;
        int side;
        bool backward;
    };
    using Key = std::vector<double>;

    void add(const BezierNet& net, std::uint32_t piece, int side);
    void set(const Side& side, std::uint64_t weight);

    std::map<Key, Side> open_;  ///< curves found once so far
    std::map<std::uint32_t, std::array<std::uint64_t, 4>> weights_;
};

}  // namespace alhazen

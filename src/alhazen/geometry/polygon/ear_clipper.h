#pragma once
/// Triangulates a plane polygon on its own vertices by ear clipping.
///
/// Source: Eberly, "Triangulation by Ear Clipping", Geometric Tools, 2002 (only reflex vertices are
/// tested; the state of an ear's two neighbours is updated when it is cut off).
/// Differs: signs are exact; reflex vertices are found by a tree of boxes, the next ear by a tree
/// of words. Of coincident neighbours one is cut off at once, as neither has an angle; so is a
/// corner that turns back, the tip of a spike or a slit without width. A polygon
/// without a remaining ear (it touches or crosses itself) is cut at a corner without area, or else
/// at its next corner that does not turn right, so that n vertices always give n - 2 triangles.
/// Conventions: the triangles of a simple counter-clockwise polygon tile it exactly; those of other
/// polygons have its signed area.
/// Complexity and threads: O(n log n) and at most 11 n searches of the tree, each O(sqrt n) for
/// evenly spread vertices. Once the searches have tested more than kTestsPerVertex n boxes, and
/// more than kMostTests, the rest is cut without searching; no polygon of up to 4096 vertices
/// reaches this limit. No shared state.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "alhazen/geometry/polygon/ordered_bits.h"
#include "alhazen/geometry/polygon/point_tree.h"

namespace alhazen {

/// Limit of box and point tests per vertex of a polygon.
inline constexpr std::uint64_t kTestsPerVertex = 256;
/// Number of tests that every polygon may use: 4 * 4096^2.
inline constexpr std::uint64_t kMostTests = std::uint64_t{1} << 26;

class EarClipper {
  public:
    /// `flat`: at least 3 finite points whose products do not overflow; kept by reference.
    explicit EarClipper(const std::vector<Vec2>& flat);

    /// The vertex indices of n - 2 triangles. May be called once.
    [[nodiscard]] std::vector<std::array<std::uint32_t, 3>> clip();

  private:
    struct Corner {
        std::uint32_t previous = 0, next = 0;
        bool ear = false, gone = false;
    };
    void merge_repeated();
    [[nodiscard]] bool is_spike(std::uint32_t i) const;
    std::uint32_t cut_spikes(std::uint32_t at);
    void rebuild();
    void renew_ears();
    void classify(std::uint32_t i);
    void update_ear(std::uint32_t i);
    [[nodiscard]] std::uint32_t next_corner(std::uint32_t from);
    void emit(std::uint32_t at);
    void cut(std::uint32_t at);

    const std::vector<Vec2>& flat_;
    std::vector<Corner> corners_;
    OrderedBits ears_, straight_, convex_;  ///< convex: not turning right
    std::optional<PointTree> reflex_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::size_t left_;                           ///< corners not yet cut off
    std::size_t rebuild_at_ = 0, renew_at_ = 0;  ///< thresholds of `left_`
    std::uint64_t spent_ = 0;                    ///< tests of earlier trees
};

}  // namespace alhazen

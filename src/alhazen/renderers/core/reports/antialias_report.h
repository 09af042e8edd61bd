#pragma once
/// Statistics of adaptive supersampling.

#include <cstdint>
#include <vector>

namespace alhazen {

/// An object that no ray hit, though it may be visible.
struct UnmetObject {
    std::uint32_t part = 0;      ///< its number; of an object of many parts, that of the first
    std::uint32_t instance = 0;  ///< number of the part that placed it in the scene
    std::uint32_t x = 0, y = 0;  ///< a pixel of the frame where it was searched for
    friend auto operator<=>(const UnmetObject&, const UnmetObject&) = default;
};

struct AntialiasReport {
    /// Largest size of `unmet`.
    static constexpr std::size_t kNamed = 64;

    std::uint64_t pixels = 0;
    std::vector<std::uint64_t> points;   ///< [level] rays through new points of the grid
    std::vector<std::uint64_t> divided;  ///< [level] cells of that level that were divided

    bool guarantee = false;         ///< objects were searched for; else the fields below are 0
    std::uint64_t objects = 0;      ///< visible to eye rays
    std::uint64_t unbounded = 0;    ///< of these, without a bounding sphere: planes and the like
    std::uint64_t met = 0;          ///< objects that some eye ray hit
    std::uint64_t searching = 0;    ///< eye rays of the search, which are not shaded
    std::uint64_t sought = 0;       ///< unhit objects that may hide between corner rays
    std::uint64_t below_depth = 0;  ///< of these, not hit down to the largest depth
    std::uint64_t below_depth_pixels = 0;  ///< in which these were searched for
    std::vector<UnmetObject> unmet;        ///< the first of these
    /// Bounded objects that were neither hit nor searched for: outside the picture, or behind
    /// something nearer at all corners of their pixels.
    std::uint64_t passed_over = 0;
    double seconds = 0;  ///< to collect the objects and to search

    /// Shaded rays.
    [[nodiscard]] std::uint64_t total_points() const {
        std::uint64_t total = 0;
        for (const std::uint64_t n : points) total += n;
        return total;
    }
    [[nodiscard]] std::uint64_t eye_rays() const { return total_points() + searching; }
};

}  // namespace alhazen

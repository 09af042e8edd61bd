#pragma once
/// What adaptive supersampling reports besides the picture.

#include <cstdint>
#include <vector>

namespace alhazen {

/// An object that no ray met, though it may be seen.
struct UnmetObject {
    std::uint32_t part = 0;      ///< its number; of an object of many parts, that of the first
    std::uint32_t instance = 0;  ///< number of the part that placed it in the scene
    std::uint32_t x = 0, y = 0;  ///< a pixel of the frame where it was looked for
    friend auto operator<=>(const UnmetObject&, const UnmetObject&) = default;
};

struct AntialiasReport {
    /// How many of the objects below the depth are named.
    static constexpr std::size_t kNamed = 64;

    std::uint64_t pixels = 0;
    std::vector<std::uint64_t> points;   ///< [level] rays through new points of the grid
    std::vector<std::uint64_t> divided;  ///< [level] cells of that level that were divided

    bool guarantee = false;       ///< the rest is filled in
    std::uint64_t objects = 0;    ///< with a sphere
    std::uint64_t unbounded = 0;  ///< without one: planes and other endless shapes
    std::uint64_t met = 0;        ///< objects that some eye ray met
    std::uint64_t searching = 0;  ///< eye rays without a shade, besides `points`
    std::uint64_t sought = 0;     ///< objects whose sphere a ray met before anything met the object
    std::uint64_t below_depth = 0;         ///< of these, the ones that none met down to the depth
    std::uint64_t below_depth_pixels = 0;  ///< where they were looked for
    std::vector<UnmetObject> unmet;        ///< the first of these
    /// Objects with a sphere that none met and that were not looked for: outside of the picture, or
    /// behind something nearer at all corners of their pixels.
    std::uint64_t passed_over = 0;
    double seconds = 0;  ///< for the spheres: collecting, and asking the tree

    /// Rays with a shade; those of the search are besides.
    [[nodiscard]] std::uint64_t total_points() const {
        std::uint64_t total = 0;
        for (const std::uint64_t n : points) total += n;
        return total;
    }
    [[nodiscard]] std::uint64_t eye_rays() const { return total_points() + searching; }
};

}  // namespace alhazen

#pragma once
/// A latitude-longitude picture of all directions, sampled in proportion to its brightness.
///
/// Source: Blinn and Newell, "Texture and Reflection in Computer Generated Images", CACM 19(10),
/// 1976; Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th ed., section 12.5.
/// Differs: within a texel directions are uniform by solid angle, so that the density is finite at
/// the poles; the weight of a texel is the mean of the interpolated picture over it, so that the
/// density is above 0 wherever the picture is not black. Searches begin at guides (Chen and Asau,
/// "On Generating Random Variates from an Empirical Distribution", AIIE Transactions 6(2), 1974)
/// and continue by bisection.
/// Conventions: in the frame of the picture x points to its right, y to its front, which is the
/// centre of the picture, z up. The top row is at the zenith. Texels are interpolated in both
/// directions, around the picture but not across its poles. Texels that are negative, infinite, NaN
/// or above kLargestRadiance are black, and counted.
/// Complexity: construction O(texels), sampling O(log texels). Threads: const functions may be
/// called concurrently.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/imaging/image/image.h"
#include "alhazen/math/vec.h"

namespace alhazen {

inline constexpr double kLargestRadiance = 1e15;

class DirectionPicture {
  public:
    /// The picture must have a texel. If it is not linear, it is decoded from sRGB.
    explicit DirectionPicture(Image picture);

    [[nodiscard]] Rgb radiance(const Vec3& direction) const;
    /// Samples a unit direction; `u` in [0, 1)^2. Precondition: the picture is not black.
    [[nodiscard]] Vec3 sample(const Vec2& u) const;
    /// `sample` in steps, each of which prefetches what the next one reads: `begin`, `approach`,
    /// `find`, `direction`. Several samples that take turns do not wait for the memory.
    struct Search {
        Vec2 u;
        std::size_t row = 0, column = 0;
        double share_y = 0;  ///< of the row's height, above the direction
    };
    [[nodiscard]] Search begin(const Vec2& u) const;
    void approach(const Search& search) const;
    /// Finds the texel; prefetches what `sight` reads.
    void find(Search& search) const;
    [[nodiscard]] Vec3 direction(const Search& search) const;
    /// `direction` of each search.
    void find_directions(std::span<const Search> searches, Vec3* directions) const;
    /// Density of `sample` by solid angle.
    [[nodiscard]] double density(const Vec3& direction) const;
    /// Radiance and density of a direction.
    struct Sight {
        Rgb radiance;
        double density = 0;
    };
    [[nodiscard]] Sight sight(const Vec3& direction) const;
    /// `sight` of each direction.
    void find_sights(std::span<const Vec3> directions, Sight* sights) const;

    /// Mean radiance over all directions.
    [[nodiscard]] const Rgb& mean() const { return mean_; }
    [[nodiscard]] bool is_black() const { return !(rows_.back() > 0.0); }
    [[nodiscard]] std::size_t bad_texels() const { return bad_texels_; }

  private:
    /// A direction in fractions of the picture's width and height.
    struct Place {
        double column, row;
    };
    [[nodiscard]] static Place place_of(const Vec3& direction);
    /// The row of `share`, and the beginning of the search in that row.
    [[nodiscard]] std::size_t row_for(double share) const;
    [[nodiscard]] const std::uint32_t* guide_for(const Search& search) const;
    [[nodiscard]] double height_of(const Search& search) const;
    /// In fractions of the picture.
    [[nodiscard]] double column_at(const Search& search) const;
    /// Prefetches what `radiance_at` and `density_at` read.
    void fetch(const Place& place) const;
    /// The cumulative shares of a row.
    [[nodiscard]] std::span<const float> shares_of(std::size_t row) const {
        const std::size_t count = std::size_t(picture_.width) + 1;
        return std::span(columns_).subspan(row * count, count);
    }
    [[nodiscard]] Rgb radiance_at(const Place& place) const;
    [[nodiscard]] double density_at(const Place& place) const;
    void blacken_bad_texels();
    void make_distribution();
    void make_guides();
    /// `x` may lie up to a picture's width outside.
    [[nodiscard]] Rgb texel(int x, int y) const;
    /// Cosine to the zenith of a row border.
    [[nodiscard]] double height(int border) const { return heights_[std::size_t(border)]; }

    Image picture_;
    std::vector<double> heights_;  ///< [row + 1] of its upper border
    std::vector<double> rows_;     ///< [row + 1] weight of all rows above
    std::vector<float> columns_;   ///< [row][column + 1] cumulative share within the row
    // Lower bounds of the search for a share: [part of 1].
    std::vector<std::uint32_t> row_guide_;
    std::vector<std::uint32_t> column_guides_;  ///< [row][part of 1]
    std::size_t row_parts_ = 1, column_parts_ = 1;
    Rgb mean_;
    std::size_t bad_texels_ = 0;
};

}  // namespace alhazen

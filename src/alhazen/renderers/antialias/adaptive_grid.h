#pragma once
/// Whitted's adaptive supersampling without the rays: selects the points of the picture that need a
/// shade, and computes the pixels.
///
/// Rays pass through the corners of the pixels. If the four shades of a cell differ too much, the
/// midpoints of its sides and its centre are added and its four quarters are treated alike. A pixel
/// is the mean of the shades, weighted by area.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980, section
/// "Treatment of Aliasing"; Foley, van Dam, Feiner and Hughes, "Computer Graphics", 2nd ed., 1990,
/// section 15.10.4 (the example with the rays A to P).
/// Differs, each by a setting: a difference is weighted by the area of its cell, as the shades are
/// in the pixel (`weigh`); a cell is also divided if shades on its sides that neighbours have
/// computed differ, and a pixel next to a divided one adds its centre (`neighbours`). All cells are
/// refined together, in rounds, so that every ray is shared between all cells, also across pixels.
/// Conventions: cells of level k have integer coordinates in units of 2^-k pixels from the top left
/// corner of the crop, y down; points in units of 2^-depth. The order of the points is spatially
/// coherent. Shades that are not finite are left out of the mean of a cell.
/// Complexity: linear in the number of points, which are all kept.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/renderers/antialias/number_table.h"
#include "alhazen/renderers/core/antialias_settings.h"

namespace alhazen {

struct GridPoint {
    std::int32_t x, y;
};

/// A key of NumberTable for a cell of a level, or for a point (level 0).
[[nodiscard]] inline std::uint64_t grid_key(int level, GridPoint p) {
    // Pictures have sides of at most 2^16 pixels, and depths are at most 8.
    static_assert(AntialiasSettings::kDeepest <= 8);
    return std::uint64_t(level) << 56 | std::uint64_t(std::uint32_t(p.y)) << 28 |
           std::uint32_t(p.x);
}

/// Objects that no shaded ray has hit so far, and the rays that pass close to them.
class ObjectWatch {
  public:
    virtual ~ObjectWatch() = default;
    /// True if no shaded ray has hit the object.
    [[nodiscard]] virtual bool is_sought(std::uint32_t object) const = 0;
    /// True if a part of the object may be visible in the cell, no corner of which shows anything
    /// farther away than `farthest`.
    [[nodiscard]] virtual bool may_hide(std::uint32_t object, int level, GridPoint cell,
                                        double farthest) const = 0;
    /// True if the object is smaller than a cell of the level.
    [[nodiscard]] virtual bool is_smaller(std::uint32_t object, int level) const = 0;
};

/// An object sought in a pixel; pixels are numbered row by row.
struct WatchedObject {
    std::uint32_t pixel, object;
    friend auto operator<=>(const WatchedObject&, const WatchedObject&) = default;
};

class AdaptiveGrid {
  public:
    static constexpr std::size_t kMostPoints = 0x7FFFFFFF;

    /// Throws Error (Resource) if a crop has too many pixels.
    AdaptiveGrid(int width, int height, const AntialiasSettings& settings);

    [[nodiscard]] std::uint32_t width() const { return static_cast<std::uint32_t>(width_); }
    [[nodiscard]] std::uint32_t height() const { return static_cast<std::uint32_t>(height_); }
    /// Points are in units of 2^-depth pixels.
    [[nodiscard]] int depth() const { return settings_.depth; }
    /// The points of this round, none of which was in an earlier one; in the first round all
    /// corners.
    [[nodiscard]] std::span<const GridPoint> points() const { return points_; }
    /// Output of the caller: the shades of these points, and the distances of their hits.
    [[nodiscard]] std::span<Rgb> shades() { return std::span(shades_).subspan(first_); }
    [[nodiscard]] std::span<double> distances() { return std::span(distances_).subspan(first_); }
    /// First round only: index of the point of a corner, [0, width] x [0, height].
    [[nodiscard]] std::uint32_t corner_index(int x, int y) const;
    /// First round only: the largest distance at the corners of a pixel.
    [[nodiscard]] double farthest_of_pixel(int x, int y) const;

    /// First round only: sets objects that rays through points of the grid are known to hit, and
    /// that the pixels must show; sorted, without duplicates.
    void look_for(std::span<const WatchedObject> objects);
    /// Ends the round. False if no cell is divided further; the pixels are then complete. `watch`
    /// is null if no objects are sought.
    bool refine(const ObjectWatch* watch);

    /// [row][column]
    [[nodiscard]] std::span<const Rgb> pixels() const { return pixels_; }
    /// Number of points first needed by each pixel, [row][column].
    [[nodiscard]] std::span<const std::uint32_t> points_of_pixels() const { return asked_; }
    /// [level] number of points with odd coordinates in units of its cells (level 0: corners), and
    /// number of divided cells.
    [[nodiscard]] std::span<const std::uint64_t> points_of_levels() const { return added_; }
    [[nodiscard]] std::span<const std::uint64_t> divided() const { return divided_; }

  private:
    struct Cell {
        GridPoint at;              ///< its top left corner
        std::uint32_t corners[4];  ///< samples: top left, top right, bottom left, bottom right
        std::uint32_t pixel;
        std::uint32_t first_watched, watched;  ///< range in `watched_`
        std::uint8_t level;
        bool is_divided = false;  ///< divided after it had ended
        bool is_woken = false;
    };
    class Range;

    void add_corners();
    [[nodiscard]] std::uint32_t sample_at(GridPoint p) const;
    std::uint32_t add_point(GridPoint p, int level, std::uint32_t pixel);
    void choose(const ObjectWatch* watch);
    [[nodiscard]] bool differs(const Cell& cell, bool weigh) const;
    void include_side(Range& range, GridPoint a, GridPoint b) const;
    /// Collects the objects sought in a cell. True: differences are not weighted.
    bool keep_near(const Cell& cell, const ObjectWatch& watch);
    void end(const Cell& cell);
    void add_to_pixel(const Cell& cell);
    void divide(const Cell& cell);
    void wake_beside(const Cell& cell);
    void look_at_centres_around(const Cell& cell);
    [[nodiscard]] std::uint32_t ended_at(int level, GridPoint at) const;
    void wake(std::uint32_t ended);

    AntialiasSettings settings_;
    int width_, height_;
    std::size_t first_ = 0;  ///< first sample of this round
    std::vector<GridPoint> points_;
    std::vector<Rgb> shades_;
    std::vector<double> distances_;
    NumberTable samples_;                         ///< all points except the corners of pixels
    std::vector<Cell> open_, split_, next_open_;  ///< to be tested, to be divided
    std::vector<Cell> ended_;                     ///< kept if neighbours count
    NumberTable ended_cells_;                     ///< by level and place, except level 0:
    std::vector<std::uint32_t> ended_pixels_;
    std::vector<std::uint32_t> woken_;  ///< ended cells whose neighbours have new points
    std::vector<std::uint32_t> watched_, next_watched_;  ///< objects, by cell
    std::vector<std::uint32_t> live_, near_;             ///< objects in the current cell
    std::vector<Rgb> pixels_;
    std::vector<std::uint32_t> asked_;
    std::vector<std::uint64_t> added_, divided_;
};

}  // namespace alhazen

#pragma once
/// Whitted's adaptive supersampling, without the rays: which points of the picture need a shade,
/// and what the pixels are.
///
/// Rays pass through the corners of the pixels. Where the four shades of a cell differ too much,
/// the midpoints of its sides and its centre are added and its four quarters treated alike. A pixel
/// is the mean of the shades, weighted by area.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980, section
/// "Treatment of Aliasing"; Foley, van Dam, Feiner and Hughes, "Computer Graphics", 2nd ed., 1990,
/// section 15.10.4 (the example with the rays A to P).
/// Differs: all cells of a level are refined together. A new point of a level is a midpoint or a
/// centre of cells of that level alone, so that one table per level shares every ray between all
/// its cells, across pixels too.
/// Conventions: points and cells of level k have whole coordinates in units of 2^-k pixels from the
/// top left corner of the crop, y down. The order of the points keeps neighbours together. Where a
/// shade is not finite, the mean of a cell is that of the others.
/// Complexity: linear in the number of points, which are all kept.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/renderers/core/antialias_settings.h"

namespace alhazen {

class PointTable;

struct GridPoint {
    std::int32_t x, y;
};

/// Objects that no ray has met so far, and the rays that pass close to them.
class ObjectWatch {
  public:
    virtual ~ObjectWatch() = default;
    /// No ray of this or an earlier level has met it.
    [[nodiscard]] virtual bool is_sought(std::uint32_t object) const = 0;
    /// The ray through the point meets the sphere around the object, as large as this level needs
    /// it, in front of `distance`: that of the surface it meets.
    [[nodiscard]] virtual bool passes(std::uint32_t object, int level, GridPoint point,
                                      double distance) const = 0;
};

/// An object looked for in a pixel; the pixel counts row by row.
struct WatchedObject {
    std::uint32_t pixel, object;
    friend auto operator<=>(const WatchedObject&, const WatchedObject&) = default;
};

class AdaptiveGrid {
  public:
    /// Throws Error (Resource) where a crop has too many pixels.
    AdaptiveGrid(int width, int height, const AntialiasSettings& settings);

    [[nodiscard]] int level() const { return level_; }
    /// The points of this level, none of which was in an earlier one; at level 0 all corners.
    [[nodiscard]] std::span<const GridPoint> points() const { return points_; }
    /// To be filled in: the shades of these points, and the distances of what they show.
    [[nodiscard]] std::span<Rgb> shades() { return std::span(shades_).subspan(first_); }
    [[nodiscard]] std::span<double> distances() { return std::span(distances_).subspan(first_); }

    /// At level 0: the objects to look for; sorted, each pair once.
    void look_for(std::span<const WatchedObject> objects);
    /// Ends the level. False: no cell is divided further, and the pixels are complete. `watch`:
    /// null without objects to look for.
    bool refine(const ObjectWatch* watch);

    /// [row][column]
    [[nodiscard]] std::span<const Rgb> pixels() const { return pixels_; }
    /// What was still sought in a pixel at the last level; sorted, each pair once.
    [[nodiscard]] std::span<const WatchedObject> below_depth() const { return below_depth_; }
    /// Points that were first needed by this pixel, [row][column].
    [[nodiscard]] std::span<const std::uint32_t> points_of_pixels() const { return asked_; }
    /// Cells divided at the levels so far.
    [[nodiscard]] std::span<const std::uint64_t> divided() const { return divided_; }

  private:
    struct Cell {
        GridPoint at;              ///< its top left corner
        std::uint32_t corners[4];  ///< samples: top left, top right, bottom ...
        std::uint32_t pixel;
        std::uint32_t first_watched, watched;  ///< range in `watched_`
    };

    void add_corners();
    [[nodiscard]] std::uint32_t corner_index(int x, int y) const;
    [[nodiscard]] bool differs(const Cell& cell) const;
    void keep_live(const Cell& cell, const ObjectWatch& watch);
    void add_to_pixel(const Cell& cell);
    void divide(const Cell& cell, PointTable& table);

    AntialiasSettings settings_;
    int width_, height_;
    int level_ = 0;
    std::size_t first_ = 0;  ///< sample of this level
    std::vector<GridPoint> points_;
    std::vector<Rgb> shades_;
    std::vector<double> distances_;
    std::vector<Cell> cells_, next_cells_;
    std::vector<std::uint32_t> watched_, next_watched_;  ///< objects, by cell
    std::vector<std::uint32_t> live_;                    ///< of the cell at hand
    std::vector<Rgb> pixels_;
    std::vector<std::uint32_t> asked_;
    std::vector<std::uint64_t> divided_;
    std::vector<WatchedObject> below_depth_;
};

}  // namespace alhazen

#pragma once
/// Searches between the corners of the pixels for the objects that no corner ray has hit, by rays
/// that are intersected but not shaded.
///
/// A cell is divided, down to the depth, if an object that no ray has hit may hide in it
/// (search_spheres.h). Cells are processed level by level.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980, section
/// "Treatment of Aliasing".
/// Differs: a ray is shaded, and secondary rays are traced, only if the picture turns out to need
/// it: an object hidden along an edge costs only eye rays.
/// Conventions: cells and points are those of adaptive_grid.h.
/// Complexity: linear in the number of rays, which are all kept.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/renderers/antialias/adaptive_grid.h"
#include "alhazen/renderers/antialias/answer_pool.h"
#include "alhazen/renderers/antialias/hit_store.h"
#include "alhazen/renderers/antialias/number_table.h"
#include "alhazen/renderers/antialias/picture_grid.h"
#include "alhazen/renderers/antialias/scene_objects.h"
#include "alhazen/renderers/antialias/search_spheres.h"

namespace alhazen {

class ObjectSearch {
  public:
    static constexpr std::uint32_t kNone = NumberTable::kNone;

    struct Where {
        const SceneObjects& objects;
        const SearchSpheres& spheres;
        const PictureGrid& picture;
        AdaptiveGrid& grid;  ///< in its first round, with the distances of all corners
    };
    /// `met`: [object] 1 if a corner ray hit it. `sought`: from SearchSpheres::around.
    ObjectSearch(const Where& where, std::vector<std::uint8_t> met,
                 std::span<const WatchedObject> sought);

    /// Traces rays until each object is hit or the depth is reached; returns early after a stop of
    /// the job.
    void run(AnswerPool& pool, const RenderJob& job);

    [[nodiscard]] bool has_met(std::uint32_t object) const { return met_[object] != 0; }
    /// Objects still sought in a pixel at the depth; sorted, without duplicates.
    [[nodiscard]] std::span<const WatchedObject> below_depth() const { return below_depth_; }

    /// The ray through a point in units of 2^-depth; kNone if none was traced.
    [[nodiscard]] std::uint32_t ray_at(GridPoint p) const { return rays_.find(grid_key(0, p)); }
    [[nodiscard]] Hit hit(std::uint32_t ray) const { return hits_.get(ray); }
    /// Marks a ray as shaded: it is counted by the grid.
    void hand_over(std::uint32_t ray) { pixels_[ray] = kNone; }
    /// [ray] the pixel for which it was traced; kNone if handed over.
    [[nodiscard]] std::span<const std::uint32_t> pixels() const { return pixels_; }

  private:
    struct Cell {
        GridPoint at;
        std::uint32_t corners[4];  ///< indices in the grid, followed by those in `distances_`
        std::uint32_t pixel;
        std::uint32_t first_sought, sought;  ///< range in `sought_`
    };

    void choose(int level);
    void divide(const Cell& cell, int level);
    [[nodiscard]] double distance(std::uint32_t corner) const {
        return corner < corners_ ? where_.grid.distances()[corner] : distances_[corner - corners_];
    }
    void trace(AnswerPool& pool);

    Where where_;
    std::uint32_t corners_;  ///< number of the grid's corners
    std::vector<std::uint8_t> met_;
    std::vector<Cell> cells_, next_cells_;
    std::vector<std::uint32_t> sought_, next_sought_;  ///< objects, by cell
    std::vector<GridPoint> points_;                    ///< points of this level
    NumberTable rays_;
    std::vector<double> distances_;      ///< [ray]
    std::vector<std::uint32_t> pixels_;  ///< [ray]
    HitStore hits_;                      ///< [ray]
    std::vector<WatchedObject> below_depth_;
};

}  // namespace alhazen

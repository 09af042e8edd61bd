#pragma once
/// For every light a cube of directions whose cells list what may stand in the light's way.
///
/// Source: Haines and Greenberg, "The Light Buffer: A Shadow-Testing Accelerator", IEEE CG&A 6(9),
/// 1986; Pearce, "A Recursive Shadow Voxel Cache for Ray Tracing", Graphics Gems II, 1991 (the last
/// occluder).
/// Differs: lists are made from half-spaces around the rows and columns of a face and, for
/// triangles, their edges, not by scan conversion. A ray is a shadow ray when it asks what blocks
/// the light and ends at a light that the scene names; there is no mark on it. Only triangles are
/// looked at as what fills a cell. There is one last occluder for each light and thread, not for
/// each node of the tree of rays. Directional lights have no buffer: their rays, and all rays that
/// are no shadow rays, are traced by another accelerator (`others`).
/// Conventions: lists are ascending by the distance at which a primitive begins, from the light. A
/// list ends at the triangle that fills its cell: nothing behind that is lit.
/// Complexity and threads: lists are made while building, O(n resolution) and more where primitives
/// are large. What is tested depends on the rays before, by the last occluder; hits do not.

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "alhazen/accel/bounded_bodies.h"
#include "alhazen/accel/direction_cube.h"
#include "alhazen/accel/other_rays.h"
#include "alhazen/accel/ray_end_finder.h"

namespace alhazen {

/// Of each light the primitive that blocked the last ray to it that was blocked, for one thread. An
/// entry may be taken by another light; what it says is only a guess.
class LastOccluders {
  public:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
    [[nodiscard]] static std::uint32_t& of(std::uint64_t buffer, std::size_t light);
    /// Of a new buffer, never used again.
    [[nodiscard]] static std::uint64_t new_number();
};

class LightBuffer {
  public:
    static constexpr const char* kName = "light_buffer";
    static constexpr const char* kDescription =
        "lists of what stands in a light's way, for shadow rays";
    static constexpr bool kVisitsRepeatedly = true;
    struct Config {
        int resolution = 32;       ///< of a face of the cube
        int lights = 16;           ///< so many get a buffer
        bool full_cells = true;    ///< lists end behind what fills their cell
        bool shadow_cache = true;  ///< the last occluder is tested first
        OtherRays::Kind others = OtherRays::Kind::Hierarchy;
    };
    [[nodiscard]] static Config configure(SettingsReader& reader);

    /// Throws Error(Resource) for more than 2^32 entries in the lists.
    [[nodiscard]] static LightBuffer build(const BoundsSource& source, const Config& config);

    struct Cell {
        std::uint32_t first = 0;  ///< of its entries, in those of all lights
        std::uint32_t count = 0;
        std::uint32_t lit = 0;  ///< entries up to the end of what fills the cell
        /// Where that begins and ends, from the light; what fills no cell begins at infinity.
        double filled_from = std::numeric_limits<double>::infinity();
        double filled_to = std::numeric_limits<double>::infinity();
    };
    /// [light * cube cells + cell]
    [[nodiscard]] const std::vector<Cell>& cells() const { return cells_; }
    [[nodiscard]] const std::vector<std::uint32_t>& entries() const { return entries_; }
    [[nodiscard]] std::size_t lights() const { return ends_.places().size(); }
    [[nodiscard]] const DirectionCube& cube() const { return cube_; }

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
        constexpr AsksFor kAsked = asks_for<Visitor>();
        if constexpr (kAsked == AsksFor::AnyHit || kAsked == AsksFor::AnyBlocker) {
            if (space_.covers(ray)) {
                if (const auto found = ends_.find(ray)) return shadow(ray, *found, visitor, stats);
            }
        }
        others_.traverse(ray, visitor, stats);
    }

    [[nodiscard]] std::size_t memory_bytes() const {
        return others_.memory_bytes() + cells_.capacity() * sizeof(Cell) +
               entries_.capacity() * (sizeof(std::uint32_t) + sizeof(double));
    }

  private:
    friend class LightBufferBuilder;

    template <class Visitor, class Stats>
    void shadow(const Ray& ray, const RayEndFinder::Found& to, Visitor& visitor,
                Stats stats) const {
        const Cell& cell = cells_[to.end * cube_.size() + cube_.cell_of(-ray.direction)];
        stats.nodes(1);
        if (cell.count == 0) stats.empty_cells(1);
        std::uint32_t tested = LastOccluders::kNone;
        std::uint32_t* last = nullptr;
        if (config_.shadow_cache && cell.count > 0) {
            last = &LastOccluders::of(number_, to.end);
            tested = *last;
            const bool blocked = tested != LastOccluders::kNone && visitor.visit(tested);
            stats.cache_lookup(blocked);
            if (blocked) return;
        }
        // The ray begins behind what fills the cell, and ends before it.
        const bool cut = to.start > cell.filled_to && to.stop < cell.filled_from;
        const std::uint32_t end = cell.first + (cut ? cell.lit : cell.count);
        for (std::uint32_t e = cell.first; e < end; ++e) {
            // What begins farther from the light than the ray does not stand in its way.
            if (begins_[e] > to.start) return;
            if (entries_[e] == tested) continue;
            if (visitor.visit(entries_[e])) {
                // A visit may have gone through other aggregates, and asked for theirs.
                if (last != nullptr) LastOccluders::of(number_, to.end) = entries_[e];
                return;
            }
        }
    }

    Config config_;
    PaddedBox space_;
    RayEndFinder ends_;
    DirectionCube cube_;
    OtherRays others_;
    std::uint64_t number_ = 0;
    std::vector<Cell> cells_;
    std::vector<std::uint32_t> entries_;
    std::vector<double> begins_;  ///< [entry] from where on it may be, seen from the light
};
static_assert(Accelerator<LightBuffer>);

}  // namespace alhazen

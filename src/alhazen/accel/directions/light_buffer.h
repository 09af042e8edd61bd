#pragma once
/// For every light a cube of directions whose cells list what may stand in the light's way.
///
/// Source: Haines and Greenberg, "The Light Buffer: A Shadow-Testing Accelerator", IEEE CG&A 6(9),
/// 1986; Pearce, "A Recursive Shadow Voxel Cache for Ray Tracing", Graphics Gems II, 1991 (the last
/// occluder).
/// Differs: of a face only the rectangle that the scene is seen in is divided, into cells by the
/// number of primitives, and the one that all but the largest are seen in once more. Lists are made
/// from half-spaces around the rows, columns and diagonals of a face and, for flat polygons, their
/// edges, not by scan conversion. A ray is a shadow ray when it asks what blocks the light and ends
/// at a light that the scene names; there is no mark on it. Only flat convex polygons are looked at
/// as what fills a cell. There is one last occluder for each light and thread, not for each node of
/// the tree of rays. Directional lights have no buffer: their rays, and all rays that are no shadow
/// rays, are traced by another accelerator (`others`). Conventions: lists are ascending by the
/// distance at which a primitive begins in the cell, from the light. A list ends at the polygon
/// that fills its cell: nothing behind that is lit. Complexity and threads: lists are made while
/// building, O(n + cells) for each light, and more where primitives are large. What is tested
/// depends on the rays before, by the last occluder; hits do not.

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "alhazen/accel/core/bounding_proxies.h"
#include "alhazen/accel/directions/direction_windows.h"
#include "alhazen/accel/directions/fallback_accelerator.h"
#include "alhazen/accel/directions/ray_end_finder.h"

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
        double density = 16;       ///< cells of a light for each primitive
        int resolution = 0;        ///< cells along the longest edge; 0: by the density
        int lights = 16;           ///< so many get a buffer
        bool full_cells = true;    ///< lists end behind what fills their cell
        bool shadow_cache = true;  ///< the last occluder is tested first
        FallbackAccelerator::Kind others = FallbackAccelerator::Kind::Hierarchy;
    };
    [[nodiscard]] static Config configure(SettingsReader& reader);

    /// Throws Error(Resource) for more than 2^32 entries in the lists.
    [[nodiscard]] static LightBuffer build(const BoundsSource& source, const Config& config);

    struct Cell {
        std::uint32_t first = 0;  ///< of its entries, in those of all lights
        std::uint32_t count = 0;
        std::uint32_t filler = LastOccluders::kNone;  ///< the primitive that fills it
        /// Where that begins and ends, from the light; what fills no cell begins at infinity.
        double filled_from = std::numeric_limits<double>::infinity();
        double filled_to = std::numeric_limits<double>::infinity();
    };
    /// Where small primitives are seen there are windows for them, with cells of their own: large
    /// ones would leave them few.
    struct Light {
        struct Windows {
            DirectionWindows directions;
            std::size_t first_cell = 0;
        };
        Windows small, all;
    };
    [[nodiscard]] const std::vector<Light>& lights() const { return lights_; }
    /// [first cell of the windows + cell]
    [[nodiscard]] const std::vector<Cell>& cells() const { return cells_; }
    [[nodiscard]] const std::vector<std::uint32_t>& entries() const { return entries_; }

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
        if (space_.covers(ray)) {
            if (const auto to = ends_.find_for<Visitor>(ray)) {
                return shadow(ray, *to, visitor, stats);
            }
        }
        others_.traverse(ray, visitor, stats);
    }

    [[nodiscard]] std::size_t memory_bytes() const {
        return others_.memory_bytes() + lights_.capacity() * sizeof(Light) +
               cells_.capacity() * sizeof(Cell) +
               entries_.capacity() * (sizeof(std::uint32_t) + sizeof(double));
    }

  private:
    friend class LightBufferBuilder;

    /// Null where nothing is seen.
    [[nodiscard]] const Cell* cell_of(const Light& light, const Vec3& direction) const {
        for (const Light::Windows* windows : {&light.small, &light.all}) {
            const std::size_t cell = windows->directions.cell_of(direction);
            if (cell != DirectionWindows::kNone) return &cells_[windows->first_cell + cell];
        }
        return nullptr;
    }

    template <class Visitor, class Stats>
    void shadow(const Ray& ray, const RayEndFinder::Found& to, Visitor& visitor,
                Stats stats) const {
        stats.nodes(1);
        const Cell* looked_up = cell_of(lights_[to.end], -ray.direction);
        if (looked_up == nullptr || looked_up->count == 0) return stats.empty_cells(1);
        const Cell& cell = *looked_up;
        std::uint32_t tested = LastOccluders::kNone;
        if (config_.shadow_cache) {
            tested = LastOccluders::of(number_, to.end);
            const bool blocked = tested != LastOccluders::kNone && visitor.visit(tested);
            stats.cache_lookup(blocked);
            if (blocked) return;
        }
        const auto blocks = [&](std::uint32_t primitive) {
            if (primitive == tested || !visitor.visit(primitive)) return false;
            // A visit may have gone through other aggregates, and asked for theirs.
            if (config_.shadow_cache) LastOccluders::of(number_, to.end) = primitive;
            return true;
        };
        if (to.start > cell.filled_to) {
            // The ray begins behind what fills the cell; one that ends behind it, too, needs what
            // the list does not have.
            if (to.stop < cell.filled_from && blocks(cell.filler)) return;
            return others_.traverse(ray, visitor, stats);
        }
        for (std::uint32_t e = cell.first; e < cell.first + cell.count; ++e) {
            // What begins farther from the light than the ray does not stand in its way.
            if (begins_[e] > to.start || blocks(entries_[e])) return;
        }
    }

    Config config_;
    PaddedBox space_;
    RayEndFinder ends_;
    FallbackAccelerator others_;
    std::uint64_t number_ = 0;
    std::vector<Light> lights_;
    std::vector<Cell> cells_;
    std::vector<std::uint32_t> entries_;
    std::vector<double> begins_;  ///< [entry] from where on it may be, seen from the light
};
static_assert(Accelerator<LightBuffer>);

}  // namespace alhazen

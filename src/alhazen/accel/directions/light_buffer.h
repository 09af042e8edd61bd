#pragma once
/// Light buffers: a cube of directions around every light whose cells list the potential occluders.
///
/// Source: Haines and Greenberg, "The Light Buffer: A Shadow-Testing Accelerator", IEEE CG&A 6(9),
/// 1986; Pearce, "A Recursive Shadow Voxel Cache for Ray Tracing", Graphics Gems II, 1991 (the last
/// occluder).
/// Differs: divides only the rectangle of a face in which the scene is visible, into cells by the
/// number of primitives, and the rectangle of all but the largest primitives once more. Lists are
/// made from half-spaces around the rows, columns and diagonals of a face and, for flat polygons,
/// their edges, not by scan conversion. A ray is recognised as a shadow ray if its query is for
/// blocked light and it ends at a light of the scene; it carries no mark. Only flat convex polygons
/// can fill a cell. There is one last occluder per light and thread, not per node of the tree of
/// rays. Directional lights have no buffer: their rays, and all other rays, are traced by the
/// fallback accelerator (`others`).
/// Conventions: lists are ascending by the distance from the light at which a primitive begins in
/// the cell. A list ends at the polygon that fills its cell: nothing behind it is lit.
/// Complexity and threads: lists are made while building, O(n + cells) per light, and more for
/// large primitives. The tests made depend on earlier rays, by the last occluder; hits do not.

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "alhazen/accel/core/bounding_proxies.h"
#include "alhazen/accel/directions/direction_windows.h"
#include "alhazen/accel/directions/fallback_accelerator.h"
#include "alhazen/accel/directions/ray_end_finder.h"

namespace alhazen {

/// The primitive that last blocked a ray to each light, for one thread. Lights may share an entry,
/// whose content is only a guess.
class LastOccluders {
  public:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
    [[nodiscard]] static std::uint32_t& of(std::uint64_t buffer, std::size_t light);
    /// A unique number for a new buffer.
    [[nodiscard]] static std::uint64_t new_number();
};

class LightBuffer {
  public:
    static constexpr const char* kName = "light_buffer";
    static constexpr const char* kDescription =
        "lists of potential occluders per light, for shadow rays";
    static constexpr bool kVisitsRepeatedly = true;
    struct Config {
        double density = 16;       ///< cells of a light per primitive
        int resolution = 0;        ///< cells along the longest edge; 0: by the density
        int lights = 16;           ///< maximum number of lights with a buffer
        bool full_cells = true;    ///< end lists behind the polygon that fills their cell
        bool shadow_cache = true;  ///< test the last occluder first
        FallbackAccelerator::Kind others = FallbackAccelerator::Kind::Hierarchy;
    };
    [[nodiscard]] static Config configure(SettingsReader& reader);

    /// Throws Error(Resource) for more than 2^32 entries in the lists.
    [[nodiscard]] static LightBuffer build(const BoundsSource& source, const Config& config);

    struct Cell {
        std::uint32_t first = 0;  ///< index of its first entry, over all lights
        std::uint32_t count = 0;
        std::uint32_t filler = LastOccluders::kNone;  ///< the primitive that fills it
        /// The polygon's range of distances from the light; infinite if no polygon fills the cell.
        double filled_from = std::numeric_limits<double>::infinity();
        double filled_to = std::numeric_limits<double>::infinity();
    };
    /// Small primitives have separate windows with their own cells: otherwise large primitives
    /// would leave them few cells.
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
            if (const auto to = ends_.find_for(ray, visitor)) {
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

    /// Null if nothing is visible.
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
            // A visit may have traversed other aggregates, which use the same table.
            if (config_.shadow_cache) LastOccluders::of(number_, to.end) = primitive;
            return true;
        };
        if (to.start > cell.filled_to) {
            // The ray starts behind the filling polygon; if it also ends behind it, it needs
            // primitives that the list omits.
            if (to.stop < cell.filled_from && blocks(cell.filler)) return;
            return others_.traverse(ray, visitor, stats);
        }
        for (std::uint32_t e = cell.first; e < cell.first + cell.count; ++e) {
            // A primitive that begins farther from the light than the ray cannot block it.
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
    std::vector<double> begins_;  ///< [entry] its least distance from the light
};
static_assert(Accelerator<LightBuffer>);

}  // namespace alhazen

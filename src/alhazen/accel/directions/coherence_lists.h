#pragma once
/// Candidate lists by origin and direction: each sphere around a primitive, and each light, has
/// cells of directions with lists of the primitives that rays starting in the sphere may intersect.
///
/// Source: Ohta and Maekawa, "Ray Coherence Theorem and Constant Time Ray Tracing Algorithm",
/// Computer Graphics International 1987: a ray from a sphere of radius r1 intersects another one of
/// radius r2 at distance d only when its angle with the line between the centers is at most
/// asin((r1 + r2) / d).
/// Differs: see accel/directions/ray_coherence.h.
/// Conventions: origins are the primitives, then the lights. Lists are ascending by the least
/// distance between the two spheres.
/// Threads: `find` may be called concurrently; lists are independent of the order of calls, unless
/// memory runs out.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "alhazen/accel/cells/cell_grid.h"
#include "alhazen/accel/directions/direction_cube.h"
#include "alhazen/geometry/bounds_source.h"

namespace alhazen {

class CoherenceLists {
  public:
    struct Candidate {
        double begin;  ///< lower bound of the distance from a ray's start
        std::uint32_t primitive;
    };
    using List = std::vector<Candidate>;

    /// A cube of directions has `resolution` cells along an edge, 0: about two cells per primitive.
    /// Lights have four times as many: they are points, so their cones are thin. `margin`: how far
    /// rays may deviate; `most_bytes`: the memory limit of the lists.
    CoherenceLists(const BoundsSource& source, const std::vector<Vec3>& lights, double margin,
                   int resolution, std::size_t most_bytes);
    CoherenceLists(const CoherenceLists&) = delete;
    CoherenceLists& operator=(const CoherenceLists&) = delete;

    struct Origin {
        std::optional<std::uint32_t> primitive;  ///< empty if the point is in no sphere
        std::uint32_t tested = 0;                ///< number of spheres examined
    };
    /// The primitive with the smallest sphere that contains the point.
    [[nodiscard]] Origin origin_at(const Vec3& point) const;
    [[nodiscard]] std::uint32_t origin_of_light(std::size_t light) const {
        return static_cast<std::uint32_t>(primitives_ + light);
    }
    /// Null if no memory is left for the list.
    [[nodiscard]] const List* find(std::uint32_t origin, const Vec3& direction) const;

    [[nodiscard]] std::size_t memory_bytes() const { return used_; }

  private:
    using Slot = std::atomic<const List*>;
    /// Neighbouring cells of an origin: most are never used.
    using Block = std::array<Slot, 64>;
    using Blocks = std::atomic<Block*>;

    void sort_into_cells();
    [[nodiscard]] const DirectionCube& cube_of(std::uint32_t origin) const {
        return origin < primitives_ ? cube_ : light_cube_;
    }
    /// Null if no memory is left.
    [[nodiscard]] Slot* slot_of(std::uint32_t origin, std::size_t cell) const;
    template <class T>
    [[nodiscard]] T* made_at(std::atomic<T*>& place, std::size_t count,
                             std::vector<std::unique_ptr<T[]>>& made) const;
    [[nodiscard]] List make(std::uint32_t origin, std::size_t cell) const;

    std::vector<BoundingSphere> spheres_;  ///< [origin]
    std::size_t primitives_ = 0;
    double margin_;
    DirectionCube cube_, light_cube_;
    std::size_t most_bytes_;
    /// The spheres that may contain a point, by radius.
    CellGrid grid_;
    std::vector<std::uint32_t> starts_, entries_;

    mutable std::vector<std::atomic<Blocks*>> origins_;  ///< null, or blocks of all its cells
    mutable std::mutex making_;
    mutable std::vector<std::unique_ptr<Blocks[]>> made_origins_;
    mutable std::vector<std::unique_ptr<Block[]>> made_blocks_;
    mutable std::vector<std::unique_ptr<const List>> made_lists_;
    mutable std::atomic<std::size_t> used_{0};
    mutable std::atomic<bool> full_{false};  ///< memory is used up: no further lists are made
};

}  // namespace alhazen

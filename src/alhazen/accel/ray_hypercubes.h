#pragma once
/// The space of rays, divided: six trees of hypercubes, one for each dominant direction, made as
/// rays come. A hypercube has a list of what its rays may meet.
///
/// Source: Arvo and Kirk, "Fast Ray Tracing by Ray Classification", SIGGRAPH 1987.
/// Differs: stated in accel/ray_classification.h.
/// Conventions: direction 2 k is towards the upper end of axis k, 2 k + 1 towards the lower end.
/// With axes k, k + 1, k + 2 (in a circle) a ray is (x, y, z; u, v): its place and how far it goes
/// along the other two axes while it goes 1 along the dominant one.
/// Threads: `find` may be called from many; lists do not depend on who comes first, unless memory
/// runs out.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "alhazen/accel/bounded_bodies.h"
#include "alhazen/accel/padded_box.h"

namespace alhazen {

/// A ray as a point of five dimensions.
struct ClassifiedRay {
    int direction = 0;
    std::array<double, 5> point{};

    /// At `t`; the direction is not zero.
    ClassifiedRay(const Ray& ray, double t);
};

/// Ranges of the five coordinates.
struct Hypercube {
    std::array<double, 5> lo{}, hi{};

    [[nodiscard]] bool contains(const std::array<double, 5>& p) const {
        bool inside = true;
        for (std::size_t k = 0; k < 5; ++k) inside = inside && lo[k] <= p[k] && p[k] <= hi[k];
        return inside;
    }
    /// Bit k is set for the upper half of coordinate k.
    [[nodiscard]] std::uint32_t child_of(const std::array<double, 5>& p) const;
    [[nodiscard]] Hypercube child(std::uint32_t index) const;
};

class RayHypercubes {
  public:
    using List = std::vector<std::uint32_t>;
    struct Limits {
        std::size_t leaf_size = 8;
        int max_depth = 8;
        std::size_t memory_bytes = std::size_t{256} << 20;
    };

    RayHypercubes(const BoundsSource& source, const Limits& limits);
    RayHypercubes(const RayHypercubes&) = delete;
    RayHypercubes& operator=(const RayHypercubes&) = delete;

    struct Found {
        const List* list;  ///< ascending by where bodies begin along the direction
        int nodes;         ///< hypercubes that were entered on the way to it
        bool cached;       ///< found among those that the thread used last
    };
    /// Of a ray that begins in the space, or is off it by rounding.
    [[nodiscard]] Found find(ClassifiedRay ray) const;

    [[nodiscard]] const PaddedBox& space() const { return space_; }
    [[nodiscard]] const BoundedBodies& bodies() const { return bodies_; }
    /// Where a body begins along a direction, measured along it.
    [[nodiscard]] double begin_along(std::uint32_t body, int direction) const {
        const Box3& b = bodies_.box(body);
        return direction % 2 == 0 ? b.lo[direction / 2] : -b.hi[direction / 2];
    }
    /// Of bodies and of what has been made of the trees.
    [[nodiscard]] std::size_t memory_bytes() const { return bodies_.memory_bytes() + used_; }
    /// Hypercubes in all trees.
    [[nodiscard]] std::size_t nodes_made() const { return nodes_made_; }

  private:
    static constexpr std::size_t kChildren = 32;
    struct Node {
        std::atomic<const List*> list{nullptr};  ///< null: nobody has asked yet
        std::atomic<Node*> children{nullptr};    ///< kChildren, or null
    };
    struct Recent;

    [[nodiscard]] Hypercube root() const;
    /// What of `parent` the rays of a hypercube may meet, in the same order.
    [[nodiscard]] List meeting(const List& parent, int direction, const Hypercube& cube) const;
    /// Null when there is no memory left.
    [[nodiscard]] Node* children_of(Node& node) const;
    [[nodiscard]] const List* list_of(Node& child, const List& parent, int direction,
                                      const Hypercube& cube) const;

    PaddedBox space_;
    BoundedBodies bodies_;
    Limits limits_;
    std::uint64_t id_;  ///< of no other one, ever: what threads remember is asked for by it
    std::array<List, 6> everything_;
    mutable std::array<Node, 6> roots_;
    mutable std::mutex making_;
    mutable std::vector<std::unique_ptr<Node[]>> nodes_;
    mutable std::vector<std::unique_ptr<const List>> lists_;
    mutable std::atomic<std::size_t> used_{0}, nodes_made_{6};
};

}  // namespace alhazen

#pragma once
/// The space of rays, divided: six trees of hypercubes, one for each dominant direction, made as
/// rays come. A hypercube has a list of what its rays may meet.
///
/// Source: Arvo and Kirk, "Fast Ray Tracing by Ray Classification", SIGGRAPH 1987.
/// Differs: stated in accel/directions/ray_classification.h.
/// Conventions: direction 2 k is towards the upper end of axis k, 2 k + 1 towards the lower end.
/// With axes k, k + 1, k + 2 (in a circle) a ray is (x, y, z; u, v): its place and how far it goes
/// along the other two axes while it goes 1 along the dominant one.
/// Threads: `find` may be called from many; lists do not depend on who comes first, unless memory
/// runs out.

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "alhazen/accel/core/bounding_proxies.h"
#include "alhazen/accel/core/padded_box.h"

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
        const List* list;                  ///< ascending by where bodies begin along the direction
        int nodes;                         ///< hypercubes that were entered on the way to it
        bool cached;                       ///< found among those that the thread used last
        std::shared_ptr<const void> kept;  ///< the list lives as long as this
    };
    /// Of a ray that begins in the space, or is off it by rounding.
    /// What a thread found for closest hits and for any hit it remembers apart.
    [[nodiscard]] Found find(ClassifiedRay ray, bool any_hit = false) const;

    [[nodiscard]] const PaddedBox& space() const { return space_; }
    [[nodiscard]] const BoundingProxies& bodies() const { return bodies_; }
    /// Where a body begins along a direction, measured along it.
    [[nodiscard]] double begin_along(std::uint32_t body, int direction) const {
        const Box3& b = bodies_.box(body);
        return direction % 2 == 0 ? b.lo[direction / 2] : -b.hi[direction / 2];
    }
    /// Of bodies and of what has been made of the trees.
    [[nodiscard]] std::size_t memory_bytes() const {
        const std::shared_ptr<Trees> trees = std::atomic_load(&trees_);
        return bodies_.memory_bytes() + trees->used;
    }
    /// Hypercubes in all trees.
    [[nodiscard]] std::size_t nodes_made() const { return std::atomic_load(&trees_)->nodes_made; }

  private:
    /// Of the 32 children of a hypercube there are only those that rays have come to: few.
    struct Node {
        std::atomic<const List*> list{nullptr};  ///< null: nobody has asked yet
        std::atomic<Node*> first_child{nullptr};
        Node* next = nullptr;     ///< the sibling that was made before
        std::uint32_t index = 0;  ///< which child of its parent
    };
    struct Recent;
    struct Trees {
        explicit Trees(std::size_t bytes) : used(bytes) {}
        /// Of no other ones, ever: what threads remember is asked for by it.
        std::uint64_t id = new_id();
        std::array<Node, 6> roots;
        std::mutex making;
        std::deque<Node> nodes;
        std::vector<std::unique_ptr<const List>> lists;
        std::atomic<std::size_t> used, nodes_made{6};
    };
    [[nodiscard]] static std::uint64_t new_id();

    [[nodiscard]] Hypercube root() const;
    /// What of `parent` the rays of a hypercube may meet, in the same order.
    [[nodiscard]] List meeting(const List& parent, int direction, const Hypercube& cube) const;
    /// Null when there is no memory left.
    [[nodiscard]] Node* child_of(Trees& trees, Node& node, std::uint32_t index) const;
    [[nodiscard]] const List* list_of(Trees& trees, Node& child, const List& parent, int direction,
                                      const Hypercube& cube, bool last) const;
    struct Leaf {
        const List* list;
        Hypercube cube;
        int depth;
        bool whole;  ///< false where there was no memory left to divide further
    };
    [[nodiscard]] Leaf descend(Trees& trees, const ClassifiedRay& ray) const;
    /// New trees instead of those that are full, unless another thread has made them.
    [[nodiscard]] std::shared_ptr<Trees> begin_anew(const std::shared_ptr<Trees>& full) const;

    PaddedBox space_;
    BoundingProxies bodies_;
    Limits limits_;
    std::array<List, 6> everything_;
    std::size_t least_bytes_ = 0;  ///< of these lists
    /// Those who are in them keep the old ones until they have done.
    mutable std::shared_ptr<Trees> trees_;
};

}  // namespace alhazen

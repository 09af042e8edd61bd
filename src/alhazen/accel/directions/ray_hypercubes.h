#pragma once
/// The subdivided space of rays: six trees of hypercubes, one per dominant direction, created on
/// demand. A hypercube has a list of the primitives that its rays may intersect.
///
/// Source: Arvo and Kirk, "Fast Ray Tracing by Ray Classification", SIGGRAPH 1987.
/// Differs: see accel/directions/ray_classification.h.
/// Conventions: direction 2 k is towards the upper end of axis k, 2 k + 1 towards the lower end.
/// With axes k, k + 1, k + 2 (cyclic) a ray is (x, y, z; u, v): its origin and its slopes along the
/// other two axes relative to the dominant one.
/// Threads: `find` may be called concurrently; lists are independent of the order of calls, unless
/// memory runs out.

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

    /// The ray's point at `t`; the direction is not zero.
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
        const List* list;  ///< ascending by where primitives begin along the direction
        int nodes;         ///< number of hypercubes entered
        bool cached;       ///< found in the thread's cache
        std::shared_ptr<const void> kept;  ///< keeps the list alive
    };
    /// The list of a ray that starts in the space, or outside of it by rounding errors. The
    /// thread's caches for closest and for any hit are separate.
    [[nodiscard]] Found find(ClassifiedRay ray, bool any_hit = false) const;

    [[nodiscard]] const PaddedBox& space() const { return space_; }
    [[nodiscard]] const BoundingProxies& bodies() const { return bodies_; }
    /// Where a primitive begins along a direction, measured along it.
    [[nodiscard]] double begin_along(std::uint32_t body, int direction) const {
        const Box3& b = bodies_.box(body);
        return direction % 2 == 0 ? b.lo[direction / 2] : -b.hi[direction / 2];
    }
    /// Memory of the proxies and of the trees made so far.
    [[nodiscard]] std::size_t memory_bytes() const {
        const std::shared_ptr<Trees> trees = std::atomic_load(&trees_);
        return bodies_.memory_bytes() + trees->used;
    }
    /// Number of hypercubes in all trees.
    [[nodiscard]] std::size_t nodes_made() const { return std::atomic_load(&trees_)->nodes_made; }

  private:
    /// Of the 32 children of a hypercube only those reached by rays are created.
    struct Node {
        std::atomic<const List*> list{nullptr};  ///< null: not computed yet
        std::atomic<Node*> first_child{nullptr};
        Node* next = nullptr;     ///< the sibling made before this one
        std::uint32_t index = 0;  ///< index among its parent's children
    };
    struct Recent;
    struct Trees {
        explicit Trees(std::size_t bytes) : used(bytes) {}
        /// Never reused: identifies entries of the threads' caches.
        std::uint64_t id = new_id();
        std::array<Node, 6> roots;
        std::mutex making;
        std::deque<Node> nodes;
        std::vector<std::unique_ptr<const List>> lists;
        std::atomic<std::size_t> used, nodes_made{6};
    };
    [[nodiscard]] static std::uint64_t new_id();

    [[nodiscard]] Hypercube root() const;
    /// The candidates of `parent` for the rays of a hypercube, in the same order.
    [[nodiscard]] List meeting(const List& parent, int direction, const Hypercube& cube) const;
    /// Null if no memory is left.
    [[nodiscard]] Node* child_of(Trees& trees, Node& node, std::uint32_t index) const;
    [[nodiscard]] const List* list_of(Trees& trees, Node& child, const List& parent, int direction,
                                      const Hypercube& cube, bool last) const;
    struct Leaf {
        const List* list;
        Hypercube cube;
        int depth;
        bool whole;  ///< false if no memory was left to divide further
    };
    [[nodiscard]] Leaf descend(Trees& trees, const ClassifiedRay& ray) const;
    /// Replaces full trees by new ones, unless another thread has done so.
    [[nodiscard]] std::shared_ptr<Trees> begin_anew(const std::shared_ptr<Trees>& full) const;

    PaddedBox space_;
    BoundingProxies bodies_;
    Limits limits_;
    std::array<List, 6> everything_;
    std::size_t least_bytes_ = 0;  ///< memory of these lists
    /// Threads that use replaced trees keep them alive.
    mutable std::shared_ptr<Trees> trees_;
};

}  // namespace alhazen

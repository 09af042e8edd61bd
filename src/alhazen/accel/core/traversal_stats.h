#pragma once
/// Statistics of a traversal, counted by a policy without cost when disabled.
///
/// Names follow Havran and Sixta, "Comparison of Hierarchical Grids", Ray Tracing News 12(1), 1999.

#include <cstdint>
#include <utility>

namespace alhazen {

struct TraversalStats {
    std::uint64_t box_tests = 0;        ///< ray-bound tests, one per child of a wide node
    std::uint64_t primitive_tests = 0;  ///< ray-primitive tests, padding lanes not counted
    std::uint64_t primitive_hits = 0;   ///< tests that found a crossing in the ray's range
    std::uint64_t mailbox_saved = 0;    ///< tests avoided by a mailbox
    std::uint64_t node_visits = 0;      ///< nodes or cells entered
    std::uint64_t empty_cells = 0;      ///< of these, cells without primitives
    std::uint64_t slab_tests = 0;       ///< slabs examined in the tests of bounds made of slabs
    std::uint64_t heap_pushes = 0;      ///< bounds pushed onto a heap
    std::uint64_t cache_lookups = 0;    ///< lookups in caches: of cells, of last occluders
    std::uint64_t cache_hits = 0;       ///< of these, lookups with a result

    TraversalStats& operator+=(const TraversalStats& other) {
        box_tests += other.box_tests;
        primitive_tests += other.primitive_tests;
        primitive_hits += other.primitive_hits;
        mailbox_saved += other.mailbox_saved;
        node_visits += other.node_visits;
        empty_cells += other.empty_cells;
        slab_tests += other.slab_tests;
        heap_pushes += other.heap_pushes;
        cache_lookups += other.cache_lookups;
        cache_hits += other.cache_hits;
        return *this;
    }
};

/// The counting policy.
struct CountingStats {
    static constexpr bool kCounts = true;
    TraversalStats* stats;
    void boxes(std::uint64_t n) const { stats->box_tests += n; }
    void primitives(std::uint64_t n) const { stats->primitive_tests += n; }
    void primitive_hits(std::uint64_t n) const { stats->primitive_hits += n; }
    void mailbox_saved(std::uint64_t n) const { stats->mailbox_saved += n; }
    void nodes(std::uint64_t n) const { stats->node_visits += n; }
    void empty_cells(std::uint64_t n) const { stats->empty_cells += n; }
    void slabs(std::uint64_t n) const { stats->slab_tests += n; }
    void heap_pushes(std::uint64_t n) const { stats->heap_pushes += n; }
    void cache_lookup(bool hit) const {
        ++stats->cache_lookups;
        stats->cache_hits += hit;
    }
    [[nodiscard]] TraversalStats* sink() const { return stats; }  ///< for nested aggregates
};

/// The policy that counts nothing.
struct NoStats {
    static constexpr bool kCounts = false;
    void boxes(std::uint64_t) const {}
    void primitives(std::uint64_t) const {}
    void primitive_hits(std::uint64_t) const {}
    void mailbox_saved(std::uint64_t) const {}
    void nodes(std::uint64_t) const {}
    void empty_cells(std::uint64_t) const {}
    void slabs(std::uint64_t) const {}
    void heap_pushes(std::uint64_t) const {}
    void cache_lookup(bool) const {}
    [[nodiscard]] TraversalStats* sink() const { return nullptr; }
};

/// Calls `body(policy)` with the counting policy for `stats`, or with NoStats if it is null.
template <class Body>
decltype(auto) with_stats(TraversalStats* stats, Body&& body) {
    if (stats != nullptr) return body(CountingStats{stats});
    return body(NoStats{});
}

}  // namespace alhazen

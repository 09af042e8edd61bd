#pragma once
/// A sweep that divides edges at all their common points and determines which operands lie on each
/// side of them.
///
/// Source: Bentley and Ottmann, "Algorithms for Reporting and Counting Geometric Intersections",
/// IEEE Transactions on Computers C-28, 1979.
/// Differs: at each point all edges through it are removed from the order and inserted again as a
/// fan sorted by direction, so that any number of edges may meet there; edges of one direction
/// continue as one bundle. All decisions are exact.
/// Conventions: states follow the even-odd rule for each operand. Two operands have a bit each;
/// `run_with_faces` sweeps any number of operands.
/// Complexity: O((n + k) log n) comparisons.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/polygon_sets/arrangement.h"

namespace alhazen {

class EdgeSweep {
  public:
    void clear();
    /// Adds a loop of the operand with the bit `owner`. Skips repeated successive points.
    void add_loop(std::span<const LatticePoint> loop, std::uint8_t owner);
    /// Adds a loop of the operand with a number, for `run_with_faces`.
    void add_loop_of(std::span<const LatticePoint> loop, std::uint32_t operand);
    /// Sweeps the added loops.
    void run();
    /// Sweeps and also records the intervals.
    void run_with_intervals();
    /// Sweeps and records the operands that contain each face, instead of states. Number 0 is
    /// outside.
    void run_with_faces(ArrangementFaces& faces);

    [[nodiscard]] const Arrangement& result() const { return result_; }

  private:
    static constexpr std::uint32_t kNone = 0xffffffff;

    /// The state of an edge that the sweep has reached.
    struct Active {
        std::uint32_t next_member = kNone;  ///< next edge of its bundle
        std::uint32_t sub_edge = kNone;     ///< of the bundle that it leads; parity 0: kNone
        std::uint8_t owner = 0;
        std::uint8_t above = 0;  ///< the state above its bundle
    };
    struct Vertex {
        std::uint64_t key = 0;     ///< ascends in the order of the points
        std::uint32_t edges[2]{};  ///< edges that meet at the vertex
    };
    /// A crossing of two edges that the sweep has not reached.
    struct Crossing {
        LatticePlace place;
        std::uint32_t edges[2]{};
    };

    [[nodiscard]] bool next_point();
    void sort_vertices();
    void take_vertices();
    void drop_crossings_at_place();
    void sweep_point();
    [[nodiscard]] int side(std::uint32_t edge) const;
    [[nodiscard]] std::size_t first_not_below() const;
    void record_intervals(std::size_t lo, std::size_t hi);
    void close_bundle(std::uint32_t leader);
    void sort_fan();
    void bundle_fan(std::uint8_t state);
    void bundle_fan_of_faces(std::uint32_t lower, std::uint32_t upper);
    void replace(std::size_t lo, std::size_t hi);
    void test_neighbors(std::uint32_t lower, std::uint32_t upper);
    void push_crossing(std::uint32_t a, std::uint32_t b);
    [[nodiscard]] bool steeper(std::uint32_t a, std::uint32_t b) const;

    Arrangement result_;
    std::vector<Active> active_;
    std::vector<Vertex> vertices_;
    std::size_t next_vertex_ = 0;
    std::vector<Crossing> crossings_;
    std::vector<std::uint32_t> heap_;
    std::vector<std::uint32_t> free_;
    std::vector<std::uint32_t> status_;  ///< leaders of bundles, from the lowest
    std::vector<std::uint32_t> fan_;     ///< edges that start at the point
    LatticePlace place_;
    LatticePoint at_;  ///< the place, if it is a vertex
    bool at_vertex_ = false;
    bool with_intervals_ = false;
    std::uint32_t through_[2]{};             ///< edges that cross at the place
    ArrangementFaces* faces_ = nullptr;      ///< if requested
    std::vector<std::uint32_t> operands_;    ///< [edge]
    std::vector<std::uint32_t> face_above_;  ///< [leader of a bundle]
    std::vector<std::uint32_t> crossed_;
};

}  // namespace alhazen

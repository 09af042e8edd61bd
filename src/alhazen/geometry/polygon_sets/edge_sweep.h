#pragma once
/// The sweep that cuts edges at all their common points and says on which side of them each operand
/// lies.
///
/// Source: Bentley and Ottmann, "Algorithms for Reporting and Counting Geometric Intersections",
/// IEEE Transactions on Computers C-28, 1979.
/// Differs: at each point all edges through it are taken out of the order and put back as a fan
/// sorted by direction, so that any number of edges may meet there; edges of one direction go on as
/// one bundle. All decisions are exact.
/// Conventions: states are even-odd for each operand. Two operands have a bit each; any number of
/// them are swept by `run_with_faces`.
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
    /// Adds a loop of the operand with the bit `owner`. Equal successive points are passed over.
    void add_loop(std::span<const LatticePoint> loop, std::uint8_t owner);
    /// The same for the operand of a number, for `run_with_faces`.
    void add_loop_of(std::span<const LatticePoint> loop, std::uint32_t operand);
    /// Sweeps what was added.
    void run();
    /// Sweeps and records the intervals too.
    void run_with_intervals();
    /// Sweeps and tells which operands hold the faces, instead of states. Number 0 is outside.
    void run_with_faces(ArrangementFaces& faces);

    [[nodiscard]] const Arrangement& result() const { return result_; }

  private:
    static constexpr std::uint32_t kNone = 0xffffffff;

    /// What the sweep knows about an edge that it has met.
    struct Active {
        std::uint32_t next_member = kNone;  ///< of its bundle
        std::uint32_t sub_edge = kNone;     ///< of the bundle that it leads, kNone for parity 0
        std::uint8_t owner = 0;
        std::uint8_t above = 0;  ///< the state above its bundle
    };
    struct Vertex {
        std::uint64_t key = 0;     ///< ascends as the points do
        std::uint32_t edges[2]{};  ///< that meet in it
    };
    /// A crossing of two edges that waits for its turn.
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
    std::vector<std::uint32_t> status_;  ///< leaders of bundles, from below
    std::vector<std::uint32_t> fan_;     ///< edges that leave the point
    LatticePlace place_;
    LatticePoint at_;  ///< the place where it is a vertex
    bool at_vertex_ = false;
    bool with_intervals_ = false;
    std::uint32_t through_[2]{};             ///< edges that cross in the place
    ArrangementFaces* faces_ = nullptr;      ///< where asked for
    std::vector<std::uint32_t> operands_;    ///< of the edges
    std::vector<std::uint32_t> face_above_;  ///< of the bundles that edges lead
    std::vector<std::uint32_t> crossed_;
};

}  // namespace alhazen

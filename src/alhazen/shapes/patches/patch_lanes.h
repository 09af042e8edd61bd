#pragma once
/// The vectorised parts of the search for crossings with patches: traversal of the boxes, and
/// evaluation of bicubic patches.
///
/// Conventions: internal to PatchIndex. Every target gives the same bits.

#include <bit>
#include <cstdint>
#include <limits>

#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/shapes/patches/certified_cells.h"
#include "alhazen/shapes/patches/patch_borders.h"
#include "alhazen/shapes/patches/patch_boxes.h"
#include "alhazen/shapes/patches/patch_leaves.h"
#include "alhazen/shapes/patches/patch_value.h"

namespace alhazen {

inline constexpr std::uint32_t kNoLeaf = ~0u;  ///< the leaf child that does not exist

/// The traversal state of one line, nearest boxes first.
struct PatchTraversal {
    /// Distance and child packed into one number: loading what two stores wrote would stall.
    struct Waiting {
        std::uint64_t near_and_child;

        static Waiting of(float near, std::uint32_t child) {
            return {std::uint64_t{std::bit_cast<std::uint32_t>(near)} << 32 | child};
        }
        [[nodiscard]] float near() const {
            return std::bit_cast<float>(static_cast<std::uint32_t>(near_and_child >> 32));
        }
        [[nodiscard]] std::uint32_t child() const {
            return static_cast<std::uint32_t>(near_and_child);
        }
    };
    // The tree has up to 17 levels (nine, and eight that divide 2^31 leaves evenly), each of which
    // leaves fifteen children on the stack. One more is for `begin_above_end`, and some are for
    // writes of `push_children` past the end.
    static constexpr int kMostWaiting = 276;

    float from[3], inverse[3];  ///< in the frame; 1 / direction
    float least, most;          ///< the range along the line
    /// Indices into PatchBoxes::planes of the planes through which the line enters and leaves
    /// boxes: [axis].
    std::uint32_t enters[3], leaves[3];
    int size;
    Waiting stack[kMostWaiting];

    /// Sets `enters` and `leaves` by the signs of the direction.
    void set_planes() {
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            const std::uint32_t low = kBoxChildren * axis, high = kBoxChildren * (3 + axis);
            const bool down = inverse[axis] < 0.0f;
            enters[axis] = down ? high : low;
            leaves[axis] = down ? low : high;
        }
    }
    /// Starts at the root, above a sentinel kNoLeaf at the bottom of the stack that ends the
    /// traversal without a test.
    void begin_above_end() {
        size = 2;
        stack[0] = Waiting::of(-std::numeric_limits<float>::infinity(), kNoLeaf);
        stack[1] = Waiting::of(least, 0);
    }
};

/// A packet of coherent lines that traverse a tree of boxes together. The signs of their directions
/// agree.
struct alignas(64) PatchPacket {
    double origin[3][kRayLanes], direction[3][kRayLanes];  ///< in the frame
    float most_of[kRayLanes];                              ///< end of the range along each line
    float from[2][3], inverse[2][3];  ///< minimum and maximum of PatchTraversal's values
    PatchTraversal walk;              ///< range of the whole packet; the origin is unused
};

/// Bounds of a cell from its control points.
struct CellBounds {
    double least[3], most[3];          ///< range of x, y and along `aside`
    PlanePoint f, f_u, f_v;            ///< value and derivatives at the middle, in half-widths
    double bend_u[3], bend_v[3];       ///< |second differences| by uu, uv, vv, solved for u and v
    double size_uu, size_uv, size_vv;  ///< |second differences|
    double extent_u, extent_v;         ///< |first differences|
};

/// The input of Newton's method: see `certified_root`.
struct CubicNewton {
    PatchCell cell;
    double u, v, noise;
    bool converges;
    /// True if roots outside of [least, most] along the line are omitted, in a cell whose second
    /// derivatives |S_aa| + 2 |S_ab| + |S_bb|, in half-widths, are at most `bend`. Requires
    /// `converges`.
    bool has_range;
    double least, most, bend;
};
enum class NewtonEnd { NoRoot, OutOfRange, Root };
struct CubicRoot {
    double u, v, z;             ///< z along the line, in the tangent plane
    double x_u, y_u, x_v, y_v;  ///< derivatives before the last step
};

/// A line in the frame; the fourth numbers are 0.
struct alignas(32) LeafLine {
    double origin[4], direction[4];
};
/// Result of the part of the leaf test that needs no patch. None: no root in the range of the line.
enum class LeafAnswer { None, Certified, Unique, Divide };
/// Start of Newton's method, and a bound of the leaf's second derivatives; 0 if none is known, for
/// a leaf without a plane.
struct LeafStart {
    double a = 0, b = 0, bend = 0;
};

/// Number of pairs that are tested in lanes.
inline constexpr std::size_t kPatchPairs = 4;

/// The frame for setting up lines.
struct LineFrame {
    PatchFrame frame;
    double far, reach, most_weight;  ///< see PatchIndex
};
/// A line and its own traversal.
struct LineTraversal {
    PatchLine line;
    LeafLine seen_by;
    PatchTraversal walk;
};
/// Sets of lines, bit i for line i: the squared direction is a normal number (else nothing is set);
/// the line is near (PatchIndex::is_near).
struct LinesSetOut {
    std::uint32_t usual, near;
};

/// Pairs of leaves and lines, all four set, with the ranges along the lines.
struct alignas(32) LeafPairs {
    double least[kPatchPairs], most[kPatchPairs];
    const PatchLeaf* leaf[kPatchPairs];
    const LeafLine* line[kPatchPairs];
};
/// Results of `test_leaf`, bit i for pair i, and its starts.
struct alignas(32) LeafAnswers {
    double a[kPatchPairs], b[kPatchPairs], bend[kPatchPairs];
    std::uint32_t met, unique, certified;
};

/// Pairs of bicubic patches without weights and lines, all four set, with the values of
/// CubicNewton; bit i for pair i.
struct alignas(32) CubicPairs {
    double u0[kPatchPairs], u1[kPatchPairs], v0[kPatchPairs], v1[kPatchPairs];
    double u[kPatchPairs], v[kPatchPairs];
    double least[kPatchPairs], most[kPatchPairs], bend[kPatchPairs];
    const HomogeneousPoint* points[kPatchPairs];
    const PatchLine* line[kPatchPairs];
    std::uint32_t used, converges, ranged;
};
struct alignas(32) CubicRoots {
    double u[kPatchPairs], v[kPatchPairs], z[kPatchPairs];
    double x_u[kPatchPairs], y_u[kPatchPairs], x_v[kPatchPairs], y_v[kPatchPairs];
    std::uint32_t met;

    [[nodiscard]] CubicRoot root(std::size_t i) const {
        return {u[i], v[i], z[i], x_u[i], y_u[i], x_v[i], y_v[i]};
    }
};

struct PatchKernels {
    /// Advances to the next leaf whose box the line passes through; false at the end.
    bool (*next_leaf)(const PatchBoxes* nodes, PatchTraversal& walk, std::uint32_t& leaf);
    /// The same for several lines set up by `begin_above_end`: at the end of a line its leaf is
    /// kNoLeaf without kLeafChild, after which it must not be continued.
    void (*next_leaves)(const PatchBoxes* nodes, LineTraversal* const* ways, std::size_t count,
                        std::uint32_t* leaves);
    /// Sets up eight rays; false if the signs of their directions differ. A line whose origin is
    /// farther than `far` from the centre starts at the point nearest to it.
    bool (*begin_packet)(const RayLanes& rays, const PatchFrame& frame, double far,
                         PatchPacket& packet);
    /// The same for a packet, nearest first; `near` is where the first line enters the box.
    bool (*next_leaf_of_packet)(const PatchBoxes* nodes, PatchPacket& packet, std::uint32_t& leaf,
                                float& near);
    LeafAnswer (*test_leaf)(const PatchLeaf& leaf, const LeafLine& line, double least, double most,
                            LeafStart& start);
    /// Sets up four lines, with the axes of their planes.
    LinesSetOut (*set_out_lines)(const Ray* const* rays, const LineFrame& frame,
                                 LineTraversal* ways);
    void (*test_leaves)(const LeafPairs& pairs, LeafAnswers& answers);
    /// The lines for which `test_leaf` may have an answer other than None, and few others.
    std::uint32_t (*lines_near)(const PatchLeaf& leaf, const PatchPacket& packet);
    /// The following are for bicubic patches.
    HomogeneousValue (*bicubic)(BezierView net, double u, double v);
    void (*cubic_line)(const HomogeneousPoint* points, const PatchLine& line, CubicLine& out);
    NewtonEnd (*cubic_newton)(const CubicLine& net, const CubicNewton& task, CubicRoot& out);
    /// Runs `cubic_newton` for all pairs.
    void (*cubic_newtons)(const CubicPairs& pairs, CubicRoots& out);
    /// Computes only `least` and `most` if these exclude the origin by more than `margin`.
    void (*cubic_bounds)(const CubicCell& net, double margin, CellBounds& out);
    /// Halves a cell, accurate to some roundings; `low` may be `net`.
    void (*halve_cubic)(const CubicCell& net, bool along_u, CubicCell& low, CubicCell& high);
    /// The control points over a cell, accurate to some roundings.
    void (*cubic_part)(const CubicLine& whole, const PatchCell& cell, CubicCell& part);
};
[[nodiscard]] const PatchKernels& patch_kernels();

}  // namespace alhazen

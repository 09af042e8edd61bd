#pragma once
/// The parts of the search for a line's crossings with patches that run in lanes: the walk through
/// the boxes, and values of bicubic patches.
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

inline constexpr std::uint32_t kNoLeaf = ~0u;  ///< a leaf child that there is not

/// A line on its way through a tree of boxes, nearest boxes first.
struct PatchWalk {
    /// One number, since a load of what two stores wrote waits for both.
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
    // leaves fifteen children. One more for `begin_above_end`, and some that `push_children` writes
    // beyond.
    static constexpr int kMostWaiting = 276;

    float from[3], inverse[3];  ///< in the frame; 1 / direction
    float least, most;          ///< the range along the line
    /// Where in PatchBoxes::planes the planes are through which the line enters boxes, and leaves
    /// them: [axis].
    std::uint32_t enters[3], leaves[3];
    int size;
    Waiting stack[kMostWaiting];

    /// By the signs of its direction.
    void set_planes() {
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            const std::uint32_t low = kBoxChildren * axis, high = kBoxChildren * (3 + axis);
            const bool down = inverse[axis] < 0.0f;
            enters[axis] = down ? high : low;
            leaves[axis] = down ? low : high;
        }
    }
    /// At the root. Below it waits kNoLeaf, so that a walk without a leaf needs no test.
    void begin_above_end() {
        size = 2;
        stack[0] = Waiting::of(-std::numeric_limits<float>::infinity(), kNoLeaf);
        stack[1] = Waiting::of(least, 0);
    }
};

/// Lines side by side on their way through a tree of boxes together. The directions have the same
/// signs.
struct alignas(64) PatchPacket {
    double origin[3][kRayLanes], direction[3][kRayLanes];  ///< in the frame
    float most_of[kRayLanes];                              ///< the range along each line ends here
    float from[2][3], inverse[2][3];                       ///< least and most of PatchWalk's
    PatchWalk walk;                                        ///< the range of all; no origin
};

/// Bounds of a cell by its control points.
struct CellBounds {
    double least[3], most[3];          ///< of x, y and along `aside`
    PlanePoint f, f_u, f_v;            ///< value and derivatives at the middle, in half-widths
    double bend_u[3], bend_v[3];       ///< |second differences| by uu, uv, vv, solved for u and v
    double size_uu, size_uv, size_vv;  ///< |second differences|
    double extent_u, extent_v;         ///< |first differences|
};

/// What Newton's method is to find: see `certified_root`.
struct CubicNewton {
    PatchCell cell;
    double u, v, noise;
    bool converges;
    /// Whether roots out of [least, most] along the line are left out, in a cell where the second
    /// derivatives |S_aa| + 2 |S_ab| + |S_bb|, in half-widths, are at most `bend`. Only where the
    /// method converges.
    bool has_range;
    double least, most, bend;
};
enum class NewtonEnd { NoRoot, OutOfRange, Root };
struct CubicRoot {
    double u, v, z;             ///< z along the line, in the tangent plane
    double x_u, y_u, x_v, y_v;  ///< before the last step
};

/// A line in the frame; the fourth numbers are 0.
struct alignas(32) LeafLine {
    double origin[4], direction[4];
};
/// The part of the leaf test that needs no patch. None: no root in the range along the line.
enum class LeafAnswer { None, Certified, Unique, Divide };
/// Where Newton's method starts, and a bound of the leaf's second derivatives: 0 where none is
/// known, for a leaf without a plane.
struct LeafStart {
    double a = 0, b = 0, bend = 0;
};

/// Pairs that are tested side by side.
inline constexpr std::size_t kPatchPairs = 4;

/// What lines are set out in.
struct LineFrame {
    PatchFrame frame;
    double far, reach, most_weight;  ///< see PatchIndex
};
/// A line on its way by itself.
struct PatchWay {
    PatchLine line;
    LeafLine seen_by;
    PatchWalk walk;
};
/// Bit i for line i: whether its direction's square is a usual number, without which nothing is
/// set; whether it is near (PatchIndex::is_near).
struct LinesSetOut {
    std::uint32_t usual, near;
};

/// Leaves with lines, all set, and the ranges along these.
struct alignas(32) LeafPairs {
    double least[kPatchPairs], most[kPatchPairs];
    const PatchLeaf* leaf[kPatchPairs];
    const LeafLine* line[kPatchPairs];
};
/// The answers of `test_leaf`, bit i for pair i, and its starts.
struct alignas(32) LeafAnswers {
    double a[kPatchPairs], b[kPatchPairs], bend[kPatchPairs];
    std::uint32_t met, unique, certified;
};

/// Bicubic patches without weights with lines, all set, and the numbers of CubicNewton; bit i for
/// pair i.
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
    /// The next leaf whose box the line passes through; false at the end.
    bool (*next_leaf)(const PatchBoxes* nodes, PatchWalk& walk, std::uint32_t& leaf);
    /// The same for some lines that `begin_above_end` has set out: kNoLeaf without kLeafChild at
    /// the end of one, after which it is done.
    void (*next_leaves)(const PatchBoxes* nodes, PatchWay* const* ways, std::size_t count,
                        std::uint32_t* leaves);
    /// Sets out eight rays; false where the signs of their directions differ. Farther than `far`
    /// from the middle a line begins at the point nearest to it.
    bool (*begin_packet)(const RayLanes& rays, const PatchFrame& frame, double far,
                         PatchPacket& packet);
    /// The same for a packet, nearest first; `near` is where the first line enters the box.
    bool (*next_leaf_of_packet)(const PatchBoxes* nodes, PatchPacket& packet, std::uint32_t& leaf,
                                float& near);
    LeafAnswer (*test_leaf)(const PatchLeaf& leaf, const LeafLine& line, double least, double most,
                            LeafStart& start);
    /// Sets out four lines, with the axes of their planes.
    LinesSetOut (*set_out_lines)(const Ray* const* rays, const LineFrame& frame, PatchWay* ways);
    void (*test_leaves)(const LeafPairs& pairs, LeafAnswers& answers);
    /// The lines for which `test_leaf` has another answer than None, and hardly any others.
    std::uint32_t (*lines_near)(const PatchLeaf& leaf, const PatchPacket& packet);
    /// For bicubic patches, also the rest.
    HomogeneousValue (*bicubic)(BezierView net, double u, double v);
    void (*cubic_line)(const HomogeneousPoint* points, const PatchLine& line, CubicLine& out);
    NewtonEnd (*cubic_newton)(const CubicLine& net, const CubicNewton& task, CubicRoot& out);
    /// The roots that `cubic_newton` finds.
    void (*cubic_newtons)(const CubicPairs& pairs, CubicRoots& out);
    /// Only `least` and `most` where these leave out the origin by more than `margin`.
    void (*cubic_bounds)(const CubicCell& net, double margin, CellBounds& out);
    /// To some roundings; `low` may be `net`.
    void (*halve_cubic)(const CubicCell& net, bool along_u, CubicCell& low, CubicCell& high);
    /// The control points over a cell, to some roundings.
    void (*cubic_part)(const CubicLine& whole, const PatchCell& cell, CubicCell& part);
};
[[nodiscard]] const PatchKernels& patch_kernels();

}  // namespace alhazen

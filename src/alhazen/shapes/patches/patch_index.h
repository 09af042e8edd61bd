#pragma once
/// The leaves of patches in a tree of boxes, and the search for the roots of a line.
///
/// Conventions: internal to PatchTree.

#include <span>
#include <vector>

#include "alhazen/geometry/ray.h"
#include "alhazen/shapes/patches/patch_boxes.h"
#include "alhazen/shapes/patches/patch_cells.h"
#include "alhazen/shapes/patches/patch_leaves.h"
#include "alhazen/shapes/patches/patch_tree.h"

namespace alhazen {

/// Counts of one or many searches.
struct PatchCounts {
    std::size_t nodes = 0, leaves = 0, newton = 0, halved = 0;
};

class PatchIndex {
  public:
    PatchIndex(std::span<const BezierPiece> pieces, const Box3& box);

    [[nodiscard]] PatchLine line_of(const Ray& ray) const;
    [[nodiscard]] std::span<const PatchLeaf> leaves() const { return leaves_; }
    [[nodiscard]] std::size_t bytes() const;

    /// Calls `found(piece, root)` for every root in [t_min, limit]; `found` returns the new limit.
    template <class F>
    void search(std::span<const BezierPiece> pieces, const PatchLine& line, double t_min,
                double limit, F&& found) const;

  private:
    template <class F>
    void visit_leaf(std::span<const BezierPiece> pieces, const PatchLine& line, const Vec3& origin,
                    const PatchLeaf& leaf, F& found) const;

    PatchFrame frame_;
    double reach_ = 0, most_weight_ = 0, far_ = 0;
    std::vector<PatchLeaf> leaves_;  ///< in the order of the tree
    std::vector<PatchBoxes> nodes_;
};

/// The part of the leaf test that needs no patch.
enum class LeafAnswer { None, Certified, Divide };
[[nodiscard]] LeafAnswer test_leaf(const PatchLeaf& leaf, const Vec3& origin, const Vec3& direction,
                                   double& a, double& b);

template <class F>
void PatchIndex::visit_leaf(std::span<const BezierPiece> pieces, const PatchLine& line,
                            const Vec3& origin, const PatchLeaf& leaf, F& found) const {
    double a = 0, b = 0;
    const LeafAnswer answer = test_leaf(leaf, origin, line.direction, a, b);
    if (answer == LeafAnswer::None) return;
    const PatchCell cell = leaf.cell();
    const BezierNet& net = pieces[leaf.piece].net;
    PatchRoot root;
    if (answer == LeafAnswer::Certified) {
        const double u = cell.u0 + 0.5 * (1.0 + a) * (cell.u1 - cell.u0);
        const double v = cell.v0 + 0.5 * (1.0 + b) * (cell.v1 - cell.v0);
        if (certified_root(RootOf::Point, net, line, cell, u, v, root)) found(leaf.piece, root);
        return;
    }
    CellSearch cells(net, line, cell);
    while (cells.next(root)) found(leaf.piece, root);
}

template <class F>
void PatchIndex::search(std::span<const BezierPiece> pieces, const PatchLine& line, double t_min,
                        double limit, F&& found) const {
    struct Waiting {
        float near;
        std::uint32_t child;
    };
    const Vec3 origin = frame_.scale * (line.origin - frame_.center);
    float from[3], inverse[3];
    for (int axis = 0; axis < 3; ++axis) {
        const double d = line.direction[axis];
        from[axis] = static_cast<float>(origin[axis]);
        inverse[axis] = static_cast<float>(1.0 / std::copysign(std::max(std::abs(d), 1e-18), d));
    }
    // Along the line in the frame, with a margin.
    const double per_t = frame_.scale / line.per_length;
    const auto place = [&](double t, double side) {
        const double x = (t - line.shift) * per_t;
        return static_cast<float>(std::clamp(x + side * (1e-5 + 1e-6 * std::abs(x)), -1e30, 1e30));
    };
    const float least = place(t_min, -1.0);
    float most = place(limit, 1.0);
    const auto report = [&](std::uint32_t piece, const PatchRoot& root) {
        const double t = found(piece, root);
        if (t < limit) most = place(limit = t, 1.0);
    };
    Waiting stack[kBoxChildren * 24];
    int size = 0;
    stack[size++] = {least, 0};
    while (size > 0) {
        const Waiting next = stack[--size];
        if (next.near > most) continue;
        if ((next.child & kLeafChild) != 0) {
            visit_leaf(pieces, line, origin, leaves_[next.child & ~kLeafChild], report);
            continue;
        }
        const PatchBoxes& node = nodes_[next.child];
        const int begin = size;
        for (int k = 0; k < kBoxChildren; ++k) {
            float near = least, far = most;
            for (int axis = 0; axis < 3; ++axis) {
                const float x = (node.lo[axis][k] - from[axis]) * inverse[axis];
                const float y = (node.hi[axis][k] - from[axis]) * inverse[axis];
                near = std::max(near, inverse[axis] < 0 ? y : x);
                far = std::min(far, inverse[axis] < 0 ? x : y);
            }
            if (!(near <= far)) continue;
            int place_in = size++;
            for (; place_in > begin && stack[place_in - 1].near < near; --place_in) {
                stack[place_in] = stack[place_in - 1];
            }
            stack[place_in] = {near, node.child[k]};
        }
    }
}

}  // namespace alhazen

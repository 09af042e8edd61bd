#pragma once
/// The leaves of patches in a tree of boxes, and the search for roots along a line.
///
/// Conventions: internal to PatchTree.

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "alhazen/geometry/ray.h"
#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/shapes/patches/certified_cells.h"
#include "alhazen/shapes/patches/patch_boxes.h"
#include "alhazen/shapes/patches/patch_lanes.h"
#include "alhazen/shapes/patches/patch_leaves.h"
#include "alhazen/shapes/patches/patch_tree.h"

namespace alhazen {

class PatchIndex {
  public:
    PatchIndex(const PatchPieces& pieces, const Box3& box);

    /// Does not set the axes of the plane, which most rays do not need.
    [[nodiscard]] PatchLine line_of(const Ray& ray) const;
    static void add_axes(PatchLine& line);
    /// False for a line that is far from all patches, and after overflow.
    [[nodiscard]] bool is_near(const PatchLine& line) const;
    [[nodiscard]] std::span<const PatchLeaf> leaves() const { return leaves_; }
    [[nodiscard]] std::size_t bytes() const;

    /// Calls `found(piece, root)` for every root in [t_min, limit]; `found` returns the new limit.
    template <class F>
    void search(const PatchPieces& pieces, PatchLine line, double t_min, double limit,
                F&& found) const;

    /// Searches lines of coherent rays together. Calls `found(i, piece, root)` for every root of
    /// line i in [rays[i]->t_min, limit of i] and perhaps for others; returns false, without a
    /// call, if the rays are not coherent.
    template <class F>
    [[nodiscard]] bool search_together(const PatchPieces& pieces, std::span<const Ray* const> rays,
                                       F&& found) const;

  private:
    template <class F>
    friend class PatchLinesApart;

    /// Converts t to the frame of `line` and rounds it to float, with a margin to the given side.
    [[nodiscard]] float place(const PatchLine& line, double t, double side) const;
    [[nodiscard]] static bool side_by_side(std::span<const Ray* const> rays);
    [[nodiscard]] PatchTraversal walk_of(const PatchLine& line, double t_min, double limit) const;
    [[nodiscard]] Vec3 in_frame(const Vec3& p) const { return frame_.scale * (p - frame_.center); }

    /// `least` and `most`: the range along the line, in the frame.
    template <class F>
    void visit_leaf(const PatchPieces& pieces, PatchLine& line, const LeafLine& seen_by,
                    double least, double most, const PatchLeaf& leaf, F& found) const;
    /// Continues a leaf whose test had an answer other than None.
    template <class F>
    void visit_leaf(const PatchPieces& pieces, const PatchLine& line, LeafAnswer answer,
                    const LeafStart& start, double least, double most, const PatchLeaf& leaf,
                    F& found) const;
    /// The line as input of `test_leaf`.
    [[nodiscard]] LeafLine leaf_line(const PatchLine& line) const {
        const Vec3 o = in_frame(line.origin);
        const Vec3& d = line.direction;
        return {{o.x, o.y, o.z, 0.0}, {d.x, d.y, d.z, 0.0}};
    }
    PatchFrame frame_;
    double reach_ = 0, most_weight_ = 0, far_ = 0;
    std::vector<PatchLeaf> leaves_;  ///< in the order of the tree
    std::vector<PatchBoxes> nodes_;
};

template <class F>
void PatchIndex::visit_leaf(const PatchPieces& pieces, PatchLine& line, const LeafLine& seen_by,
                            double least, double most, const PatchLeaf& leaf, F& found) const {
    const PatchKernels& kernels = patch_kernels();
    LeafStart start;
    const LeafAnswer answer = kernels.test_leaf(leaf, seen_by, least, most, start);
    if (answer == LeafAnswer::None) return;
    if (line.axis_x == Vec3{}) add_axes(line);
    visit_leaf(pieces, line, answer, start, least, most, leaf, found);
}

template <class F>
void PatchIndex::visit_leaf(const PatchPieces& pieces, const PatchLine& line, LeafAnswer answer,
                            const LeafStart& start, double least, double most,
                            const PatchLeaf& leaf, F& found) const {
    const PatchKernels& kernels = patch_kernels();
    const PatchCell cell = leaf.cell();
    const BezierView net = pieces.net(leaf.piece);
    PatchRoot root;
    const NewtonProof proof =
        answer == LeafAnswer::Certified ? NewtonProof::Converges : NewtonProof::Unique;
    const double u = cell.u0 + 0.5 * (1.0 + start.a) * (cell.u1 - cell.u0);
    const double v = cell.v0 + 0.5 * (1.0 + start.b) * (cell.v1 - cell.v0);
    // Returns whether the leaf is done.
    const auto ends = [&](bool met) {
        if (met) found(leaf.piece, root);
        return met || answer == LeafAnswer::Certified;
    };
    const auto halve = [&](auto&& cells) {
        while (cells.next(root)) found(leaf.piece, root);
    };
    const bool divide = answer == LeafAnswer::Divide;
    if (!net.is_bicubic()) {
        if (!divide && ends(certified_root(proof, RootOf::Point, net, line, cell, 0.0, u, v, root)))
            return;
        return halve(CellSearch<PlaneNet>(net, line, cell));
    }
    CubicLine seen;
    kernels.cubic_line(net.points, line, seen);
    const double unit = 1.0 / frame_.scale;
    const LineRange bounds{unit * least, unit * most, unit * start.bend};
    // A leaf without a plane has no bound.
    const LineRange* range = net.plain && start.bend > 0.0 ? &bounds : nullptr;
    if (!divide &&
        ends(net.plain ? certified_root(proof, net, seen, line, cell, 0.0, u, v, range, root)
                       : certified_root(proof, RootOf::Point, net, line, cell, 0.0, u, v, root))) {
        return;
    }
    halve(CellSearch<CubicCell>(net, line, cell, seen, range));
}

template <class F>
void PatchIndex::search(const PatchPieces& pieces, PatchLine line, double t_min, double limit,
                        F&& found) const {
    if (!is_near(line)) return;
    PatchTraversal walk = walk_of(line, t_min, limit);
    const LeafLine seen_by = leaf_line(line);
    const auto report = [&](std::uint32_t piece, const PatchRoot& root) {
        const double t = found(piece, root);
        if (t < limit) walk.most = place(line, limit = t, 1.0);
    };
    const PatchKernels& kernels = patch_kernels();
    std::uint32_t leaf = 0;
    while (kernels.next_leaf(nodes_.data(), walk, leaf)) {
        visit_leaf(pieces, line, seen_by, walk.least, walk.most, leaves_[leaf], report);
    }
}

template <class F>
bool PatchIndex::search_together(const PatchPieces& pieces, std::span<const Ray* const> rays,
                                 F&& found) const {
    if (!side_by_side(rays)) return false;
    RayLanes lanes;
    for (std::size_t i = 0; i < kRayLanes; ++i) lanes.set(i, *rays[i < rays.size() ? i : 0]);
    PatchPacket packet;
    const PatchKernels& kernels = patch_kernels();
    if (!kernels.begin_packet(lanes, frame_, far_, packet)) return false;
    std::array<PatchLine, kRayLanes> lines;
    std::uint32_t ready = 0;
    const std::uint32_t used = kAllRayLanes >> (kRayLanes - rays.size());
    std::uint32_t leaf = 0;
    float near = 0.0f;
    while (kernels.next_leaf_of_packet(nodes_.data(), packet, leaf, near)) {
        bool changed = false;
        for_each_lane(used & kernels.lines_near(leaves_[leaf], packet), [&](std::size_t i) {
            if (near > packet.most_of[i]) return;
            if ((ready >> i & 1) == 0) lines[i] = line_of(*rays[i]);
            ready |= 1u << i;
            if (!is_near(lines[i])) return;
            const auto report = [&](std::uint32_t piece, const PatchRoot& root) {
                const double t = found(i, piece, root);
                const float most = place(lines[i], t, 1.0);
                if (!(most < packet.most_of[i])) return;
                packet.most_of[i] = most;
                changed = true;
            };
            visit_leaf(pieces, lines[i], leaf_line(lines[i]), place(lines[i], rays[i]->t_min, -1.0),
                       packet.most_of[i], leaves_[leaf], report);
        });
        if (!changed) continue;
        packet.walk.most = *std::max_element(packet.most_of, packet.most_of + rays.size());
    }
    return true;
}

}  // namespace alhazen

#pragma once
/// Incoherent traversal: many lines traverse the boxes independently, while leaf tests and root
/// searches are batched into lanes, four at a time.
///
/// Source: Gribble and Ramani, "Coherent Ray Tracing via Stream Filtering", IEEE Symposium on
/// Interactive Ray Tracing, 2008 (pairs of rays and primitives, gathered until lanes are full).
/// Differs: each line has its own traversal; only leaves are tested together.
/// Conventions: internal to PatchTree. Each root has the bits of `PatchIndex::search`.

#include <cstddef>

#include "alhazen/shapes/core/first_hits.h"
#include "alhazen/shapes/patches/patch_index.h"

namespace alhazen {

/// A search along the lines of several rays. `found(i, piece, root)` is called for every root of
/// line i in [rays[i]->t_min, limit of i], and perhaps for others; it returns the new limit.
template <class F>
class PatchLinesApart {
  public:
    PatchLinesApart(const PatchIndex& index, const PatchPieces& pieces,
                    std::span<const Ray* const> rays, F& found)
        : index_(index), pieces_(pieces), rays_(rays), found_(found) {}

    void search() {
        set_out();
        while (walking_count_ > 0) {
            kernels_.next_leaves(index_.nodes_.data(), walking_, walking_count_, leaves_);
            test();
            solve();
        }
    }

  private:
    /// A pair of a line and a leaf that may contain a root.
    struct Task {
        LineTraversal* way;
        const PatchLeaf* leaf;
        LeafAnswer answer;
        double a, b, bend;  ///< as in LeafStart
    };

    void walk_on(LineTraversal& way) { walking_[walking_count_++] = &way; }

    void set_out() {
        const LineFrame frame{index_.frame_, index_.far_, index_.reach_, index_.most_weight_};
        for (std::size_t first = 0; first < rays_.size(); first += kPatchPairs) {
            const Ray* rays[kPatchPairs];
            const std::size_t count = std::min(kPatchPairs, rays_.size() - first);
            for (std::size_t i = 0; i < kPatchPairs; ++i) {
                rays[i] = rays_[first + (i < count ? i : 0)];
            }
            const LinesSetOut done = kernels_.set_out_lines(rays, frame, &ways_[first]);
            for (std::size_t i = 0; i < count; ++i) {
                LineTraversal& way = ways_[first + i];
                if ((done.usual >> i & 1) != 0) {
                    if ((done.near >> i & 1) != 0) walk_on(way);
                    continue;
                }
                way.line = index_.line_of(*rays[i]);
                if (!index_.is_near(way.line)) continue;
                PatchIndex::add_axes(way.line);
                way.walk = index_.walk_of(way.line, rays[i]->t_min, rays[i]->t_max);
                way.walk.begin_above_end();
                way.seen_by = index_.leaf_line(way.line);
                walk_on(way);
            }
        }
    }

    static LeafAnswer answer_of(const LeafAnswers& answers, std::size_t i) {
        if ((answers.unique >> i & 1) == 0) return LeafAnswer::Divide;
        return (answers.certified >> i & 1) != 0 ? LeafAnswer::Certified : LeafAnswer::Unique;
    }

    [[nodiscard]] bool is_plain_bicubic(std::uint32_t piece) const {
        const BezierView net = pieces_.net(piece);
        // Neither && nor `is_bicubic`, so that both degrees are loaded as one number.
        return (((net.degree_u ^ 3) | (net.degree_v ^ 3)) == 0) & net.plain;
    }

    /// Tests the current leaves of the lines; those that may contain a root become tasks.
    void test() {
        LineTraversal* at[kMostPatchRays];
        std::uint32_t leaves[kMostPatchRays];
        std::size_t count = 0;
        for (std::size_t k = 0; k < walking_count_; ++k) {
            at[count] = walking_[k];
            leaves[count] = leaves_[k];
            count += leaves_[k] != (kNoLeaf & ~kLeafChild);
        }
        walking_count_ = task_count_ = 0;
        for (std::size_t first = 0; first < count; first += kPatchPairs) {
            LeafPairs pairs;
            for (std::size_t i = 0; i < kPatchPairs; ++i) {
                const std::size_t k = std::min(first + i, count - 1);
                pairs.leaf[i] = &index_.leaves_[leaves[k]];
                pairs.line[i] = &at[k]->seen_by;
                pairs.least[i] = at[k]->walk.least;
                pairs.most[i] = at[k]->walk.most;
            }
            LeafAnswers answers;
            kernels_.test_leaves(pairs, answers);
            for (std::size_t i = 0; i < kPatchPairs && first + i < count; ++i) {
                LineTraversal& way = *at[first + i];
                if ((answers.met >> i & 1) == 0) {
                    walk_on(way);
                    continue;
                }
                const Task task{&way,         pairs.leaf[i], answer_of(answers, i),
                                answers.a[i], answers.b[i],  answers.bend[i]};
                if (task.answer == LeafAnswer::Divide || !is_plain_bicubic(task.leaf->piece)) {
                    visit(task);
                } else {
                    tasks_[task_count_++] = task;
                }
            }
        }
    }

    /// Searches one pair without lanes.
    void visit(const Task& task) {
        LineTraversal& way = *task.way;
        const auto report = [&](std::uint32_t piece, const PatchRoot& root) {
            take(way, piece, root);
        };
        index_.visit_leaf(pieces_, way.line, task.answer, {task.a, task.b, task.bend},
                          way.walk.least, way.walk.most, *task.leaf, report);
        walk_on(way);
    }

    void take(LineTraversal& way, std::uint32_t piece, const PatchRoot& root) {
        const double t = found_(static_cast<std::size_t>(&way - ways_), piece, root);
        const float most = index_.place(way.line, t, 1.0);
        if (most < way.walk.most) way.walk.most = most;
    }

    void solve() {
        const double unit = 1.0 / index_.frame_.scale;
        for (std::size_t first = 0; first < task_count_; first += kPatchPairs) {
            const std::size_t count = std::min(task_count_ - first, kPatchPairs);
            CubicPairs pairs;
            pairs.used = (1u << count) - 1;
            pairs.converges = pairs.ranged = 0;
            for (std::size_t i = 0; i < kPatchPairs; ++i) {
                const Task& task = tasks_[first + (i < count ? i : 0)];
                const LineTraversal& way = *task.way;
                const PatchCell cell = task.leaf->cell();
                pairs.u0[i] = cell.u0;
                pairs.u1[i] = cell.u1;
                pairs.v0[i] = cell.v0;
                pairs.v1[i] = cell.v1;
                pairs.u[i] = cell.u0 + 0.5 * (1.0 + task.a) * (cell.u1 - cell.u0);
                pairs.v[i] = cell.v0 + 0.5 * (1.0 + task.b) * (cell.v1 - cell.v0);
                pairs.least[i] = unit * way.walk.least;
                pairs.most[i] = unit * way.walk.most;
                pairs.bend[i] = unit * task.bend;
                pairs.points[i] = pieces_.net(task.leaf->piece).points;
                pairs.line[i] = &way.line;
                if (task.answer == LeafAnswer::Certified) pairs.converges |= 1u << i;
                if (task.bend > 0.0) pairs.ranged |= 1u << i;
            }
            pairs.ranged &= pairs.converges;
            CubicRoots roots;
            kernels_.cubic_newtons(pairs, roots);
            for (std::size_t i = 0; i < count; ++i) {
                Task& task = tasks_[first + i];
                LineTraversal& way = *task.way;
                PatchRoot root;
                if ((roots.met >> i & 1) != 0 && is_root(pieces_.net(task.leaf->piece), way.line,
                                                         task.leaf->cell(), roots.root(i), root)) {
                    take(way, task.leaf->piece, root);
                    walk_on(way);
                } else if (task.answer == LeafAnswer::Certified) {
                    walk_on(way);
                } else {
                    task.answer = LeafAnswer::Divide;
                    visit(task);
                }
            }
        }
    }

    const PatchIndex& index_;
    const PatchPieces& pieces_;
    std::span<const Ray* const> rays_;
    F& found_;
    const PatchKernels& kernels_ = patch_kernels();
    std::size_t walking_count_ = 0, task_count_ = 0;
    LineTraversal* walking_[kMostPatchRays];
    std::uint32_t leaves_[kMostPatchRays];  ///< current leaf of each line
    Task tasks_[kMostPatchRays];
    // Uninitialised: most of it is unused stack space.
    alignas(LineTraversal) std::byte room_[kMostPatchRays * sizeof(LineTraversal)];
    LineTraversal* const ways_ = reinterpret_cast<LineTraversal*>(room_);
};

}  // namespace alhazen

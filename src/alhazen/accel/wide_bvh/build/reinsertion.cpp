#include "alhazen/accel/wide_bvh/build/reinsertion.h"

#include <algorithm>

#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;
/// Maximum number of nodes a search examines: five times the average in a mesh.
constexpr int kMaxVisits = 96;
constexpr int kMostPasses = 12;
/// Least gain of a pass, relative to the sum of the areas of inner nodes: after a smaller one ends.
constexpr double kLeastGain = 0.005;
constexpr std::size_t kGrain = 512;

struct Move {
    std::uint32_t node, target;  ///< the node becomes the sibling of the target
    float gain = 0;
};

class Optimizer {
  public:
    explicit Optimizer(DraftBvh& tree) : nodes_(tree.nodes), root_(tree.root) {
        parent_.assign(nodes_.size(), kNone);
        touched_.assign(nodes_.size(), 0);
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            if (nodes_[i].is_leaf()) continue;
            parent_[nodes_[i].left] = i;
            parent_[nodes_[i].right] = i;
        }
    }

    [[nodiscard]] double total_area() const {
        double sum = 0;
        for (const DraftNode& node : nodes_) {
            if (!node.is_leaf()) sum += static_cast<double>(node.box.weight());
        }
        return sum;
    }

    /// One pass over the `count` largest nodes.
    void pass(std::size_t count) {
        const std::vector<std::uint32_t> candidates = largest(count);
        std::vector<Move> moves(candidates.size());
        parallel_for(candidates.size(), kGrain, [&](std::size_t begin, std::size_t end) {
            Search search(*this);
            for (std::size_t i = begin; i < end; ++i) moves[i] = search.best(candidates[i]);
        });
        std::erase_if(moves, [](const Move& m) { return !(m.gain > 0); });
        std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
            return a.gain != b.gain ? a.gain > b.gain : a.node < b.node;
        });
        ++pass_;
        for (const Move& move : moves) apply(move);
    }

  private:
    /// Searches a new position for one subtree, from its own upward; best branches first.
    class Search {
      public:
        explicit Search(const Optimizer& tree) : tree_(tree) {}

        Move best(std::uint32_t x) {
            Move best{x, kNone};
            const auto& nodes = tree_.nodes_;
            const FloatBox box = nodes[x].box;
            const float area = box.weight();
            std::uint32_t below = x;
            std::uint32_t pivot = tree_.parent_[x];
            // The cost saved by removing x, up to the pivot.
            float saved = nodes[pivot].box.weight();
            FloatBox rest;  // the box of the pivot without x
            int visits = 0;
            for (bool first = true; visits < kMaxVisits; first = false, ++visits) {
                const std::uint32_t sibling = tree_.sibling(below);
                descend(sibling, saved, box, area, best, visits, first);
                rest.include(nodes[sibling].box);
                if (!first) saved += nodes[pivot].box.weight() - rest.weight();
                if (pivot == tree_.root_) break;
                below = pivot;
                pivot = tree_.parent_[pivot];
            }
            return best;
        }

      private:
        struct Branch {
            std::uint32_t node;
            float saved;
        };

        /// `own_sibling`: x is already its sibling; only positions below are new.
        void descend(std::uint32_t start, float saved, const FloatBox& box, float area, Move& best,
                     int& visits, bool own_sibling) {
            stack_.clear();
            stack_.push_back({start, saved});
            while (!stack_.empty() && visits < kMaxVisits) {
                const Branch top = stack_.back();
                stack_.pop_back();
                // Every position below costs at least the area of x.
                if (top.saved - area <= best.gain) continue;
                ++visits;
                const DraftNode& node = tree_.nodes_[top.node];
                FloatBox merged = node.box;
                merged.include(box);
                const float gain = top.saved - merged.weight();
                if (gain > best.gain && !(own_sibling && top.node == start)) {
                    best.gain = gain;
                    best.target = top.node;
                }
                if (node.is_leaf()) continue;
                const float below = gain + node.box.weight();
                push_children(node, below, box);
            }
        }
        /// The child that grows less is examined first.
        void push_children(const DraftNode& node, float saved, const FloatBox& box) {
            const auto growth = [&](std::uint32_t i) {
                FloatBox merged = tree_.nodes_[i].box;
                merged.include(box);
                return merged.weight() - tree_.nodes_[i].box.weight();
            };
            const bool left_first = growth(node.left) <= growth(node.right);
            stack_.push_back({left_first ? node.right : node.left, saved});
            stack_.push_back({left_first ? node.left : node.right, saved});
        }

        const Optimizer& tree_;
        std::vector<Branch> stack_;
    };

    [[nodiscard]] std::uint32_t sibling(std::uint32_t x) const {
        const DraftNode& p = nodes_[parent_[x]];
        return p.left == x ? p.right : p.left;
    }

    /// Nodes that may move, the largest first.
    [[nodiscard]] std::vector<std::uint32_t> largest(std::size_t count) const {
        struct Entry {
            float area;
            std::uint32_t node;
        };
        std::vector<Entry> entries;
        entries.reserve(nodes_.size());
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            if (i == root_ || parent_[i] == root_) continue;
            entries.push_back({nodes_[i].box.weight(), i});
        }
        const auto larger = [](const Entry& a, const Entry& b) {
            return a.area != b.area ? a.area > b.area : a.node < b.node;
        };
        count = std::min(count, entries.size());
        std::nth_element(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(count),
                         entries.end(), larger);
        std::vector<std::uint32_t> result(count);
        for (std::size_t i = 0; i < count; ++i) result[i] = entries[i].node;
        // Sorted, so that neighbors in the tree are searched consecutively.
        std::sort(result.begin(), result.end());
        return result;
    }

    void apply(const Move& move) {
        const std::uint32_t x = move.node, target = move.target;
        const std::uint32_t p = parent_[x], s = sibling(x), g = parent_[p], q = parent_[target];
        // The parent of x is reused as that of x and the target.
        if (target == p || target == s || q == kNone || g == kNone) return;
        for (const std::uint32_t i : {x, target, p, s, g, q}) {
            if (touched_[i] == pass_) return;
        }
        for (std::uint32_t i = target; i != kNone; i = parent_[i]) {
            if (i == x) return;  // an earlier move put the target below x
        }
        for (const std::uint32_t i : {x, target, p, s, g, q}) touched_[i] = pass_;
        replace_child(g, p, s);
        replace_child(q, target, p);
        nodes_[p].left = target;
        nodes_[p].right = x;
        parent_[target] = parent_[x] = p;
        refit_from(g);
        (void)refit(p);
        refit_from(q);
    }
    void replace_child(std::uint32_t parent, std::uint32_t from, std::uint32_t to) {
        DraftNode& node = nodes_[parent];
        (node.left == from ? node.left : node.right) = to;
        parent_[to] = parent;
    }
    /// Refits from a node with changed children upwards until a box is unchanged.
    void refit_from(std::uint32_t i) {
        while (i != kNone && refit(i)) i = parent_[i];
    }
    /// Returns true if the box changes.
    bool refit(std::uint32_t i) {
        FloatBox box = nodes_[nodes_[i].left].box;
        box.include(nodes_[nodes_[i].right].box);
        const bool changed = !(box == nodes_[i].box);
        nodes_[i].box = box;
        return changed;
    }

    std::vector<DraftNode>& nodes_;
    std::uint32_t root_;
    std::vector<std::uint32_t> parent_;
    std::vector<int> touched_;  ///< [node] the last pass that changed it
    int pass_ = 0;
};

}  // namespace

double reinsert(DraftBvh& tree) {
    if (tree.nodes.size() < 7) return 0;
    Optimizer optimizer(tree);
    const double before = optimizer.total_area();
    double area = before;
    for (int pass = 0; pass < kMostPasses; ++pass) {
        // First all nodes, then the larger half, where most of the gain remains.
        optimizer.pass(pass == 0 ? tree.nodes.size() : tree.nodes.size() / 2);
        const double now = optimizer.total_area();
        const bool done = !(now < area * (1 - kLeastGain));
        area = now;
        if (done) break;
    }
    return 1 - area / before;
}

}  // namespace alhazen

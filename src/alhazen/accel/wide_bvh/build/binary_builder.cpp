#include "alhazen/accel/wide_bvh/build/binary_builder.h"

#include <algorithm>
#include <atomic>

#include "alhazen/accel/wide_bvh/build/sah_split.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

/// Bound of the levels of nodes above a part: from kMaxSahLevel on sets are halved.
constexpr std::uint32_t kMostLevels = kMaxSahLevel + 32;

/// Stores nodes contiguously, although most subtrees have fewer nodes than their references allow:
/// a part of the tree built by one thread is copied to the end of the last one. The nodes above
/// whose leftmost part it is are stored right before it.
class Builder {
  public:
    Builder(std::span<BuildReference> references, const LeafKinds& kinds)
        : references_(references), kinds_(kinds) {}

    BinaryBvh build() {
        const auto count = static_cast<std::uint32_t>(references_.size());
        const std::uint32_t first = std::min(2 * count, kMostLevels + 2 * kParallelBuildSize);
        nodes_ = make_huge_array<BinaryNode>(2 * references_.size() + first);
        next_ = first;
        build(0, count, summarize(references_), 0, 0);
        return {std::move(nodes_), next_, false};
    }

  private:
    /// A part of the tree with its own node indices.
    struct Part {
        BinaryNode* nodes;
        std::uint32_t count = 0;
    };

    /// Returns the index of the root. `above`: number of nodes right before it.
    std::uint32_t build(std::uint32_t begin, std::uint32_t end, const RangeSummary& all, int level,
                        std::uint32_t above) {
        if (end - begin < kParallelBuildSize || all.indivisible(kinds_)) {
            return build_part(begin, end, all, level, above);
        }
        RangeSummary left, right;
        const std::uint32_t middle = begin + split(begin, end, all, level, left, right);
        std::uint32_t left_place = 0, right_place = 0;
        parallel_invoke([&] { left_place = build(begin, middle, left, level + 1, above + 1); },
                        [&] { right_place = build(middle, end, right, level + 1, 0); });
        const std::uint32_t place = left_place - 1;
        nodes_[place] = {all.box.box(), begin, end, right_place, all.kind()};
        return place;
    }

    std::uint32_t build_part(std::uint32_t begin, std::uint32_t end, const RangeSummary& all,
                             int level, std::uint32_t above) {
        const auto room = make_huge_array<BinaryNode>(2 * std::size_t{end - begin});
        Part part{room.get()};
        grow(part, begin, end, all, level);
        // The leftmost part and what is above it have the first places.
        const std::uint32_t place = above + (begin == 0 ? 0 : next_.fetch_add(above + part.count));
        for (std::uint32_t i = 0; i < part.count; ++i) {
            BinaryNode& node = nodes_[place + i];
            node = part.nodes[i];
            if (!node.is_leaf()) node.right += place;
        }
        return place;
    }

    void grow(Part& part, std::uint32_t begin, std::uint32_t end, const RangeSummary& all,
              int level) {
        BinaryNode& node = part.nodes[part.count++];
        node = {all.box.box(), begin, end, 0, all.kind()};
        if (all.indivisible(kinds_)) return;
        RangeSummary left, right;
        const std::uint32_t middle = begin + split(begin, end, all, level, left, right);
        grow(part, begin, middle, left, level + 1);
        node.right = part.count;
        grow(part, middle, end, right, level + 1);
    }

    /// Divides a range into two nonempty ones; returns the size of the left one.
    std::uint32_t split(std::uint32_t begin, std::uint32_t end, const RangeSummary& all, int level,
                        RangeSummary& left, RangeSummary& right) {
        const std::span<BuildReference> range = references_.subspan(begin, end - begin);
        if (level < kMaxSahLevel) {
            const ObjectSplit best = best_object_split(range, all, kinds_);
            if (best.axis >= 0) return divide(range, all, best, left, right);
        }
        return divide_evenly(range, all, left, right);
    }

    std::span<BuildReference> references_;
    LeafKinds kinds_;
    HugeArray<BinaryNode> nodes_;
    std::atomic<std::uint32_t> next_{0};
};

}  // namespace

BinaryBvh build_binary(std::span<BuildReference> references, const LeafKinds& kinds) {
    if (references.empty()) return {};
    return Builder(references, kinds).build();
}

}  // namespace alhazen

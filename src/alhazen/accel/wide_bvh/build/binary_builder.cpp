#include "alhazen/accel/wide_bvh/build/binary_builder.h"

#include "alhazen/accel/wide_bvh/build/sah_split.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

class Builder {
  public:
    Builder(std::span<BuildReference> references, const LeafKinds& kinds)
        : references_(references),
          kinds_(kinds),
          nodes_(make_huge_array<BinaryNode>(2 * references.size())) {}

    BinaryBvh build() {
        build(0, static_cast<std::uint32_t>(references_.size()), summarize(references_), 0, 0);
        return {std::move(nodes_), static_cast<std::uint32_t>(2 * references_.size()), false};
    }

  private:
    /// Subtrees of n references use 2 n - 1 consecutive nodes: indices do not depend on threads.
    void build(std::uint32_t begin, std::uint32_t end, const RangeSummary& all, std::uint32_t index,
               int level) {
        BinaryNode& node = nodes_[index];
        node = {all.box.box(), begin, end, 0, all.kind()};
        if (all.indivisible(kinds_)) return;
        RangeSummary left, right;
        const std::uint32_t middle = begin + split(begin, end, all, level, left, right);
        const std::uint32_t right_index = index + 2 * (middle - begin);
        node.right = right_index;
        const auto build_left = [&] { build(begin, middle, left, index + 1, level + 1); };
        const auto build_right = [&] { build(middle, end, right, right_index, level + 1); };
        if (end - begin >= kParallelBuildSize) {
            parallel_invoke(build_left, build_right);
        } else {
            build_left();
            build_right();
        }
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
};

}  // namespace

BinaryBvh build_binary(std::vector<BuildReference>& references, const LeafKinds& kinds) {
    if (references.empty()) return {};
    return Builder(references, kinds).build();
}

}  // namespace alhazen

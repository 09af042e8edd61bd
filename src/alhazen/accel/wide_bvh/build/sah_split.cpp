#include "alhazen/accel/wide_bvh/build/sah_split.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "alhazen/accel/wide_bvh/build/partition.h"
#include "alhazen/accel/wide_bvh/build/reference_chunks.h"

namespace alhazen {
namespace {

bool before(const BuildReference& a, const BuildReference& b, int axis) {
    const float ca = a.center2(axis);
    const float cb = b.center2(axis);
    return ca != cb ? ca < cb : a.id < b.id;
}

/// Precondition: `out` is empty.
void summarize_some(std::span<const BuildReference> references, RangeSummary& out) {
    // Separate from the counts, so that the boxes stay in registers.
    Box4 box, centers;
    KindCounts count{};
    for (const BuildReference& r : references) {
        const Box4 b(r);
        box.include(b);
        centers.include_point(b.center2());
        ++count[r.kind];
    }
    out.box = box;
    out.centers = centers;
    out.count = count;
}

void summarize_both(std::span<const BuildReference> references, std::uint32_t middle,
                    RangeSummary& left, RangeSummary& right) {
    summarize_some(references.first(middle), left);
    summarize_some(references.subspan(middle), right);
}

Box4 box_of_centers(std::span<const BuildReference> references) {
    Box4 centers;
    for (const BuildReference& r : references) centers.include_point(Box4(r).center2());
    return centers;
}

/// Summarizes sides whose boxes are known from the split, but for their centers.
void summarize_sides(std::span<const BuildReference> references, const RangeSummary& all,
                     const ObjectSplit& split, std::uint32_t middle, RangeSummary& left,
                     RangeSummary& right) {
    const std::uint32_t only = all.kind();
    if (only == kLeafKinds) return summarize_both(references, middle, left, right);
    left.box = split.left;
    right.box = split.right;
    left.count[only] = middle;
    right.count[only] = static_cast<std::uint32_t>(references.size()) - middle;
}

}  // namespace

RangeSummary summarize(std::span<const BuildReference> references) {
    RangeSummary all;
    for_chunks<RangeSummary>(
        references,
        [](RangeSummary& some, std::span<const BuildReference> part) {
            summarize_some(part, some);
        },
        [](RangeSummary& sum, const RangeSummary& part) { sum.include(part); }, all);
    return all;
}

ObjectSplit best_object_split(std::span<const BuildReference> references, const RangeSummary& all,
                              const LeafKinds& kinds) {
    return references.size() <= kSweepSize ? split_by_sweeps(references, all, kinds)
                                           : split_by_bins(references, all, kinds);
}

std::uint32_t divide(std::span<BuildReference> references, const RangeSummary& all,
                     const ObjectSplit& split, RangeSummary& left, RangeSummary& right) {
    std::uint32_t middle = 0;
    if (references.size() <= kSweepSize) {
        std::array<BuildReference, kSweepSize> before;
        std::copy(references.begin(), references.end(), before.begin());
        for (std::size_t i = 0; i < references.size(); ++i) references[i] = before[split.places[i]];
        middle = static_cast<std::uint32_t>(split.last_left) + 1;
        left.centers = box_of_centers(references.first(middle));
        right.centers = box_of_centers(references.subspan(middle));
    } else {
        middle = partition_by_bins(references, all, split, left.centers, right.centers);
    }
    summarize_sides(references, all, split, middle, left, right);
    return middle;
}

std::uint32_t divide_evenly(std::span<BuildReference> references, const RangeSummary& all,
                            RangeSummary& left, RangeSummary& right) {
    if (all.kind() == kLeafKinds) {
        std::uint32_t lowest = 0;
        while (all.count[lowest] == 0) ++lowest;
        const std::uint32_t middle =
            partition(references, [&](const BuildReference& r) { return r.kind == lowest; });
        summarize_both(references, middle, left, right);
        return middle;
    }
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
        const auto extent = [&](int a) { return all.centers.hi[a] - all.centers.lo[a]; };
        if (extent(k) > extent(axis)) axis = k;
    }
    const auto middle = static_cast<std::uint32_t>(references.size() / 2);
    std::nth_element(
        references.begin(), references.begin() + middle, references.end(),
        [axis](const BuildReference& a, const BuildReference& b) { return before(a, b, axis); });
    summarize_both(references, middle, left, right);
    return middle;
}

}  // namespace alhazen

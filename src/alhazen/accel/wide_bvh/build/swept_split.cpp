#include <array>
#include <cstddef>

#include "alhazen/accel/wide_bvh/build/sah_split.h"
#include "alhazen/accel/wide_bvh/build/split_kernels.h"

namespace alhazen {
namespace {

/// A stable sort that compares all pairs without branches, as comparisons are unpredictable.
void sort_places(const BuildReference* references, std::size_t size, SweepPlaces& places) {
    Float4 center[kSweepSize];
    Int4 rank[kSweepSize];
    for (std::size_t i = 0; i < size; ++i) {
        const Float4 here = Box4(references[i]).center2();
        center[i] = here;
        Int4 sooner = Int4{} + static_cast<int>(i);
        for (std::size_t k = 0; k < i; ++k) {
            const Int4 later = here < center[k];  // -1 where true
            rank[k] -= later;
            sooner += later;
        }
        rank[i] = sooner;
    }
    for (std::size_t i = 0; i < size; ++i) {
        const auto number = static_cast<std::uint8_t>(i);
        places[0][static_cast<std::size_t>(rank[i][0])] = number;
        places[1][static_cast<std::size_t>(rank[i][1])] = number;
        places[2][static_cast<std::size_t>(rank[i][2])] = number;
    }
}

/// The best split of a few references of several kinds.
ObjectSplit sweep_mixed(const BuildReference* references, std::size_t size, const SweepPlaces& places,
                        const RangeSummary& all, const LeafKinds& kinds) {
    ObjectSplit best;
    const SideCost cost{kinds};
    for (int axis = 0; axis < 3; ++axis) {
        if (!(all.centers.hi[axis] > all.centers.lo[axis])) continue;
        const auto& order = places[static_cast<std::size_t>(axis)];
        float right_cost[kSweepSize];
        Box4 right_box[kSweepSize];
        KindBox right;
        for (std::size_t i = size - 1; i > 0; --i) {
            right.box.include(Box4(references[order[i]]));
            ++right.count[references[order[i]].kind];
            right_box[i] = right.box;
            right_cost[i] = cost(right.box, right.count);
        }
        KindBox left;
        for (std::size_t i = 0; i + 1 < size; ++i) {
            left.box.include(Box4(references[order[i]]));
            ++left.count[references[order[i]].kind];
            const float sum = cost(left.box, left.count) + right_cost[i + 1];
            if (sum < best.cost) {
                best = {sum, axis, static_cast<int>(i), left.box, right_box[i + 1], {}};
            }
        }
    }
    return best;
}

}  // namespace

ObjectSplit split_by_sweeps(std::span<const BuildReference> references, const RangeSummary& all,
                            const LeafKinds& kinds) {
    SweepPlaces places;
    sort_places(references.data(), references.size(), places);
    const std::uint32_t only = all.kind();
    ObjectSplit best =
        only == kLeafKinds
            ? sweep_mixed(references.data(), references.size(), places, all, kinds)
            : split_kernels().sweep(references.data(), references.size(), places,
                                    all.centers.hi > all.centers.lo, kinds[only]);
    if (best.axis >= 0) best.places = places[static_cast<std::size_t>(best.axis)];
    return best;
}

}  // namespace alhazen

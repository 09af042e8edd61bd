#pragma once
/// Sums over references, large sets in parallel with the same result for every number of threads.

#include <cstddef>
#include <span>
#include <vector>

#include "alhazen/accel/wide_bvh/build/build_types.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {

inline constexpr std::size_t kReferenceChunk = 32768;  ///< references read by one task

/// Calls add(total, part) for a small set; for a large one in parallel on parts, each starting as a
/// copy of `total`, combined by `merge` in order.
template <class T, class Add, class Merge>
void for_chunks(std::span<const BuildReference> all, const Add& add, const Merge& merge, T& total) {
    if (all.size() <= 2 * kReferenceChunk) return add(total, all);
    std::vector<T> parts((all.size() - 1) / kReferenceChunk + 1, total);
    parallel_for(all.size(), kReferenceChunk, [&](std::size_t i, std::size_t j) {
        add(parts[i / kReferenceChunk], all.subspan(i, j - i));
    });
    for (const T& part : parts) merge(total, part);
}

}  // namespace alhazen

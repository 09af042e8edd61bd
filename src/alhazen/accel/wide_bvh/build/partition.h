#pragma once
/// Partitions references by a test.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "alhazen/accel/wide_bvh/build/box4.h"
#include "alhazen/accel/wide_bvh/build/build_types.h"

namespace alhazen {

/// Moves the references with is_left(r) to the front and returns their number. Swaps every
/// reference, possibly with itself, without branches, as the side is unpredictable.
template <class IsLeft>
std::uint32_t partition(std::span<BuildReference> references, const IsLeft& is_left) {
    BuildReference* middle = references.data();
    for (BuildReference& place : references) {
        const Box4 here(place), there(*middle);
        BuildReference* const to = middle;
        middle += static_cast<std::ptrdiff_t>(is_left(place));
        std::memcpy(place.lo, &there.lo, sizeof(there.lo));
        std::memcpy(place.hi, &there.hi, sizeof(there.hi));
        std::memcpy(to->lo, &here.lo, sizeof(here.lo));
        std::memcpy(to->hi, &here.hi, sizeof(here.hi));
    }
    return static_cast<std::uint32_t>(middle - references.data());
}

}  // namespace alhazen

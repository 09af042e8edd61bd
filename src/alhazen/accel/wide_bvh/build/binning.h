#pragma once
/// Bins of the centers of references along all axes.

#include <cstdint>
#include <cstring>

#include "alhazen/accel/wide_bvh/build/axis_splits.h"

namespace alhazen {

inline constexpr int kMaxBins = 32;

/// Sets the fourth lane to 0.
inline Float4 first_three(Float4 v) {
    Int4 bits;
    std::memcpy(&bits, &v, sizeof(bits));
    bits &= Int4{-1, -1, -1, 0};
    std::memcpy(&v, &bits, sizeof(v));
    return v;
}

/// The bins of a center; counting and dividing use the same numbers.
struct Binning {
    int bins;
    Float4 lo, scale, most;

    explicit Binning(const RangeSummary& all) : lo(first_three(all.centers.lo)) {
        const std::uint32_t size = all.size();
        bins = size < 64 ? 8 : size < 1024 ? 16 : kMaxBins;
        for (int k = 0; k < 3; ++k) {
            const float extent = all.centers.hi[k] - all.centers.lo[k];
            // A set too thin to divide has one bin.
            const float s = static_cast<float>(bins) * (1.0f - 1e-6f) / extent;
            scale[k] = extent > 0.0f && s < 1e37f ? s : 0.0f;
        }
        scale[3] = 0;
        most = Float4{1, 1, 1, 1} * static_cast<float>(bins - 1);
    }
    [[nodiscard]] Int4 bin(Float4 center2) const {
        const Float4 place = (first_three(center2) - lo) * scale;
        return __builtin_convertvector(lesser(place, most), Int4);
    }
};

}  // namespace alhazen

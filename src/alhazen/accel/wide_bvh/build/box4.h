#pragma once
/// Boxes of builders, in two registers of four floats.

#include <cstring>
#include <limits>

#include "alhazen/accel/wide_bvh/build/build_types.h"
#include "alhazen/simd/registers.h"

namespace alhazen {

/// A box; the fourth lane is unused.
struct Box4 {
    Float4 lo, hi;

    Box4() {
        constexpr float kInf = std::numeric_limits<float>::infinity();
        lo = Float4{kInf, kInf, kInf, kInf};
        hi = -lo;
    }
    explicit Box4(const BuildReference& r) {
        std::memcpy(&lo, r.lo, sizeof(lo));
        std::memcpy(&hi, r.hi, sizeof(hi));
    }
    explicit Box4(const FloatBox& box)
        : lo{box.lo[0], box.lo[1], box.lo[2], 0}, hi{box.hi[0], box.hi[1], box.hi[2], 0} {}
    void include(const Box4& b) {
        lo = lesser(b.lo, lo);
        hi = greater(b.hi, hi);
    }
    void include_point(Float4 p) {
        lo = lesser(p, lo);
        hi = greater(p, hi);
    }
    [[nodiscard]] Float4 center2() const { return lo + hi; }
    [[nodiscard]] FloatBox box() const {
        return FloatBox{{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
    }
    /// As FloatBox::weight.
    [[nodiscard]] float weight() const {
        const Float4 d = hi - lo;
        return d[0] * d[1] + d[1] * d[2] + d[2] * d[0] + 1e-6f * (d[0] + d[1] + d[2]) + 1e-12f;
    }
};

}  // namespace alhazen

#include "alhazen/primitives/triangle_run.h"

#include <algorithm>
#include <limits>

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/primitives/triangle_run.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

/// Includes the boxes of the triangles in `all`; `corner(i)`: position i, as `Box` takes it.
/// Returns false if a triangle has no box.
template <class Box, class Corner>
HWY_INLINE bool include_triangles(const TriangleRun& run, const Corner& corner, Box& all) {
    constexpr std::size_t kAhead = 8;  // triangles prefetched
    bool complete = true;
    for (std::size_t i = 0; i < run.count; ++i) {
        const auto& ahead = run.triangles[std::min(i + kAhead, run.count - 1)];
        __builtin_prefetch(run.positions + ahead[0]);
        __builtin_prefetch(run.positions + ahead[1]);
        __builtin_prefetch(run.positions + ahead[2]);
        const auto& corners = run.triangles[i];
        Box one;
        if (one.set(corner(corners[0]), corner(corners[1]), corner(corners[2]))) {
            all.include(one);
        } else {
            complete = false;
        }
    }
    return complete;
}

#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2

/// A box as TriangleBounds; the fourth lane is 0.
struct RunBox {
    __m256d lo, hi;

    HWY_INLINE RunBox() {
        lo = _mm256_set1_pd(std::numeric_limits<double>::infinity());
        hi = _mm256_set1_pd(-std::numeric_limits<double>::infinity());
    }
    // The second operand is taken where the first is no number.
    HWY_INLINE void include(__m256d p) {
        lo = _mm256_min_pd(p, lo);
        hi = _mm256_max_pd(p, hi);
    }
    HWY_INLINE void include(const RunBox& b) {
        lo = _mm256_min_pd(b.lo, lo);
        hi = _mm256_max_pd(b.hi, hi);
    }
    /// As TriangleBounds::set.
    HWY_INLINE bool set(__m256d a, __m256d b, __m256d c) {
        const __m256d ab = _mm256_cmp_pd(a, b, _CMP_EQ_OQ), bc = _mm256_cmp_pd(b, c, _CMP_EQ_OQ),
                      ca = _mm256_cmp_pd(c, a, _CMP_EQ_OQ);
        if (_mm256_movemask_pd(_mm256_or_pd(_mm256_or_pd(ab, bc), ca)) == 15 &&
            (_mm256_movemask_pd(ab) == 15 || _mm256_movemask_pd(bc) == 15 ||
             _mm256_movemask_pd(ca) == 15)) {
            return false;
        }
        include(a);
        include(b);
        include(c);
        if (_mm256_movemask_pd(_mm256_cmp_pd(lo, hi, _CMP_LE_OQ)) != 15) return false;
        const __m256d sign = _mm256_set1_pd(-0.0);
        const __m256d far = _mm256_max_pd(_mm256_andnot_pd(sign, lo), _mm256_andnot_pd(sign, hi));
        const __m256d margin = _mm256_mul_pd(_mm256_set1_pd(TriangleBounds::kPadding), far);
        lo = _mm256_sub_pd(lo, margin);
        hi = _mm256_add_pd(hi, margin);
        return true;
    }
};

bool include_run_of_target(const TriangleRun& run, TriangleBounds& all) {
    const __m256i three = _mm256_set_epi64x(0, -1, -1, -1);
    const auto corner = [&](std::uint32_t i)
                            HWY_ATTR { return _mm256_maskload_pd(&run.positions[i].x, three); };
    RunBox box;
    const bool complete = include_triangles(run, corner, box);
    double lo[4], hi[4];
    _mm256_storeu_pd(lo, box.lo);
    _mm256_storeu_pd(hi, box.hi);
    TriangleBounds sum;
    sum.lower = Double2{lo[0], lo[1]};
    sum.upper = Double2{hi[0], hi[1]};
    sum.deep = Double2{lo[2], -hi[2]};
    all.include(sum);
    return complete;
}

#else

bool include_run_of_target(const TriangleRun& run, TriangleBounds& all) {
    const auto corner = [&](std::uint32_t i) HWY_ATTR { return run.positions[i]; };
    TriangleBounds box;
    const bool complete = include_triangles(run, corner, box);
    all.include(box);
    return complete;
}

#endif

}  // namespace

IncludeRun chosen_include_run() {
    return &include_run_of_target;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(chosen_include_run);

IncludeRun include_run() {
    return ALHAZEN_KERNEL(chosen_include_run)();
}

}  // namespace alhazen
#endif

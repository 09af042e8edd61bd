#pragma once
/// Boxes of triangles in the frame of a tree, equal to LocalFrame::local, in registers.

#include <cstring>

#include "alhazen/accel/wide_bvh/build/build_types.h"
#include "alhazen/accel/wide_bvh/nodes/local_frame.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/primitives/triangle_bounds.h"

namespace alhazen {

/// Makes references to triangles, with the same boxes as the generic code.
class TriangleReferences {
  public:
    explicit TriangleReferences(const LocalFrame& frame)
        : frame_(frame),
          scale_{frame.scale, frame.scale},
          center_{frame.center.x, frame.center.y},
          deep_center_{frame.center.z, -frame.center.z} {}

    void operator()(const TriangleBounds& bounds, std::uint32_t id, BuildReference& to) const {
#ifdef __SSE2__
        const Double2 lower = scale_ * (bounds.lower - center_);
        const Double2 deep = scale_ * (bounds.deep - deep_center_);
        const Double2 less_upper = scale_ * (center_ - bounds.upper);
        const __m128 low = _mm_cvtpd_ps(lower), mid = _mm_cvtpd_ps(deep),
                     high = _mm_cvtpd_ps(less_upper);
        const __m128 low_above = above(low, lower), mid_above = above(mid, deep),
                     high_above = above(high, less_upper);
        const __m128 lo =
            rounded_down(_mm_shuffle_ps(low, mid, _MM_SHUFFLE(1, 0, 1, 0)),
                         _mm_shuffle_ps(low_above, mid_above, _MM_SHUFFLE(2, 0, 2, 0)));
        const __m128 hi =
            rounded_down(_mm_shuffle_ps(high, mid, _MM_SHUFFLE(1, 1, 1, 0)),
                         _mm_shuffle_ps(high_above, mid_above, _MM_SHUFFLE(2, 2, 2, 0)));
        // Kept in registers: loading what was stored in parts is slow.
        const auto number = static_cast<std::int32_t>(id);
        // Not by the sign bit: zero is positive, as in LocalFrame::local, except for corners of -0.
        const __m128 up = _mm_sub_ps(_mm_setzero_ps(), hi);
        const __m128i low_part = with_fourth(lo, number), high_part = with_fourth(up, kKind);
        std::memcpy(to.lo, &low_part, sizeof(low_part));
        std::memcpy(to.hi, &high_part, sizeof(high_part));
#else
        to = {frame_.local(bounds.box()), id, kKind};
#endif
    }

  private:
    static constexpr auto kKind = static_cast<std::uint32_t>(LeafType::Triangles);

#ifdef __SSE2__
    static __m128i with_fourth(__m128 v, std::int32_t fourth) {
        const __m128i three = _mm_and_si128(_mm_castps_si128(v), _mm_set_epi32(0, -1, -1, -1));
        return _mm_or_si128(three, _mm_slli_si128(_mm_cvtsi32_si128(fourth), 12));
    }
    /// A mask of the lanes, each twice, that were rounded up to float.
    static __m128 above(__m128 rounded, Double2 exact) {
        return _mm_castpd_ps(_mm_cmpgt_pd(_mm_cvtps_pd(rounded), exact));
    }
    /// As round_down, where `above` marks the lanes of `v` to lower by a step. Such a lane is never
    /// +0: a number rounded up to zero keeps its sign.
    static __m128 rounded_down(__m128 v, __m128 above) {
        const __m128i positive = _mm_castps_si128(_mm_cmpgt_ps(v, _mm_setzero_ps()));
        const __m128i step = _mm_or_si128(positive, _mm_set1_epi32(1));
        return _mm_castsi128_ps(
            _mm_add_epi32(_mm_castps_si128(v), _mm_and_si128(step, _mm_castps_si128(above))));
    }
#endif

    LocalFrame frame_;
    Double2 scale_, center_, deep_center_;
};

}  // namespace alhazen

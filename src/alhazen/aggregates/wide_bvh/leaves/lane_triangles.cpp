#include "alhazen/aggregates/wide_bvh/leaves/lane_triangles.h"

#include <cmath>
#include <cstring>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_fill.h"
#include "alhazen/primitives/triangle_bounds.h"
#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/aggregates/wide_bvh/leaves/lane_triangles.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

/// Beyond the local coordinates of all bounded primitives; within those of floats. Vertices without
/// a bounded triangle may be anywhere.
constexpr double kBeyond = 64;

#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2

constexpr std::uint32_t kLanes = 8;
using Floats = float __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(32)));
constexpr Ints kLaneNumbers{0, 1, 2, 3, 4, 5, 6, 7};

HWY_INLINE Floats least(Floats a, Floats b) {
    return _mm256_min_ps(a, b);
}
HWY_INLINE Floats most(Floats a, Floats b) {
    return _mm256_max_ps(a, b);
}
HWY_INLINE Floats square_roots(Floats v) {
    return _mm256_sqrt_ps(v);
}
HWY_INLINE Float4 low_half(Floats v) {
    return __builtin_shufflevector(v, v, 0, 1, 2, 3);
}
HWY_INLINE Float4 high_half(Floats v) {
    return __builtin_shufflevector(v, v, 4, 5, 6, 7);
}

/// Vertices of triangles i and i + 4.
HWY_INLINE Floats vertices(const Float4* const* corner, std::size_t i) {
    return __builtin_shufflevector(*corner[i], *corner[i + 4], 0, 1, 2, 3, 4, 5, 6, 7);
}
// Of each half, as unpcklps, unpckhps, unpcklpd and unpckhpd.
HWY_INLINE Floats zip_low(Floats a, Floats b) {
    return __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
}
HWY_INLINE Floats zip_high(Floats a, Floats b) {
    return __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
}
HWY_INLINE Floats join_low(Floats a, Floats b) {
    return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
}
HWY_INLINE Floats join_high(Floats a, Floats b) {
    return __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
}

/// Rounds vertices to the frame.
class VertexRounding {
  public:
    HWY_INLINE explicit VertexRounding(const LocalFrame& frame)
        : scale_(_mm256_set1_pd(frame.scale)),
          inverse_(_mm256_set1_pd(frame.inverse_scale)),
          center_(_mm256_set_pd(0, frame.center.z, frame.center.y, frame.center.x)),
          beyond_(_mm256_set1_pd(kBeyond * frame.inverse_scale)),
          behind_(_mm256_set1_pd(-kBeyond * frame.inverse_scale)) {}

    [[nodiscard]] HWY_INLINE Float4 operator()(const Vec3& p) const {
        const __m256d world = _mm256_maskload_pd(&p.x, _mm256_set_epi64x(0, -1, -1, -1));
        const __m256d near =
            _mm256_max_pd(_mm256_min_pd(_mm256_sub_pd(world, center_), beyond_), behind_);
        const __m128 local = _mm256_cvtpd_ps(_mm256_mul_pd(scale_, near));
        const __m256d back =
            _mm256_add_pd(_mm256_mul_pd(inverse_, _mm256_cvtps_pd(local)), center_);
        const __m256i differ =
            _mm256_xor_si256(_mm256_castpd_si256(world), _mm256_castpd_si256(back));
        const std::int32_t one = -_mm256_testz_si256(differ, differ) & 0x3F800000;
        return _mm_castsi128_ps(_mm_insert_epi32(_mm_castps_si128(local), one, 3));
    }

  private:
    __m256d scale_, inverse_, center_, beyond_, behind_;
};

#else

constexpr std::uint32_t kLanes = 4;
using Floats = Float4;
using Ints = std::int32_t __attribute__((vector_size(16)));
constexpr Ints kLaneNumbers{0, 1, 2, 3};

/// Rounds vertices to the frame.
class VertexRounding {
  public:
    HWY_INLINE explicit VertexRounding(const LocalFrame& frame)
        : scale_{frame.scale, frame.scale},
          inverse_{frame.inverse_scale, frame.inverse_scale},
          across_{frame.center.x, frame.center.y},
          deep_{frame.center.z, frame.center.z},
          beyond_(kBeyond * inverse_) {}

    [[nodiscard]] HWY_INLINE Float4 operator()(const Vec3& p) const {
        const alhazen::PointLanes lanes(p);  // other kernels have another one
        const Double2 z{lanes.z, lanes.z};
        const Double2 across = local(lanes.xy, across_), deep = local(z, deep_);
#ifdef __SSE2__
        const __m128 low = _mm_cvtpd_ps(across), high = _mm_cvtpd_ps(deep);
        const __m128i differ = _mm_or_si128(changed(lanes.xy, _mm_cvtps_pd(low), across_),
                                            changed(z, _mm_cvtps_pd(high), deep_));
        const __m128i same = _mm_cmpeq_epi32(differ, _mm_setzero_si128());
        const __m128i half = _mm_and_si128(same, _mm_shuffle_epi32(same, _MM_SHUFFLE(1, 0, 3, 2)));
        const __m128i exact = _mm_and_si128(half, _mm_shuffle_epi32(half, _MM_SHUFFLE(2, 3, 0, 1)));
        const __m128i coordinates = _mm_castps_si128(_mm_movelh_ps(low, high));
        const Ints first{-1, -1, -1, 0}, one{0, 0, 0, 0x3F800000};
        return _mm_castsi128_ps(_mm_or_si128(_mm_and_si128(coordinates, (__m128i)first),
                                             _mm_and_si128(exact, (__m128i)one)));
#else
        float x0, y0, z0, z1;
        const bool exact = round(lanes.xy, across, across_, x0, y0) & round(z, deep, deep_, z0, z1);
        return Float4{x0, y0, z0, exact ? 1.0f : 0.0f};
#endif
    }

  private:
    [[nodiscard]] HWY_INLINE Double2 local(Double2 world, Double2 center) const {
        return scale_ * greater(lesser(world - center, beyond_), -beyond_);
    }
#ifdef __SSE2__
    /// Bits that differ where a rounded coordinate is not exact.
    [[nodiscard]] HWY_INLINE __m128i changed(Double2 world, Double2 rounded, Double2 center) const {
        const Double2 back = inverse_ * rounded + center;
        return _mm_xor_si128(_mm_castpd_si128(world), _mm_castpd_si128(back));
    }
#else
    /// Rounds two coordinates; true if they are exact.
    [[nodiscard]] HWY_INLINE bool round(Double2 world, Double2 local, Double2 center, float& first,
                                        float& second) const {
        first = static_cast<float>(local[0]);
        second = static_cast<float>(local[1]);
        const Double2 rounded{static_cast<double>(first), static_cast<double>(second)};
        const Double2 back = inverse_ * rounded + center;
        std::uint64_t was[2], is[2];
        std::memcpy(was, &world, sizeof(was));
        std::memcpy(is, &back, sizeof(is));
        return ((was[0] ^ is[0]) | (was[1] ^ is[1])) == 0;
    }
#endif

    Double2 scale_, inverse_, across_, deep_, beyond_;
};

HWY_INLINE Floats least(Floats a, Floats b) {
    return lesser(a, b);
}
HWY_INLINE Floats most(Floats a, Floats b) {
    return greater(a, b);
}
HWY_INLINE Floats square_roots(Floats v) {
#ifdef __SSE2__
    return _mm_sqrt_ps(v);
#else
    return Floats{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
#endif
}

HWY_INLINE Floats vertices(const Float4* const* corner, std::size_t i) {
    return *corner[i];
}
HWY_INLINE Floats zip_low(Floats a, Floats b) {
    return __builtin_shufflevector(a, b, 0, 4, 1, 5);
}
HWY_INLINE Floats zip_high(Floats a, Floats b) {
    return __builtin_shufflevector(a, b, 2, 6, 3, 7);
}
HWY_INLINE Floats join_low(Floats a, Floats b) {
    return __builtin_shufflevector(a, b, 0, 1, 4, 5);
}
HWY_INLINE Floats join_high(Floats a, Floats b) {
    return __builtin_shufflevector(a, b, 2, 3, 6, 7);
}

#endif

HWY_INLINE Ints bits_of(Floats v) {
    Ints bits;
    std::memcpy(&bits, &v, sizeof(bits));
    return bits;
}
HWY_INLINE Floats floats_of(Ints bits) {
    Floats v;
    std::memcpy(&v, &bits, sizeof(v));
    return v;
}

/// A corner of some triangles: its coordinates, and 1 where they are exact.
struct Corners {
    Floats x, y, z, exact;

    /// Includes the corners in a box.
    HWY_INLINE Corners(const Float4* const* corner, Floats& lo, Floats& hi) {
        const Floats a = vertices(corner, 0), b = vertices(corner, 1), c = vertices(corner, 2),
                     d = vertices(corner, 3);
        lo = least(least(least(a, b), least(c, d)), lo);
        hi = most(most(most(a, b), most(c, d)), hi);
        const Floats ab = zip_low(a, b), cd = zip_low(c, d);
        const Floats ab_high = zip_high(a, b), cd_high = zip_high(c, d);
        x = join_low(ab, cd);
        y = join_high(ab, cd);
        z = join_low(ab_high, cd_high);
        exact = join_high(ab_high, cd_high);
    }
    /// Unused lanes have a point far outside the scene.
    HWY_INLINE void store(float (&rows)[3][kBlockWidth], std::size_t lane, Ints used,
                          const float (&far)[3]) const {
        const Floats row[3] = {x, y, z};
#pragma GCC unroll 3
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Ints point = bits_of(Floats{} + far[axis]);
            const Ints v = (used & bits_of(row[axis])) | (~used & point);
            std::memcpy(rows[axis] + lane, &v, sizeof(v));
        }
    }
};

/// Twice the areas of triangles.
HWY_INLINE Floats double_areas(const Corners& a, const Corners& b, const Corners& c) {
    const Floats ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const Floats vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const Floats nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    return square_roots(nx * nx + ny * ny + nz * nz);
}

/// The weights of double_areas of lanes with these ids.
HWY_INLINE Floats area_weights(Ints ids, Ints used) {
    // The bits of 0.5; those of 0.25 differ in one, which is cleared unless the lane is opaque.
    const Ints half = bits_of(Floats{} + 0.5f);
    const Ints step = half - bits_of(Floats{} + 0.25f);
    const Ints opaque = ids < 0;
    return floats_of(used & (half - (step & ~opaque)));
}

LaneExtent fill_lanes(TriangleBlock* block, const LaneTriangles& triangles) {
    static_assert(kBlockWidth % kLanes == 0 && BlockId::kExactBit == 1u << 30);
    Floats lo = Floats{} + std::numeric_limits<float>::infinity(), hi = -lo;
    Floats areas[kBlockWidth / kLanes];
#pragma GCC unroll 2
    for (std::uint32_t lane = 0; lane < kBlockWidth; lane += kLanes) {
        const Corners a(triangles.corner[0] + lane, lo, hi);
        const Corners b(triangles.corner[1] + lane, lo, hi);
        const Corners c(triangles.corner[2] + lane, lo, hi);
        const Ints used = kLaneNumbers < static_cast<std::int32_t>(triangles.count) -
                                             static_cast<std::int32_t>(lane);
        Ints ids;
        std::memcpy(&ids, triangles.ids + lane, sizeof(ids));
        areas[lane / kLanes] = double_areas(a, b, c) * area_weights(ids, used);
        if (block == nullptr) continue;
        a.store(block->vertex[0], lane, used, kUnusedTriangle[0]);
        b.store(block->vertex[1], lane, used, kUnusedTriangle[1]);
        c.store(block->vertex[2], lane, used, kUnusedTriangle[2]);
        // 1.0f has bit 29, the lesser neighbor of the flag. BlockId::none has all bits.
        const Ints exact = bits_of(a.exact) & bits_of(b.exact) & bits_of(c.exact);
        ids |= (exact & (1 << 29)) << 1 | ~used;
        std::memcpy(static_cast<void*>(block->ids + lane), &ids, sizeof(ids));
    }
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
    const Float4 area = low_half(areas[0]) + high_half(areas[0]);
    return {lesser(low_half(lo), high_half(lo)), greater(low_half(hi), high_half(hi)),
            (area[0] + area[1]) + (area[2] + area[3])};
#else
    const Float4 area = areas[0] + areas[1];
    return {lo, hi, (area[0] + area[1]) + (area[2] + area[3])};
#endif
}

void round_vertices(const LocalFrame& frame, const Vec3* from, std::size_t count, Float4* to) {
    const VertexRounding rounded(frame);
    for (std::size_t i = 0; i < count; ++i) to[i] = rounded(from[i]);
}

}  // namespace

const LaneKernels& lane_kernels_of_target() {
    static constexpr LaneKernels kKernels{&round_vertices, &fill_lanes};
    return kKernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(lane_kernels_of_target);

const LaneKernels& lane_kernels() {
    return ALHAZEN_KERNEL(lane_kernels_of_target)();
}

}  // namespace alhazen
#endif

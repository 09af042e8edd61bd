/// The rays of a batch as they are given, an array of `Ray` or columns of floats, and their numbers
/// in the local frame, in lanes: what a packet in lanes is made from.
///
/// Conventions: included once per target (see simd/lanes-inl.h). What is not scaled keeps its bits.

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_GIVEN_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_GIVEN_RAYS_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_GIVEN_RAYS_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_GIVEN_RAYS_INL_H_
#endif

#include <hwy/cache_control.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "alhazen/accel/wide_bvh/nodes/local_frame.h"
#include "alhazen/accel/wide_bvh/trace/ray_group-inl.h"
#include "alhazen/geometry/ray_columns.h"
#include "alhazen/simd/lane_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Rays in one of two forms, which is asked for once a packet.
class GivenRays {
  public:
    HWY_INLINE explicit GivenRays(std::span<const Ray> rays)
        : rays_(rays.data()), columns_(nullptr), first_(0), count_(rays.size()) {}
    HWY_INLINE explicit GivenRays(const RayColumns& columns)
        : rays_(nullptr), columns_(&columns), first_(0), count_(columns.size()) {}

    [[nodiscard]] HWY_INLINE std::size_t size() const { return count_; }
    [[nodiscard]] HWY_INLINE GivenRays part(std::size_t first, std::size_t count) const {
        GivenRays part = *this;
        part.first_ += first;
        part.count_ = count;
        return part;
    }
    /// The columns; null if the rays are an array.
    [[nodiscard]] HWY_INLINE const RayColumns* columns() const { return columns_; }
    /// The index of the first ray in the columns.
    [[nodiscard]] HWY_INLINE std::size_t first() const { return first_; }
    /// Precondition: `columns()` is null.
    [[nodiscard]] HWY_INLINE const Ray* array() const { return rays_ + first_; }
    /// The ray; `scratch` may hold it.
    [[nodiscard]] HWY_INLINE const Ray& ray(std::size_t i, Ray& scratch) const {
        if (columns_ == nullptr) return rays_[first_ + i];
        scratch = columns_->ray(first_ + i);
        return scratch;
    }
    /// Whether N rays begin in one point, bit for bit, and have one range. Precondition: there are
    /// as many.
    template <std::size_t N>
    [[nodiscard]] HWY_INLINE bool share_start() const {
        if (columns_ != nullptr) {
            return columns_->from_one_point() && columns_->t_min.empty() && columns_->t_max.empty();
        }
        return share_start_of_array<N>();
    }
    /// Has N rays fetched, from `first` on.
    template <std::size_t N>
    HWY_INLINE void prefetch(std::size_t first) const {
        first += first_;
        if (columns_ == nullptr) {
            HWY_UNROLL(32)
            for (std::size_t i = 0; i < N; ++i) hwy::Prefetch(rays_ + first + i);
            return;
        }
        const auto column = [&](std::span<const float> numbers) HWY_ATTR {
            if (numbers.empty()) return;
            hwy::Prefetch(&numbers[first]);
            hwy::Prefetch(&numbers[first + N - 1]);
        };
        for (std::size_t k = 0; k < 3; ++k) {
            column(columns_->directions[k]);
            column(columns_->origins[k]);
        }
        column(columns_->t_min);
        column(columns_->t_max);
    }

  private:
    template <std::size_t N>
    [[nodiscard]] HWY_INLINE bool share_start_of_array() const {
        const Ray* const rays = array();
#if HWY_TARGET == HWY_SCALAR
        for (std::size_t i = 1; i < N; ++i) {
            if (std::memcmp(&rays[i].origin, &rays[0].origin, sizeof(Vec3)) != 0 ||
                std::memcmp(&rays[i].t_min, &rays[0].t_min, 2 * sizeof(double)) != 0) {
                return false;
            }
        }
        return true;
#else
        // Of the eight numbers of a ray all but its direction.
        HWY_ALIGN static constexpr std::uint64_t kStart[8] = {~0ull, ~0ull, ~0ull, 0,
                                                              0,     0,     ~0ull, ~0ull};
        const hn::CappedTag<double, 8> d;
        const hn::RebindToUnsigned<decltype(d)> bits;
        constexpr std::size_t kEach = hn::MaxLanes(d), kRegisters = 8 / kEach;
        using Part = hn::Vec<decltype(bits)>;
        Part first[kRegisters], differ[kRegisters];
        const auto numbers = [&](std::size_t i, std::size_t part) HWY_ATTR {
            return hn::BitCast(bits, hn::Load(d, &rays[i].origin.x + part * kEach));
        };
        const auto same = [&]() HWY_ATTR {
            Part any = hn::And(differ[0], hn::Load(bits, kStart));
            for (std::size_t part = 1; part < kRegisters; ++part) {
                any = hn::Or(any, hn::And(differ[part], hn::Load(bits, kStart + part * kEach)));
            }
            return hn::AllTrue(bits, hn::Eq(any, hn::Zero(bits)));
        };
        HWY_UNROLL(8)
        for (std::size_t part = 0; part < kRegisters; ++part) {
            first[part] = numbers(0, part);
            differ[part] = hn::Xor(first[part], numbers(1, part));
        }
        // Most packets whose rays begin apart end here, without waiting for the last ray.
        if (!same()) return false;
        HWY_UNROLL(32)
        for (std::size_t i = 2; i < N; ++i) {
            HWY_UNROLL(8)
            for (std::size_t part = 0; part < kRegisters; ++part) {
                differ[part] = hn::Or(differ[part], hn::Xor(first[part], numbers(i, part)));
            }
        }
        return same();
#endif
    }

    const Ray* rays_;
    const RayColumns* columns_;
    std::size_t first_, count_;
};

/// What brings rays into the local frame, made once for many packets: a ray is a row of eight
/// numbers.
struct LaneFrame {
    const LocalFrame& frame;
    alignas(64) double from[8], by[8];
    float origin[3], range[2];  ///< local ones of columns that have them in common

    /// Where a packet begins, and its range, in the local frame, if its rays have them in common.
    HWY_INLINE void start_of(const GivenRays& rays, float (&point)[3], float (&ends)[2]) const {
        if (rays.columns() != nullptr) {
            std::copy_n(origin, 3, point);
            std::copy_n(range, 2, ends);
            return;
        }
        const Ray& ray = *rays.array();
        const double given[3] = {ray.origin.x, ray.origin.y, ray.origin.z};
        for (std::size_t k = 0; k < 3; ++k) {
            point[k] = static_cast<float>((given[k] - from[k]) * by[k]);
        }
        ends[0] = static_cast<float>(ray.t_min * by[6]);
        ends[1] = static_cast<float>(ray.t_max * by[7]);
    }

    LaneFrame(const LocalFrame& f, const GivenRays& rays)
        : frame(f), from{f.center.x, f.center.y, f.center.z, 0.0, 0.0, 0.0, 0.0, 0.0}, by{f.scale,
                                                                                          f.scale,
                                                                                          f.scale,
                                                                                          1.0,
                                                                                          1.0,
                                                                                          1.0,
                                                                                          f.scale,
                                                                                          f.scale} {
        if (rays.columns() == nullptr) return;
        for (std::size_t k = 0; k < 3; ++k) {
            origin[k] = static_cast<float>((rays.columns()->origin[k] - from[k]) * f.scale);
        }
        for (std::size_t k = 0; k < 2; ++k) {
            range[k] = static_cast<float>(rays.columns()->range[k] * f.scale);
        }
    }
};

/// The numbers of sixteen rays in the local frame, in lanes: origins, directions and ends.
HWY_INLINE void load_local(const LaneFrame& frame, std::span<const Ray, 16> given,
                           Lanes<float, 16> (&rows)[8]) {
    static_assert(sizeof(Ray) == 8 * sizeof(double) &&
                  offsetof(Ray, direction) == 3 * sizeof(double) &&
                  offsetof(Ray, t_min) == 6 * sizeof(double));
#if HWY_CAP_GE512
    const hn::CappedTag<double, 8> d;
    const hn::CappedTag<float, 8> half;
    const hn::CappedTag<float, 16> whole;
    const auto from = hn::Load(d, frame.from), by = hn::Load(d, frame.by);
    const auto local = [&](const Ray& ray) HWY_ATTR {
        return hn::DemoteTo(half, hn::Mul(hn::Sub(hn::Load(d, &ray.origin.x), from), by));
    };
    hn::Vec<hn::CappedTag<float, 16>> pairs[8];
    HWY_UNROLL(8)
    for (std::size_t i = 0; i < 8; ++i) {
        pairs[i] = hn::Combine(whole, local(given[i + 8]), local(given[i]));
    }
    transpose_blocks(pairs);
    HWY_UNROLL(8)
    for (std::size_t k = 0; k < 8; ++k) rows[k].part[0] = pairs[k];
#else
    const auto from = load_lanes<4>(frame.from);
    const auto by0 = load_lanes<4>(frame.by), by1 = load_lanes<4>(frame.by + 4);
    // Origin and x of the direction; the rest of the direction and the ends.
    Lanes<float, 4> first[4][4], second[4][4];
    HWY_UNROLL(4)
    for (std::size_t g = 0; g < 4; ++g) {
        HWY_UNROLL(4)
        for (std::size_t i = 0; i < 4; ++i) {
            const Ray& ray = given[4 * g + i];
            first[g][i] = as_floats((load_lanes<4>(&ray.origin.x) - from) * by0);
            second[g][i] = as_floats(load_lanes<4>(&ray.direction.y) * by1);
        }
        transpose(first[g]);
        transpose(second[g]);
    }
    HWY_UNROLL(4)
    for (std::size_t k = 0; k < 4; ++k) {
        rows[k] = joined<16>(first[0][k], first[1][k], first[2][k], first[3][k]);
        rows[4 + k] = joined<16>(second[0][k], second[1][k], second[2][k], second[3][k]);
    }
#endif
}

/// The directions of sixteen rays, in lanes.
HWY_INLINE void load_directions(std::span<const Ray, 16> given, Lanes<float, 16> (&rows)[3]) {
#if HWY_CAP_GE512
    const hn::CappedTag<double, 4> d;
    const hn::CappedTag<float, 4> quarter;
    const hn::CappedTag<float, 8> half;
    const hn::CappedTag<float, 16> whole;
    const hn::CappedTag<double, 8> pairs;
    // With the beginning of the range, which is not used.
    const auto quad = [&](std::size_t i) HWY_ATTR {
        return hn::DemoteTo(quarter, hn::LoadU(d, &given[i].direction.x));
    };
    const auto quads = [&](std::size_t i) HWY_ATTR {
        return hn::Combine(whole, hn::Combine(half, quad(i + 12), quad(i + 8)),
                           hn::Combine(half, quad(i + 4), quad(i)));
    };
    const auto a = quads(0), b = quads(1), c = quads(2), e = quads(3);
    const auto xy01 = hn::BitCast(pairs, hn::InterleaveLower(whole, a, b));
    const auto xy23 = hn::BitCast(pairs, hn::InterleaveLower(whole, c, e));
    const auto z01 = hn::BitCast(pairs, hn::InterleaveUpper(whole, a, b));
    const auto z23 = hn::BitCast(pairs, hn::InterleaveUpper(whole, c, e));
    rows[0].part[0] = hn::BitCast(whole, hn::InterleaveLower(pairs, xy01, xy23));
    rows[1].part[0] = hn::BitCast(whole, hn::InterleaveUpper(pairs, xy01, xy23));
    rows[2].part[0] = hn::BitCast(whole, hn::InterleaveLower(pairs, z01, z23));
#else
    Lanes<float, 4> quads[4][4];
    HWY_UNROLL(4)
    for (std::size_t g = 0; g < 4; ++g) {
        HWY_UNROLL(4)
        for (std::size_t i = 0; i < 4; ++i) {
            quads[g][i] = as_floats(load_unaligned<4>(&given[4 * g + i].direction.x));
        }
        transpose(quads[g]);
    }
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
        rows[k] = joined<16>(quads[0][k], quads[1][k], quads[2][k], quads[3][k]);
    }
#endif
}
HWY_INLINE void load_directions(const RayColumns& columns, std::size_t first,
                                Lanes<float, 16> (&rows)[3]) {
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) rows[k] = load_unaligned<16>(&columns.directions[k][first]);
}

/// Sixteen numbers of a column, as (numbers - from) by, in double.
HWY_INLINE Lanes<float, 16> local_numbers(const float* numbers, double from, double by) {
#if HWY_CAP_GE512
    using D = Lanes<double, 16>;
    return as_floats((as_doubles(load_unaligned<16>(numbers)) - D(from)) * D(by));
#else
    using D = Lanes<double, 4>;
    Lanes<float, 4> quads[4];
    HWY_UNROLL(4)
    for (std::size_t i = 0; i < 4; ++i) {
        quads[i] = as_floats((as_doubles(load_unaligned<4>(numbers + 4 * i)) - D(from)) * D(by));
    }
    return joined<16>(quads[0], quads[1], quads[2], quads[3]);
#endif
}

/// The same of rays in columns, from `first` on.
HWY_INLINE void load_local(const LaneFrame& frame, const RayColumns& columns, std::size_t first,
                           Lanes<float, 16> (&rows)[8]) {
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
        rows[k] = columns.from_one_point()
                      ? Lanes<float, 16>(frame.origin[k])
                      : local_numbers(&columns.origins[k][first], frame.from[k], frame.by[k]);
        rows[3 + k] = load_unaligned<16>(&columns.directions[k][first]);
    }
    const auto ends = [&](std::span<const float> column, std::size_t which) HWY_ATTR {
        return column.empty() ? Lanes<float, 16>(frame.range[which])
                              : local_numbers(&column[first], 0.0, frame.frame.scale);
    };
    rows[6] = ends(columns.t_min, 0);
    rows[7] = ends(columns.t_max, 1);
}

/// Sixteen rays of columns, from `first` on.
HWY_INLINE void take_rays(const RayColumns& columns, std::size_t first, Ray (&rays)[16]) {
#if HWY_CAP_GE512
    const hn::CappedTag<double, 8> d;
    const hn::CappedTag<float, 8> half;
    const hn::CappedTag<float, 16> whole;
    const auto row = [&](std::span<const float> column, float same) HWY_ATTR {
        return column.empty() ? hn::Set(whole, same) : hn::LoadU(whole, &column[first]);
    };
    hn::Vec<hn::CappedTag<float, 16>> rows[8];
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
        rows[k] = row(columns.origins[k], columns.origin[k]);
        rows[3 + k] = row(columns.directions[k], 0.0f);
    }
    rows[6] = row(columns.t_min, columns.range[0]);
    rows[7] = row(columns.t_max, columns.range[1]);
    transpose_blocks(rows);
    HWY_UNROLL(8)
    for (std::size_t i = 0; i < 8; ++i) {
        hn::Store(hn::PromoteTo(d, hn::LowerHalf(half, rows[i])), d, &rays[i].origin.x);
        hn::Store(hn::PromoteTo(d, hn::UpperHalf(half, rows[i])), d, &rays[8 + i].origin.x);
    }
#else
    for (std::size_t i = 0; i < 16; ++i) rays[i] = columns.ray(first + i);
#endif
}

/// Sixteen rays in either form, from `first` on.
HWY_INLINE void load_local(const LaneFrame& frame, const GivenRays& rays, std::size_t first,
                           Lanes<float, 16> (&rows)[8]) {
    if (rays.columns() != nullptr) {
        return load_local(frame, *rays.columns(), rays.first() + first, rows);
    }
    load_local(frame, std::span<const Ray, 16>(rays.array() + first, 16), rows);
}

#if HWY_CAP_GE512
/// Eight rays, turned about in registers of eight: those that read the rows are as wide, and would
/// wait for rows stored by halves.
HWY_INLINE void take_lanes_whole(std::span<const Ray, kRayLanes> rays, RayLanes& lanes) {
    static_assert(sizeof(RayLanes) >= 8 * kRayLanes * sizeof(double) &&
                  offsetof(RayLanes, origin) == 0 &&
                  offsetof(RayLanes, direction) == 3 * kRayLanes * sizeof(double) &&
                  offsetof(RayLanes, t_min) == 6 * kRayLanes * sizeof(double));
    const hn::CappedTag<double, 8> d;
    double* const numbers = reinterpret_cast<double*>(&lanes);
    HWY_UNROLL(2)
    for (std::size_t odd = 0; odd < 2; ++odd) {
        // [pair of rays] blocks of two: every other number of both.
        hn::Vec<hn::CappedTag<double, 8>> pair[4];
        HWY_UNROLL(4)
        for (std::size_t i = 0; i < 4; ++i) {
            const auto a = hn::Load(d, &rays[2 * i].origin.x);
            const auto b = hn::Load(d, &rays[2 * i + 1].origin.x);
            pair[i] = odd == 0 ? hn::InterleaveLower(d, a, b) : hn::InterleaveUpper(d, a, b);
        }
        const auto even01 = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(pair[1]), pair[0]);
        const auto even23 = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(pair[3]), pair[2]);
        const auto odd01 = hn::OddEvenBlocks(pair[1], hn::SwapAdjacentBlocks(pair[0]));
        const auto odd23 = hn::OddEvenBlocks(pair[3], hn::SwapAdjacentBlocks(pair[2]));
        double* const to = numbers + odd * kRayLanes;
        hn::Store(hn::ConcatLowerLower(d, even23, even01), d, to);
        hn::Store(hn::ConcatLowerLower(d, odd23, odd01), d, to + 2 * kRayLanes);
        hn::Store(hn::ConcatUpperUpper(d, even23, even01), d, to + 4 * kRayLanes);
        hn::Store(hn::ConcatUpperUpper(d, odd23, odd01), d, to + 6 * kRayLanes);
    }
}
#endif

#if HWY_CAP_GE512
/// Eight rays that share their beginnings and ranges: only directions are turned about.
HWY_INLINE void take_lanes_of_start(std::span<const Ray, kRayLanes> rays, RayLanes& lanes) {
    const hn::CappedTag<double, 8> d;
    const hn::CappedTag<double, 4> half;
    // [i] x, y | z, t_min of rays i and i + 4.
    const auto pair = [&](std::size_t i) HWY_ATTR {
        return hn::Combine(d, hn::LoadU(half, &rays[i + 4].direction.x),
                           hn::LoadU(half, &rays[i].direction.x));
    };
    const auto p0 = pair(0), p1 = pair(1), p2 = pair(2), p3 = pair(3);
    const auto xz01 = hn::InterleaveLower(d, p0, p1), xz23 = hn::InterleaveLower(d, p2, p3);
    const auto y01 = hn::InterleaveUpper(d, p0, p1), y23 = hn::InterleaveUpper(d, p2, p3);
    hn::Store(hn::OddEvenBlocks(hn::SwapAdjacentBlocks(xz23), xz01), d, lanes.direction[0]);
    hn::Store(hn::OddEvenBlocks(hn::SwapAdjacentBlocks(y23), y01), d, lanes.direction[1]);
    hn::Store(hn::OddEvenBlocks(xz23, hn::SwapAdjacentBlocks(xz01)), d, lanes.direction[2]);
    hn::Store(hn::Set(d, rays[0].origin.x), d, lanes.origin[0]);
    hn::Store(hn::Set(d, rays[0].origin.y), d, lanes.origin[1]);
    hn::Store(hn::Set(d, rays[0].origin.z), d, lanes.origin[2]);
    hn::Store(hn::Set(d, rays[0].t_min), d, lanes.t_min);
    hn::Store(hn::Set(d, rays[0].t_max), d, lanes.t_max);
}
#endif

/// Up to eight rays in double, in lanes; the last is repeated.
HWY_INLINE void take_lanes(const GivenRays& rays, RayLanes& lanes) {
    const RayColumns* const columns = rays.columns();
    if (HWY_UNLIKELY(rays.size() < kRayLanes)) {
        for (std::size_t i = 0; i < kRayLanes; ++i) {
            Ray scratch;
            lanes.set(i, rays.ray(std::min(i, rays.size() - 1), scratch));
        }
        return;
    }
    if (columns == nullptr) {
        const std::span<const Ray, kRayLanes> given(rays.array(), kRayLanes);
#if HWY_CAP_GE512
        return take_lanes_whole(given, lanes);
#else
        return take_lanes(given, lanes);
#endif
    }
    const auto row = [&](std::span<const float> column, float common, double* to) HWY_ATTR {
#if HWY_CAP_GE512
        const hn::CappedTag<double, 8> d;
        const hn::CappedTag<float, 8> narrow;
        hn::Store(column.empty() ? hn::Set(d, static_cast<double>(common))
                                 : hn::PromoteTo(d, hn::LoadU(narrow, &column[rays.first()])),
                  d, to);
#else
        store_lanes(column.empty() ? Doubles(static_cast<double>(common))
                                   : as_doubles(load_unaligned(&column[rays.first()])),
                    to);
#endif
    };
    for (std::size_t k = 0; k < 3; ++k) {
        row(columns->origins[k], columns->origin[k], lanes.origin[k]);
        row(columns->directions[k], 0.0f, lanes.direction[k]);
    }
    row(columns->t_min, columns->range[0], lanes.t_min);
    row(columns->t_max, columns->range[1], lanes.t_max);
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target

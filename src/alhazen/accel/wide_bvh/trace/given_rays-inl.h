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
    const Ray* rays_;
    const RayColumns* columns_;
    std::size_t first_, count_;
};

/// What brings rays into the local frame, made once for many packets: a ray is a row of eight
/// numbers.
struct LaneFrame {
    const LocalFrame& frame;
    alignas(64) double from[8], by[8];
    float origin[3], range[2];  ///< local ones of rays that have them in common

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
        return take_lanes(std::span<const Ray, kRayLanes>(rays.array(), kRayLanes), lanes);
    }
    const auto row = [&](std::span<const float> column, float common, double* to) HWY_ATTR {
        store_lanes(column.empty() ? Doubles(static_cast<double>(common))
                                   : as_doubles(load_unaligned(&column[rays.first()])),
                    to);
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

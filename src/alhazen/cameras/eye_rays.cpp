#include "alhazen/cameras/eye_rays.h"

#include <cstddef>
#include <cstring>
#include <type_traits>

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/cameras/eye_rays.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double) && std::is_trivially_copyable_v<Ray>);
static_assert(offsetof(Ray, direction) == 3 * sizeof(double) &&
              offsetof(Ray, t_min) == 6 * sizeof(double));

/// Writes rays from the eye along vectors, a register of lanes at a time, with the bits of
/// `normalize`. Returns their number; leaves the remaining vectors, fewer than the lanes.
std::size_t rays_along(const Vec3& eye, std::span<const Vec3> vectors, Ray* rays) {
    const LaneTag<double> d;
    constexpr std::size_t kLanes = hn::MaxLanes(LaneTag<double>());
    const Ray usual;
    const auto eye_x = hn::Set(d, eye.x), eye_y = hn::Set(d, eye.y), eye_z = hn::Set(d, eye.z);
    const auto t_min = hn::Set(d, usual.t_min), t_max = hn::Set(d, usual.t_max);
    std::size_t i = 0;
    for (; i + kLanes <= vectors.size(); i += kLanes) {
        auto x = t_min, y = t_min, z = t_min;
        hn::LoadInterleaved3(d, &vectors[i].x, x, y, z);
        const auto length = hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z)));
        // The first four numbers of each ray, and the last four.
        HWY_ALIGN double halves[2][kLanes][4];
        hn::StoreInterleaved4(eye_x, eye_y, eye_z, hn::Div(x, length), d, halves[0][0]);
        hn::StoreInterleaved4(hn::Div(y, length), hn::Div(z, length), t_min, t_max, d,
                              halves[1][0]);
        for (std::size_t k = 0; k < kLanes; ++k) {
            auto* const ray = reinterpret_cast<std::byte*>(rays + i + k);
            std::memcpy(ray, halves[0][k], sizeof(halves[0][k]));
            std::memcpy(ray + sizeof(halves[0][k]), halves[1][k], sizeof(halves[1][k]));
        }
    }
    return i;
}

}  // namespace

std::size_t rays_along_of_target(const Vec3& eye, std::span<const Vec3> vectors, Ray* rays) {
    return rays_along(eye, vectors, rays);
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(rays_along_of_target);

void EyeRays::rays(std::span<const Vec3> sums, Ray* out) const {
    std::size_t done = 0;
    if (from_eye_) done = ALHAZEN_KERNEL(rays_along_of_target)(fixed_, sums, out);
    for (std::size_t i = done; i < sums.size(); ++i) out[i] = ray(sums[i]);
}

}  // namespace alhazen
#endif

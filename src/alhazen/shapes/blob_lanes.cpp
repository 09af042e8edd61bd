#include "alhazen/shapes/blob_lanes.h"

#include <limits>

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shapes/blob_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

static_assert(BlobRayLanes::kWidth == kLaneCount);

std::uint32_t within_ball(const BlobRayLanes& rays, const Vec3& center, double radius,
                          BallLanes& out) {
    const Doubles dx = load_lanes(rays.direction[0]), dy = load_lanes(rays.direction[1]),
                  dz = load_lanes(rays.direction[2]);
    const Doubles fx = load_lanes(rays.origin[0]) - Doubles(center.x),
                  fy = load_lanes(rays.origin[1]) - Doubles(center.y),
                  fz = load_lanes(rays.origin[2]) - Doubles(center.z);
    const Doubles dd = dx * dx + dy * dy + dz * dz;
    // As `collect_pieces` leaves out what is not near.
    const Doubles cx = fy * dz - fz * dy, cy = fz * dx - fx * dz, cz = fx * dy - fy * dx;
    const Doubles r(radius), near = r + load_lanes(rays.pad);
    std::uint32_t left = kAllLanes & ~bits_of(cx * cx + cy * cy + cz * cz > near * near * dd);
    if (left == 0) return 0;
    const Doubles middle = -(fx * dx + fy * dy + fz * dz) / dd;
    const Doubles nx = fx + middle * dx, ny = fy + middle * dy, nz = fz + middle * dz;
    const Doubles distance = sqrt(nx * nx + ny * ny + nz * nz), speed = sqrt(dd);
    left &= bits_of(distance < r);
    if (left == 0) return 0;
    const Doubles room = (r - distance) * (r + distance);
    const Doubles half = sqrt(room) / speed, squared = r * r;
    const Doubles lo = middle - half, hi = middle + half;
    const Doubles infinite(std::numeric_limits<double>::infinity());
    left &= bits_of((lo < hi) & (abs(lo) < infinite) & (abs(hi) < infinite));
    store_lanes(lo, out.lo);
    store_lanes(hi, out.hi);
    store_lanes(middle, out.middle);
    store_lanes(room / squared, out.peak);
    store_lanes(speed * speed / squared, out.bend);
    return left;
}

}  // namespace

WithinBallKernel within_ball_of_target() {
    return &within_ball;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

HWY_EXPORT(within_ball_of_target);

WithinBallKernel within_ball_kernel() {
    // Asked for every eight rays: what the processor can do is not looked up again.
    return HWY_DYNAMIC_DISPATCH(within_ball_of_target)();
}

}  // namespace alhazen
#endif

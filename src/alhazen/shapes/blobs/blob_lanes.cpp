#include "alhazen/shapes/blobs/blob_lanes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shapes/blobs/blob_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
#include "alhazen/shapes/blobs/blob_formula-inl.h"
}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#include "alhazen/shapes/blobs/blob_search-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

struct PointLanes {
    Doubles x, y, z;
};
HWY_INLINE PointLanes load_point(const double (&rows)[3][kRayLanes]) {
    return {load_lanes(rows[0]), load_lanes(rows[1]), load_lanes(rows[2])};
}
HWY_INLINE PointLanes minus(const PointLanes& p, const Vec3& v) {
    return {p.x - Doubles(v.x), p.y - Doubles(v.y), p.z - Doubles(v.z)};
}
HWY_INLINE Doubles dot(const PointLanes& a, const PointLanes& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// The square of the length of a x b.
HWY_INLINE Doubles square_across(const PointLanes& a, const Vec3& b) {
    const Doubles bx(b.x), by(b.y), bz(b.z);
    const Doubles x = a.y * bz - a.z * by, y = a.z * bx - a.x * bz, z = a.x * by - a.y * bx;
    return x * x + y * y + z * z;
}
HWY_INLINE Doubles reach_of(const PointLanes& p) {
    return max_lanes(abs(p.x), max_lanes(abs(p.y), abs(p.z)));
}
Vec3 lane_of(const double (&rows)[3][kRayLanes], std::size_t lane) {
    return {rows[0][lane], rows[1][lane], rows[2][lane]};
}

/// The beam around the middle ray.
HWY_INLINE void make_beam(const Blob& blob, const Doubles& square, BlobRayLanes& out) {
    const Vec3 o = out.axis_origin = lane_of(out.origin, kRayLanes / 2);
    const Vec3 d = out.axis_direction = lane_of(out.direction, kRayLanes / 2);
    const PointLanes from = load_point(out.origin), along = load_point(out.direction);
    const PointLanes from_center = minus(from, blob.bounds.center());
    // Distance from its origin within which a ray may be near the blob.
    const Doubles far = sqrt(dot(from_center, from_center)) + Doubles(length(blob.bounds.size()));
    const Doubles aside =
        sqrt(square_across(minus(from, o), d)) + far * sqrt(square_across(along, d) / square);
    const Doubles rounding = Doubles(0x1p-40) * (load_lanes(out.far) + Doubles(blob.reach) + far);
    HWY_ALIGN double width[kRayLanes];
    store_lanes(aside * Doubles(1.001 / length(d)) + rounding, width);
    out.width = *std::max_element(width, width + kRayLanes);
}

void begin(const Blob& blob, const RayLanes& rays, BlobRayLanes& out) {
    const PointLanes given = load_point(rays.origin), d = load_point(rays.direction);
    const PointLanes from_center = minus(given, blob.bounds.center());
    const Doubles square = dot(d, d);
    const Mask distant =
        dot(from_center, from_center) > Doubles(4.0 * length_squared(blob.bounds.size()));
    const Doubles shift = select_lanes(distant, -dot(from_center, d) / square, Doubles(0.0));
    const PointLanes o{select_lanes(distant, given.x + shift * d.x, given.x),
                       select_lanes(distant, given.y + shift * d.y, given.y),
                       select_lanes(distant, given.z + shift * d.z, given.z)};
    store_lanes(o.x, out.origin[0]);
    store_lanes(o.y, out.origin[1]);
    store_lanes(o.z, out.origin[2]);
    for (int k = 0; k < 3; ++k) store_lanes(load_lanes(rays.direction[k]), out.direction[k]);
    store_lanes(shift, out.shift);
    store_lanes(reach_of(given) + abs(shift) * reach_of(d), out.far);
    store_lanes(load_lanes(rays.t_min), out.t_min);
    store_lanes(load_lanes(rays.t_max), out.t_max);
    out.finite = bits_of(is_finite(abs(o.x) + abs(o.y) + abs(o.z)));
    make_beam(blob, square, out);
}

std::size_t near(const Blob& blob, const BlobRayLanes& rays, std::uint32_t* numbers) {
    const Vec3 &o = rays.axis_origin, &d = rays.axis_direction;
    const Doubles square(length_squared(d)), width(rays.width);
    std::size_t count = 0;
    std::uint32_t first = 0;
    for (const BlobSpheres& spheres : blob.tree->spheres()) {
        const PointLanes from{load_unaligned(spheres.x) - Doubles(o.x),
                              load_unaligned(spheres.y) - Doubles(o.y),
                              load_unaligned(spheres.z) - Doubles(o.z)};
        const Doubles most = load_unaligned(spheres.radius) + width;
        std::uint32_t met = spheres.used & ~bits_of(square_across(from, d) > most * most * square);
        for (; met != 0; met &= met - 1) {
            numbers[count++] = first + static_cast<std::uint32_t>(std::countr_zero(met));
        }
        first += BlobSpheres::kCount;
    }
    return count;
}

std::size_t balls(const Blob& blob, const BlobRayLanes& rays,
                  std::span<const std::uint32_t> numbers, BlobRow* rows) {
    const PointLanes o = load_point(rays.origin), d = load_point(rays.direction);
    const Doubles square = dot(d, d), nothing(0.0);
    const BlobLine<Doubles> line{d.x, d.y, d.z, square, Doubles(1.0) / square};
    const Doubles infinite(std::numeric_limits<double>::infinity());
    std::size_t count = 0;
    for (const std::uint32_t number : numbers) {
        const BlobComponent& c = blob.components[number];
        const double squared = c.radius * c.radius;
        const PointLanes f = minus(o, c.base);
        const auto [middle, room] = nearest_place(line, f.x, f.y, f.z, Doubles(squared));
        const Mask met = room > nothing;
        if (none(met)) continue;
        const Doubles half = half_chord(line, room), inverse_squared(1.0 / squared);
        const Doubles in = middle - half, out = middle + half;
        const Mask holds = met & (in < out) & is_finite(in) & is_finite(out);
        BlobRow& row = rows[count++];
        store_lanes(select_lanes(holds, in, infinite), row.in);
        store_lanes(select_lanes(holds, out, -infinite), row.out);
        store_lanes(select_lanes(holds, middle, nothing), row.middle);
        store_lanes(select_lanes(holds, room * inverse_squared, Doubles(-1.0)), row.peak);
        store_lanes(select_lanes(holds, square * inverse_squared, nothing), row.bend);
        row.set(c, 0.0);
    }
    return count;
}

}  // namespace

const BlobKernels& blob_kernels_of_target() {
    static constexpr BlobKernels kernels{&begin, &near, &balls, &search};
    return kernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(blob_kernels_of_target);

const BlobKernels& blob_kernels() {
    // Called for every eight rays: the dispatch is cached.
    return ALHAZEN_KERNEL(blob_kernels_of_target)();
}

}  // namespace alhazen
#endif

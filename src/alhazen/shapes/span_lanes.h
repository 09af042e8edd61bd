#pragma once
/// Where eight lines enter and leave a closed convex shape, side by side in lanes.
///
/// Source: sphere_roots.h, frustum.cpp, box_shape.cpp, the same operations in the same order.
/// Differs: what is rare (a cone steeper than the line, a line along an axis, numbers out of range)
/// is left to the scalar text. Conventions: `unsure` lanes are to be asked alone; of the others
/// entry and exit are the bits of the two crossings that `intersect` writes for the whole line, or
/// there are none. Bit i of a set stands for lane i. Open cylinders and cones are
/// not for these. Threads: pure functions.

#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/shapes/box_shape.h"
#include "alhazen/shapes/cone.h"
#include "alhazen/shapes/cylinder.h"
#include "alhazen/shapes/sphere.h"

namespace alhazen {

struct alignas(64) SpanLanes {
    double entry[kRayLanes], exit[kRayLanes];  ///< of the lanes that meet it, entry <= exit
    double entry_part[kRayLanes], exit_part[kRayLanes];  ///< whole numbers
    std::uint32_t met;                                   ///< the line crosses the shape
    std::uint32_t unsure;                                ///< nothing is known; not in `met`
};

/// Those of one instruction set. The lines of the rays: their limits are not looked at.
struct SpanKernels {
    void (*sphere)(const RayLanes&, const Sphere&, SpanLanes&);
    void (*box)(const RayLanes&, const BoxShape&, SpanLanes&);
    void (*frustum)(const RayLanes&, const Frustum&, SpanLanes&);  ///< with its caps
};

/// For the best instruction set of this machine, or the one that is forced (simd/targets.h).
[[nodiscard]] const SpanKernels& span_kernels();

inline void find_spans(const Sphere& shape, const RayLanes& rays, SpanLanes& spans) {
    span_kernels().sphere(rays, shape, spans);
}
inline void find_spans(const BoxShape& shape, const RayLanes& rays, SpanLanes& spans) {
    span_kernels().box(rays, shape, spans);
}
inline void find_spans(const Cylinder& shape, const RayLanes& rays, SpanLanes& spans) {
    span_kernels().frustum(rays, shape.frustum, spans);
}
inline void find_spans(const Cone& shape, const RayLanes& rays, SpanLanes& spans) {
    span_kernels().frustum(rays, shape.frustum, spans);
}

/// Shapes that have one of these.
template <class S>
concept SpansSideBySide = requires(const S& shape, const RayLanes& rays, SpanLanes& spans) {
    find_spans(shape, rays, spans);
};

}  // namespace alhazen

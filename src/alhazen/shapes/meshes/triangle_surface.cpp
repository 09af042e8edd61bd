#include "alhazen/shapes/meshes/triangle_surface.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shapes/meshes/triangle_surface.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/meshes/triangle_normal.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace triangle_surfaces {

// A register holds the coordinates of a vector, and products are fused.
#undef ALHAZEN_HOLDS_VECTORS
#define ALHAZEN_HOLDS_VECTORS (HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2)

#if ALHAZEN_HOLDS_VECTORS
static_assert(kFusesExactly && kParts<double, 4> == 1);
using Tag = LaneTag<double, 4>;
using Coordinates = hn::Vec<Tag>;  ///< x, y, z and a lane without meaning

HWY_INLINE Coordinates load(const Vec3& v) {
    return hn::MaskedLoad(hn::FirstN(Tag(), 3), Tag(), &v.x);
}
HWY_INLINE void store(const Coordinates& v, Vec3& to) {
    const hn::Half<Tag> half;
    hn::StoreU(hn::LowerHalf(half, v), half, &to.x);
    to.z = hn::GetLane(hn::UpperHalf(half, v));
}
HWY_INLINE Coordinates times(double a, const Coordinates& v) {
    return hn::Mul(hn::Set(Tag(), a), v);
}
/// a p + b q + c r.
HWY_INLINE Coordinates weighted(double a, const Coordinates& p, double b, const Coordinates& q,
                                double c, const Coordinates& r) {
    return hn::Add(hn::Add(times(a, p), times(b, q)), times(c, r));
}
HWY_INLINE Coordinates turned_once(const Coordinates& v) {  // y, z, x
    HWY_ALIGN static constexpr std::int64_t kPlaces[] = {1, 2, 0, 3};
    return hn::TableLookupLanes(v, hn::SetTableIndices(Tag(), kPlaces));
}
HWY_INLINE Coordinates turned_twice(const Coordinates& v) {  // z, x, y
    HWY_ALIGN static constexpr std::int64_t kPlaces[] = {2, 0, 1, 3};
    return hn::TableLookupLanes(v, hn::SetTableIndices(Tag(), kPlaces));
}
/// `accurate_cross`.
HWY_INLINE Coordinates cross(const Coordinates& a, const Coordinates& b) {
    const Coordinates a1 = turned_once(a), a2 = turned_twice(a);
    const Coordinates b1 = turned_once(b), b2 = turned_twice(b);
    const Coordinates other = hn::Mul(a2, b1);
    return hn::Add(hn::MulSub(a1, b2, other), hn::NegMulAdd(a2, b1, other));
}
HWY_INLINE void store_unit_or(const Coordinates& v, const Vec3& fallback, Vec3& to) {
    Vec3 squares;
    store(hn::Mul(v, v), squares);
    const double squared = squares.x + squares.y + squares.z;
    if (squared > 1e-200 && squared < 1e200) {
        store(hn::Div(v, hn::Sqrt(hn::Set(Tag(), squared))), to);
    } else {
        Vec3 vector;
        store(v, vector);
        to = unit_or(vector, fallback);
    }
}
HWY_INLINE Coordinates farther(const Coordinates& reach, const Coordinates& from,
                               const Coordinates& to) {
    const Coordinates away = hn::Abs(hn::Sub(to, from));
    return hn::IfThenElse(hn::Gt(away, reach), away, reach);
}

HWY_INLINE double set(const TriangleMesh& mesh, std::size_t triangle, const ShapeHit& hit,
                      ShapeSurface& surface) {
    const auto& [i0, i1, i2] = mesh.triangles[triangle];
    const Coordinates p0 = load(mesh.positions[i0]), p1 = load(mesh.positions[i1]);
    const Coordinates p2 = load(mesh.positions[i2]);
    const double rest = 1.0 - hit.u, w = rest - hit.v;
    const Coordinates point = weighted(w, p0, hit.u, p1, hit.v, p2);
    store(point, surface.point);
    // Seven roundings of the sum; the weight of p0 has the absolute error of its terms.
    const Coordinates size0 = hn::Abs(p0);
    const Coordinates sizes =
        weighted(std::abs(w), size0, std::abs(hit.u), hn::Abs(p1), std::abs(hit.v), hn::Abs(p2));
    store(hn::Add(times(gamma_bound(7), sizes), times(gamma_bound(2) * std::abs(rest), size0)),
          surface.error);
    const Coordinates e1 = hn::Sub(p1, p0), e2 = hn::Sub(p2, p0);
    store_unit_or(cross(e1, e2), {0, 0, 1}, surface.normal);
    if (mesh.normals.empty()) {
        surface.shading_normal = surface.normal;
    } else {
        const std::vector<Vec3>& n = mesh.normals;
        store_unit_or(weighted(w, load(n[i0]), hit.u, load(n[i1]), hit.v, load(n[i2])),
                      surface.normal, surface.shading_normal);
    }
    if (mesh.uvs.empty()) {
        surface.uv = {hit.u, hit.v};
        store(e1, surface.dpdu);
        store(e2, surface.dpdv);
    } else {
        const Vec2 &t0 = mesh.uvs[i0], &t1 = mesh.uvs[i1], &t2 = mesh.uvs[i2];
        surface.uv = w * t0 + hit.u * t1 + hit.v * t2;
        const Vec2 a = t1 - t0, b = t2 - t0;
        const double area = alhazen::difference_of_products(a.x, b.y, a.y, b.x);
        // By an area of 0 no quotient is finite, and the fourth lane would be 0 / 0.
        bool known = area != 0.0;
        if (known) {
            const Coordinates by = hn::Set(Tag(), area);
            store(hn::Div(hn::Sub(times(b.y, e1), times(a.y, e2)), by), surface.dpdu);
            store(hn::Div(hn::Sub(times(a.x, e2), times(b.x, e1)), by), surface.dpdv);
            known = is_finite(surface.dpdu) && is_finite(surface.dpdv);
        }
        if (!known) surface.dpdu = surface.dpdv = {};
    }
    const Coordinates far =
        farther(farther(farther(hn::Zero(Tag()), point, p0), point, p1), point, p2);
    Vec3 reach;
    store(far, reach);
    const double two = reach.y > reach.x ? reach.y : reach.x;
    return reach.z > two ? reach.z : two;
}
#else
/// One number after another.
inline double set(const TriangleMesh& mesh, std::size_t triangle, const ShapeHit& hit,
                  ShapeSurface& surface) {
    surface = mesh.surface(triangle, hit);
    double reach = 0.0;
    for (const std::uint32_t corner : mesh.triangles[triangle]) {
        const Vec3 away = abs(mesh.positions[corner] - surface.point);
        for (int k = 0; k < 3; ++k) reach = away[k] > reach ? away[k] : reach;
    }
    return reach;
}
#endif

}  // namespace triangle_surfaces

double set_triangle_surface_of_target(const TriangleMesh& mesh, std::size_t triangle,
                                      const ShapeHit& hit, ShapeSurface& surface) {
    return triangle_surfaces::set(mesh, triangle, hit, surface);
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(set_triangle_surface_of_target);

double set_triangle_surface(const TriangleMesh& mesh, std::size_t triangle, const ShapeHit& hit,
                            ShapeSurface& surface) {
    return ALHAZEN_KERNEL(set_triangle_surface_of_target)(mesh, triangle, hit, surface);
}

}  // namespace alhazen
#endif

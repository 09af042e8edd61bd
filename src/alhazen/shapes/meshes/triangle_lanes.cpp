#include "alhazen/shapes/meshes/triangle_lanes.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shapes/meshes/triangle_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include <bit>
#include <limits>

#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/simd/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace triangle_lanes {

/// Calls f(lane) for each of `lanes`.
template <class F>
HWY_INLINE void for_each_lane(std::uint32_t lanes, const F& f) {
    for (; lanes != 0; lanes &= lanes - 1) f(std::countr_zero(lanes));
}
HWY_INLINE Vec3 vector_of(const TriangleLanes::Vectors& v, int lane) {
    return {v[0][lane], v[1][lane], v[2][lane]};
}
HWY_INLINE void set_vector(const Vec3& from, int lane, TriangleLanes::Vectors& v) {
    for (int k = 0; k < 3; ++k) v[k][lane] = from[k];
}

/// `difference_of_products` of each lane.
template <std::size_t N>
HWY_INLINE Lanes<double, N> product_difference(const Lanes<double, N>& a, const Lanes<double, N>& b,
                                               const Lanes<double, N>& c,
                                               const Lanes<double, N>& d) {
    if constexpr (kFusesExactly) {
        return difference_of_products(a, b, c, d);
    } else {
        HWY_ALIGN double in[4][N];
        store_lanes(a, in[0]);
        store_lanes(b, in[1]);
        store_lanes(c, in[2]);
        store_lanes(d, in[3]);
        for (std::size_t i = 0; i < N; ++i) {
            in[0][i] = alhazen::difference_of_products(in[0][i], in[1][i], in[2][i], in[3][i]);
        }
        return load_lanes<N>(in[0]);
    }
}
template <std::size_t N>
HWY_INLINE VectorLanes<N> accurate_cross(const VectorLanes<N>& a, const VectorLanes<N>& b) {
    return {product_difference(a.y, b.z, a.z, b.y), product_difference(a.z, b.x, a.x, b.z),
            product_difference(a.x, b.y, a.y, b.x)};
}

/// `unit_or` of each lane.
template <std::size_t N>
HWY_INLINE VectorLanes<N> unit_vectors_or(const VectorLanes<N>& v, const VectorLanes<N>& fallback) {
    using D = Lanes<double, N>;
    const D squared = dot(v, v);
    const LaneMask<double, N> sane = (squared > D(1e-200)) & (squared < D(1e200));
    const VectorLanes<N> unit = v / sqrt(select_lanes(sane, squared, D(1.0)));
    const std::uint32_t others = ~bits_of(sane) & ((1u << N) - 1);
    if (others == 0) return unit;
    HWY_ALIGN TriangleLanes::Vectors of, rest, result;
    store_vectors(v, of);
    store_vectors(fallback, rest);
    store_vectors(unit, result);
    for_each_lane(others, [&](int i) {
        set_vector(unit_or(vector_of(of, i), vector_of(rest, i)), i, result);
    });
    return load_vectors<N>(result);
}

/// w p + u q + v r.
template <std::size_t N>
HWY_INLINE VectorLanes<N> weighted(const Lanes<double, N>& w, const VectorLanes<N>& p,
                                   const Lanes<double, N>& u, const VectorLanes<N>& q,
                                   const Lanes<double, N>& v, const VectorLanes<N>& r) {
    return w * p + u * q + v * r;
}

template <std::size_t N>
HWY_INLINE Lanes<double, N> larger(const Lanes<double, N>& a, const Lanes<double, N>& b) {
    return select_lanes(b > a, b, a);
}
template <std::size_t N>
HWY_INLINE Lanes<double, N> largest_coordinate(const VectorLanes<N>& a) {
    return larger(larger(a.x, a.y), a.z);
}

/// The derivatives by the first texture coordinate; first edges where there are none.
template <std::size_t N>
HWY_INLINE VectorLanes<N> derivatives_by_u(const TriangleLanes& t, const VectorLanes<N>& e1,
                                           const VectorLanes<N>& e2) {
    using D = Lanes<double, N>;
    using Vectors = VectorLanes<N>;
    const D x0 = load_lanes<N>(t.uvs[0][0]), y0 = load_lanes<N>(t.uvs[0][1]);
    const D ax = load_lanes<N>(t.uvs[1][0]) - x0, ay = load_lanes<N>(t.uvs[1][1]) - y0;
    const D bx = load_lanes<N>(t.uvs[2][0]) - x0, by = load_lanes<N>(t.uvs[2][1]) - y0;
    const D zero(0.0), area = product_difference(ax, by, ay, bx);
    const LaneMask<double, N> mapped = lanes_of_bits<double, N>(t.mapped);
    const LaneMask<double, N> spans = mapped & ((area > zero) | (area < zero));
    // No division of 0 by 0.
    const D divisor = select_lanes(spans, area, D(1.0));
    const Vectors by_u = (by * e1 - ay * e2) / divisor, by_v = (ax * e2 - bx * e1) / divisor;
    const auto is_finite = [](const Vectors& v) {
        constexpr double kLargest = std::numeric_limits<double>::max();
        const D most(kLargest);
        return (abs(v.x) <= most) & (abs(v.y) <= most) & (abs(v.z) <= most);
    };
    const LaneMask<double, N> known = spans & is_finite(by_u) & is_finite(by_v);
    const Vectors none{zero, zero, zero};
    return select_lanes(mapped, select_lanes(known, by_u, none), e1);
}

template <std::size_t N>
HWY_INLINE void find(TriangleLanes& t) {
    using D = Lanes<double, N>;
    using Vectors = VectorLanes<N>;
    const Vectors p0 = load_vectors<N>(t.corners[0]), p1 = load_vectors<N>(t.corners[1]);
    const Vectors p2 = load_vectors<N>(t.corners[2]);
    const D u = load_lanes<N>(t.u), v = load_lanes<N>(t.v);
    const D rest = D(1.0) - u, w = rest - v;
    const Vectors point = weighted(w, p0, u, p1, v, p2);
    store_vectors(point, t.point);
    // As in TriangleMesh::surface.
    const Vectors size0 = abs(p0);
    const Vectors sizes = weighted(abs(w), size0, abs(u), abs(p1), abs(v), abs(p2));
    const Vectors error = D(gamma_bound(7)) * sizes + (D(gamma_bound(2)) * abs(rest)) * size0;
    Vectors reach = abs(p0 - point);
    for (const Vectors* p : {&p1, &p2}) {
        const Vectors away = abs(*p - point);
        reach = {larger(reach.x, away.x), larger(reach.y, away.y), larger(reach.z, away.z)};
    }
    const D rounding = D(kNextTestRounding) * largest_coordinate(reach);
    store_vectors(error + Vectors{rounding, rounding, rounding}, t.error);

    const Vectors e1 = p1 - p0, e2 = p2 - p0;
    const D zero(0.0);
    const Vectors normal = unit_vectors_or(accurate_cross(e1, e2), {zero, zero, D(1.0)});
    const Vectors turned =
        t.mirrored == 0 ? normal
                        : select_lanes(lanes_of_bits<double, N>(t.mirrored), -normal, normal);
    store_vectors(turned, t.normal);
    Vectors shading = turned;
    if (t.smooth != 0) {
        const LaneMask<double, N> smooth = lanes_of_bits<double, N>(t.smooth);
        const Vectors mean =
            weighted(w, load_vectors<N>(t.normals[0]), u, load_vectors<N>(t.normals[1]), v,
                     load_vectors<N>(t.normals[2]));
        shading = select_lanes(smooth, unit_vectors_or(select_lanes(smooth, mean, normal), normal),
                               turned);
    }
    store_vectors(shading, t.shading_normal);
    store_vectors(t.mapped == 0 ? e1 : derivatives_by_u(t, e1, e2), t.dpdu);
}

}  // namespace triangle_lanes

void find_triangle_surfaces_of_target(std::uint32_t used, TriangleLanes& lanes) {
    with_lane_count(
        used, [&](auto count) HWY_ATTR { triangle_lanes::find<decltype(count)::value>(lanes); });
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(find_triangle_surfaces_of_target);

TriangleLanes::TriangleLanes() {
    for (std::size_t lane = 0; lane < kMost; ++lane) {
        corners[1][0][lane] = corners[2][1][lane] = 1.0;
        for (auto& own : normals) own[2][lane] = 1.0;
    }
}

void TriangleLanes::set(std::size_t lane, const TriangleMesh& mesh, std::size_t triangle,
                        const ShapeHit& hit, bool is_mirrored) {
    const auto& corner = mesh.triangles[triangle];
    const auto put = [&](const std::vector<Vec3>& of, Vectors(&to)[3]) {
        const Vec3 &a = of[corner[0]], &b = of[corner[1]], &c = of[corner[2]];
        for (int k = 0; k < 3; ++k) {
            to[0][k][lane] = a[k];
            to[1][k][lane] = b[k];
            to[2][k][lane] = c[k];
        }
    };
    put(mesh.positions, corners);
    u[lane] = hit.u;
    v[lane] = hit.v;
    const std::uint32_t bit = 1u << lane;
    if (is_mirrored) mirrored |= bit;
    if (!mesh.normals.empty()) {
        smooth |= bit;
        put(mesh.normals, normals);
    }
    if (mesh.uvs.empty()) return;
    mapped |= bit;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2& from = mesh.uvs[corner[i]];
        uvs[i][0][lane] = from.x;
        uvs[i][1][lane] = from.y;
    }
}

void TriangleLanes::find_surfaces(std::size_t count) {
    ALHAZEN_KERNEL(find_triangle_surfaces_of_target)((1u << count) - 1, *this);
}

}  // namespace alhazen
#endif

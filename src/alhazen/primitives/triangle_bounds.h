#pragma once
/// Boxes of the triangles of a table, equal to PrimitiveTable::box, in registers of two doubles and
/// without a call for each.
///
/// Conventions: NaN coordinates are skipped, as in Box3::include.

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "alhazen/primitives/primitive_table.h"
#include "alhazen/simd/registers.h"

namespace alhazen {

/// True if a <= b (a == b) in both lanes.
inline bool both_at_most(Double2 a, Double2 b) {
#ifdef __SSE2__
    return _mm_movemask_pd(_mm_cmple_pd(a, b)) == 3;
#else
    return a[0] <= b[0] && a[1] <= b[1];
#endif
}
inline bool both_equal(Double2 a, Double2 b) {
#ifdef __SSE2__
    return _mm_movemask_pd(_mm_cmpeq_pd(a, b)) == 3;
#else
    return a[0] == b[0] && a[1] == b[1];
#endif
}

/// A point in two registers.
struct PointLanes {
    Double2 xy;
    double z;

    explicit PointLanes(const Vec3& p) : z(p.z) { std::memcpy(&xy, &p.x, sizeof(xy)); }
    [[nodiscard]] bool operator==(const PointLanes& p) const {
        return both_equal(xy, p.xy) && z == p.z;
    }
};
static_assert(offsetof(Vec3, y) == offsetof(Vec3, x) + sizeof(double));

/// True if two of the points may be equal: x and y of some pairs are. One branch, not three.
inline bool some_equal_across(const PointLanes& p, const PointLanes& q, const PointLanes& r) {
#ifdef __SSE2__
    return _mm_movemask_pd(_mm_or_pd(_mm_or_pd(_mm_cmpeq_pd(p.xy, q.xy), _mm_cmpeq_pd(q.xy, r.xy)),
                                     _mm_cmpeq_pd(r.xy, p.xy))) == 3;
#else
    return true;
#endif
}

/// The box of a triangle: lower and upper x and y; `deep` is lower z and negated upper z.
struct TriangleBounds {
    static constexpr double kPadding = 8e-16;  ///< of a coordinate

    Double2 lower, upper, deep;

    TriangleBounds() {
        constexpr double kInf = std::numeric_limits<double>::infinity();
        lower = deep = Double2{kInf, kInf};
        upper = -lower;
    }
    /// As PrimitiveTable::box: padded, and empty for a triangle with two equal corners.
    TriangleBounds(const Vec3& a, const Vec3& b, const Vec3& c) : TriangleBounds() {
        (void)set(a, b, c);
    }
    /// The same for a box that is empty so far; false if it remains so.
    bool set(const Vec3& a, const Vec3& b, const Vec3& c) {
        const PointLanes p(a), q(b), r(c);
        if (some_equal_across(p, q, r) && (p == q || q == r || r == p)) return false;
        include(p);
        include(q);
        include(r);
        return pad();
    }

    void include(const PointLanes& p) {
        lower = lesser(p.xy, lower);
        upper = greater(p.xy, upper);
        deep = lesser(Double2{p.z, -p.z}, deep);
    }
    void include(const TriangleBounds& b) {
        lower = lesser(b.lower, lower);
        upper = greater(b.upper, upper);
        deep = lesser(b.deep, deep);
    }
    [[nodiscard]] bool empty() const {
        return !(both_at_most(lower, upper) && deep[0] <= -deep[1]);
    }
    [[nodiscard]] Box3 box() const {
        return {{lower[0], lower[1], deep[0]}, {upper[0], upper[1], -deep[1]}};
    }

    /// As `padded`. The padded box of some points contains those of any of them.
    /// Returns false if it is empty.
    bool pad() {
        if (empty()) return false;
        const Double2 across = kPadding * greater(magnitude(lower), magnitude(upper));
        const Double2 far = magnitude(deep);
        const double along = kPadding * (far[0] > far[1] ? far[0] : far[1]);
        lower -= across;
        upper += across;
        deep -= along;
        return true;
    }

  private:
    static Double2 magnitude(Double2 v) { return greater(v, -v); }
};

/// Calls f(id, placed, first, last) for the parts of meshes that the triangles with ids from
/// `begin` to `end` are: `first` and `last` number triangles of the mesh, `id` is that of the first
/// one.
template <class F>
void for_mesh_parts(const PrimitiveTable& table, std::uint32_t begin, std::uint32_t end, F&& f) {
    const std::uint32_t first = table.first(kTriangleKind);
    for (std::uint32_t id = begin; id < end;) {
        const PlacedMesh& placed = table.mesh_of(id - first);
        const auto size = static_cast<std::uint32_t>(placed.mesh->triangles.size());
        const std::uint32_t from = id - first - placed.first_triangle;
        const std::uint32_t until = std::min(size, from + (end - id));
        f(id, placed, from, until);
        id += until - from;
    }
}

/// Calls f(id, a, b, c) with the corners of the triangles with ids from `begin` to `end`.
template <class F>
void for_triangles(const PrimitiveTable& table, std::uint32_t begin, std::uint32_t end, F&& f) {
    constexpr std::uint32_t kAhead = 8;  // triangles prefetched
    for_mesh_parts(
        table, begin, end,
        [&](std::uint32_t id, const PlacedMesh& placed, std::uint32_t first, std::uint32_t last) {
            const auto* const triangles = placed.mesh->triangles.data();
            const Vec3* const p = placed.mesh->positions.data();
            for (std::uint32_t i = first; i < last; ++i) {
                const auto& ahead = triangles[std::min(i + kAhead, last - 1)];
                __builtin_prefetch(p + ahead[0]);
                __builtin_prefetch(p + ahead[1]);
                __builtin_prefetch(p + ahead[2]);
                const auto& corners = triangles[i];
                f(id + (i - first), p[corners[0]], p[corners[1]], p[corners[2]]);
            }
        });
}

}  // namespace alhazen

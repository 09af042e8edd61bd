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
        constexpr double kRelative = 8e-16;
        const Double2 across = kRelative * greater(magnitude(lower), magnitude(upper));
        const Double2 far = magnitude(deep);
        const double along = kRelative * (far[0] > far[1] ? far[0] : far[1]);
        lower -= across;
        upper += across;
        deep -= along;
        return true;
    }

  private:
    static Double2 magnitude(Double2 v) { return greater(v, -v); }
};

/// Calls f(id, a, b, c) with the corners of the triangles with ids from `begin` to `end`.
template <class F>
void for_triangles(const PrimitiveTable& table, std::uint32_t begin, std::uint32_t end, F&& f) {
    constexpr std::uint32_t kAhead = 8;  // triangles prefetched
    const std::uint32_t first = table.first(kTriangleKind);
    for (std::uint32_t id = begin; id < end;) {
        const PlacedMesh& placed = table.mesh_of(id - first);
        const TriangleMesh& mesh = *placed.mesh;
        const std::uint32_t first_of_mesh = first + placed.first_triangle;
        const std::uint32_t last =
            std::min(end, first_of_mesh + static_cast<std::uint32_t>(mesh.triangles.size()));
        const auto* const triangles = mesh.triangles.data();
        const Vec3* const p = mesh.positions.data();
        for (; id < last; ++id) {
            const auto& ahead = triangles[std::min(id + kAhead, last - 1) - first_of_mesh];
            __builtin_prefetch(p + ahead[0]);
            __builtin_prefetch(p + ahead[1]);
            __builtin_prefetch(p + ahead[2]);
            const auto& corners = triangles[id - first_of_mesh];
            f(id, p[corners[0]], p[corners[1]], p[corners[2]]);
        }
    }
}

}  // namespace alhazen

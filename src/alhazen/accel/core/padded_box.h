#pragma once
/// The box around all primitives, widened so that rounding cannot make a ray miss a cell in it;
/// used by all space subdivisions.
///
/// Conventions: primitives are stored in all cells within `pad` of them. For rays that start at
/// most 2^44 `pad` from the origin of coordinates, the error of their crossings with planes is far
/// smaller (`covers`).

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "alhazen/geometry/bounds_source.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

struct PaddedBox {
    Box3 box;  ///< padded
    double pad = 0;

    PaddedBox() = default;
    explicit PaddedBox(const BoundsSource& source) {
        if (source.size() == 0) return;
        Box3 all;
        for (std::size_t i = 0; i < source.size(); ++i) all.include(source.box(i));
        *this = PaddedBox(all);
    }
    /// The padded box of a nonempty box.
    explicit PaddedBox(const Box3& all) {
        const double reach = std::max(max_component(abs(all.lo)), max_component(abs(all.hi)));
        pad = 0x1p-32 * max_component(all.size()) + 0x1p-46 * reach +
              std::numeric_limits<double>::min();
        box = widened(all);
    }

    [[nodiscard]] Box3 widened(const Box3& b) const {
        return {b.lo - Vec3{pad, pad, pad}, b.hi + Vec3{pad, pad, pad}};
    }
    /// True if the ray starts so near that rounding errors stay far below `pad`.
    [[nodiscard]] bool covers(const Ray& ray) const {
        return max_component(abs(ray.origin)) <= 0x1p44 * pad;
    }
};

/// The part of a ray inside a box.
struct RaySpan {
    double begin, end;  ///< begin > end if the ray misses the box
    Vec3 inverse;       ///< of the direction; infinite if perpendicular to the axis

    RaySpan(const Box3& box, const Ray& ray, double t_max) : begin(ray.t_min), end(t_max) {
        for (int k = 0; k < 3; ++k) {
            inverse[k] = 1.0 / ray.direction[k];
            // Includes components so small that the inverse overflows.
            if (std::isinf(inverse[k])) {
                if (ray.origin[k] < box.lo[k] || ray.origin[k] > box.hi[k]) {
                    begin = std::numeric_limits<double>::infinity();
                    end = -begin;
                }
                continue;
            }
            const double a = (box.lo[k] - ray.origin[k]) * inverse[k];
            const double b = (box.hi[k] - ray.origin[k]) * inverse[k];
            begin = std::max(begin, std::min(a, b));
            end = std::min(end, std::max(a, b));
        }
    }
    [[nodiscard]] bool empty() const { return begin > end; }
};

/// Visits every primitive, for rays that a structure does not cover.
template <class Visitor>
void visit_all(std::uint32_t primitives, Visitor& visitor) {
    for (std::uint32_t i = 0; i < primitives; ++i) {
        if (visitor.visit(i)) return;
    }
}

}  // namespace alhazen

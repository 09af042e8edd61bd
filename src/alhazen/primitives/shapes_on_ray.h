#pragma once
/// The shapes of a table and of its instances, with a ray in their frames, one after the other.

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <tuple>
#include <type_traits>

#include "alhazen/math/interval.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// The range of t on the whole line of `ray` in a box; empty (lo > hi) if the line misses it.
[[nodiscard]] inline Interval range_in(const Box3& box, const Ray& ray) {
    Interval range{-kInfinity, kInfinity};
    for (int k = 0; k < 3; ++k) {
        const double d = ray.direction[k], lo = box.lo[k] - ray.origin[k],
                     hi = box.hi[k] - ray.origin[k];
        if (d == 0.0) {
            if (lo > 0.0 || hi < 0.0) return {kInfinity, -kInfinity};
            continue;
        }
        range.lo = std::max(range.lo, (d > 0.0 ? lo : hi) / d);
        range.hi = std::min(range.hi, (d > 0.0 ? hi : lo) / d);
    }
    return range;
}

/// True if the line from t = 0 on meets the box.
[[nodiscard]] inline bool meets_ahead(const Box3& box, const Ray& ray) {
    const Interval range = range_in(box, ray);
    return range.lo <= range.hi && range.hi >= 0.0;
}

/// Calls visitor(shape, ray in the frame of the shape, number of its part) for each shape that it
/// takes. `ray` is in the frame of the table. Instances
/// whose boxes the ray does not meet are left out. Recursion ends with the nesting of instances.
template <class Visitor>
void visit_shapes_on_ray(const PrimitiveTable& table, const Ray& ray, Visitor&& visitor) {
    const auto look_at = [&](const auto& column) {
        using Shape = typename std::remove_cvref_t<decltype(column.shapes)>::value_type;
        if constexpr (std::invocable<Visitor&, const Shape&, const Ray&, std::uint32_t>) {
            for (std::size_t i = 0; i < column.shapes.size(); ++i) {
                const std::uint32_t placement = column.placements[i];
                visitor(column.shapes[i],
                        placement == kNoPlacement
                            ? ray
                            : transformed(table.placements[placement].inner_from_outer, ray),
                        column.parts.empty() ? 0u : column.parts[i]);
            }
        }
    };
    std::apply([&](const auto&... column) { (look_at(column), ...); }, table.columns);
    for (const Instance& instance : table.instances) {
        const Ray inner = inner_ray(instance, ray);
        if (!meets_ahead(instance.aggregate->box(), inner)) continue;
        visit_shapes_on_ray(instance.aggregate->primitives(), inner, visitor);
    }
}

}  // namespace alhazen

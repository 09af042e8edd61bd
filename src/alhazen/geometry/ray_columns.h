#pragma once
/// Many rays in float, and their nearest hits, as structures of arrays: what a program has that
/// keeps a column of numbers for each coordinate. They are read and written in place.
///
/// Conventions: as those of `Ray`. A float is a double, so the hits are those of the same numbers
/// in double, bit for bit. Rays from one point or with one range need no columns for these.

#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

struct RayColumns {
    using Axes = std::array<std::span<const float>, 3>;  ///< [axis][ray]

    Axes directions;
    Axes origins{};                         ///< empty: all rays begin in `origin`
    std::span<const float> t_min, t_max{};  ///< empty: all rays have the range of `range`
    std::array<float, 3> origin{};
    std::array<float, 2> range{0.0f, std::numeric_limits<float>::infinity()};

    [[nodiscard]] std::size_t size() const { return directions[0].size(); }
    [[nodiscard]] bool from_one_point() const { return origins[0].empty(); }
    /// True if every column has as many numbers as there are rays, or none where it may be empty.
    [[nodiscard]] bool is_complete() const {
        const std::size_t n = size();
        const std::size_t origin_count = from_one_point() ? 0 : n;
        for (std::size_t k = 0; k < 3; ++k) {
            if (directions[k].size() != n || origins[k].size() != origin_count) return false;
        }
        return (t_min.empty() || t_min.size() == n) && (t_max.empty() || t_max.size() == n);
    }
    [[nodiscard]] Ray ray(std::size_t i) const {
        Ray ray;
        for (int axis = 0; axis < 3; ++axis) {
            const auto k = static_cast<std::size_t>(axis);
            ray.origin[axis] = from_one_point() ? origin[k] : origins[k][i];
            ray.direction[axis] = directions[k][i];
        }
        ray.t_min = t_min.empty() ? range[0] : t_min[i];
        ray.t_max = t_max.empty() ? range[1] : t_max[i];
        return ray;
    }
    /// The rays [first, first + count).
    [[nodiscard]] RayColumns part(std::size_t first, std::size_t count) const {
        RayColumns part = *this;
        for (std::size_t k = 0; k < 3; ++k) {
            part.directions[k] = directions[k].subspan(first, count);
            if (!from_one_point()) part.origins[k] = origins[k].subspan(first, count);
        }
        if (!t_min.empty()) part.t_min = t_min.subspan(first, count);
        if (!t_max.empty()) part.t_max = t_max.subspan(first, count);
        return part;
    }
};

/// Where nearest hits are written. Empty columns are not.
struct HitColumns {
    std::span<double> t{};               ///< infinite without a hit
    std::span<double> u{}, v{};          ///< 0 without a hit
    std::span<PrimitiveId> primitive{};  ///< `Hit::top`; kNoPrimitive without a hit

    void set(std::size_t i, const Hit& hit) const {
        if (!t.empty()) t[i] = hit.t;
        if (!u.empty()) u[i] = hit.u;
        if (!v.empty()) v[i] = hit.v;
        if (!primitive.empty()) primitive[i] = hit.top();
    }
    /// Sets as many as there are, from `first` on.
    void set(std::size_t first, std::span<const Hit> hits) const {
        const std::size_t n = hits.size();
        const HitColumns to = part(first, n);
        for (std::size_t i = 0; !t.empty() && i < n; ++i) to.t[i] = hits[i].t;
        for (std::size_t i = 0; !u.empty() && i < n; ++i) to.u[i] = hits[i].u;
        for (std::size_t i = 0; !v.empty() && i < n; ++i) to.v[i] = hits[i].v;
        for (std::size_t i = 0; !primitive.empty() && i < n; ++i) to.primitive[i] = hits[i].top();
    }
    [[nodiscard]] HitColumns part(std::size_t first, std::size_t count) const {
        const auto of = [&](auto column) {
            return column.empty() ? column : column.subspan(first, count);
        };
        return {of(t), of(u), of(v), of(primitive)};
    }
};

}  // namespace alhazen

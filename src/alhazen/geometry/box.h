#pragma once
/// Axis-aligned boxes; a box is empty if `lo > hi` in any coordinate.

#include <algorithm>
#include <array>

#include "alhazen/math/affine.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/interval.h"

namespace alhazen {

struct Box3 {
    Vec3 lo{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
            std::numeric_limits<double>::infinity()};
    Vec3 hi = -lo;

    [[nodiscard]] bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
    [[nodiscard]] bool bounded() const { return is_finite(lo) && is_finite(hi); }
    [[nodiscard]] Vec3 center() const { return 0.5 * lo + 0.5 * hi; }
    [[nodiscard]] Vec3 size() const { return empty() ? Vec3{} : hi - lo; }
    [[nodiscard]] bool contains(const Vec3& p) const {
        return lo.x <= p.x && p.x <= hi.x && lo.y <= p.y && p.y <= hi.y && lo.z <= p.z &&
               p.z <= hi.z;
    }
    [[nodiscard]] double half_area() const {
        const Vec3 s = size();
        return s.x * s.y + s.y * s.z + s.z * s.x;
    }
    void include(const Vec3& p) {
        lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
    }
    void include(const Box3& b) {
        lo = {std::min(lo.x, b.lo.x), std::min(lo.y, b.lo.y), std::min(lo.z, b.lo.z)};
        hi = {std::max(hi.x, b.hi.x), std::max(hi.y, b.hi.y), std::max(hi.z, b.hi.z)};
    }
    [[nodiscard]] Vec3 corner(int i) const {
        return {i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z};
    }
    friend bool operator==(const Box3&, const Box3&) = default;
};

inline constexpr Box3 kAllSpace{{-kInfinity, -kInfinity, -kInfinity},
                                {kInfinity, kInfinity, kInfinity}};

/// The intersection of both boxes; the empty box if they are disjoint.
[[nodiscard]] inline Box3 intersection(const Box3& a, const Box3& b) {
    const Box3 both{{std::max(a.lo.x, b.lo.x), std::max(a.lo.y, b.lo.y), std::max(a.lo.z, b.lo.z)},
                    {std::min(a.hi.x, b.hi.x), std::min(a.hi.y, b.hi.y), std::min(a.hi.z, b.hi.z)}};
    return both.empty() ? Box3{} : both;
}

/// The box enlarged on every side by `relative` times the largest magnitude of a coordinate along
/// the same axis that is not infinite, a margin for the rounding errors of its computation.
[[nodiscard]] inline Box3 padded(const Box3& box, double relative = 8e-16) {
    if (box.empty()) return box;
    Vec3 reach{std::max(std::abs(box.lo.x), std::abs(box.hi.x)),
               std::max(std::abs(box.lo.y), std::abs(box.hi.y)),
               std::max(std::abs(box.lo.z), std::abs(box.hi.z))};
    if (!box.bounded()) {
        for (int k = 0; k < 3; ++k) {
            if (reach[k] < kInfinity) continue;
            reach[k] = std::min(std::abs(box.lo[k]), std::abs(box.hi[k]));
            if (!(reach[k] < kInfinity)) reach[k] = 0.0;
        }
    }
    const Vec3 pad = relative * reach;
    return {box.lo - pad, box.hi + pad};
}

/// A box that contains the image of `box`: the bounds of the eight corners, padded for rounding.
[[nodiscard]] inline Box3 transformed(const Affine& to_from, const Box3& box) {
    if (box.empty()) return box;
    if (!box.bounded()) return kAllSpace;
    Box3 image;
    for (int i = 0; i < 8; ++i) image.include(to_from.point(box.corner(i)));
    // The rounding error grows with the magnitudes of the terms, not with their sum.
    const Vec3 reach{std::max(std::abs(box.lo.x), std::abs(box.hi.x)),
                     std::max(std::abs(box.lo.y), std::abs(box.hi.y)),
                     std::max(std::abs(box.lo.z), std::abs(box.hi.z))};
    const Mat3& m = to_from.linear;
    const Vec3 terms = reach.x * abs(m.x_axis) + reach.y * abs(m.y_axis) + reach.z * abs(m.z_axis) +
                       abs(to_from.translation);
    const Vec3 pad = 8e-16 * terms;
    return {image.lo - pad, image.hi + pad};
}

}  // namespace alhazen

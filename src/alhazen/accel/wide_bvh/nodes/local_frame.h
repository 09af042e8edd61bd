#pragma once
/// The frame of the float boxes of a wide BVH: the scene moved to the origin and scaled by a power
/// of two into [-1, 1], so that scenes that are far from the origin, huge or tiny have the full
/// resolution of float.
///
/// Coordinates that are exact in float stay exact: a scene with the origin near its middle is only
/// scaled, and the center of another has few digits.
/// Conventions: local = (world - center) * scale, computed in double. The rounding errors of this
/// and of the exact tests are covered once per ray (`SlabRay`), not in the boxes; boxes cover only
/// the rounding to float.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "alhazen/accel/wide_bvh/nodes/wide_node.h"
#include "alhazen/geometry/box.h"

namespace alhazen {

/// The largest float not above `x`, and the smallest not below it.
inline float round_down(double x) {
    const float f = static_cast<float>(x);
    if (static_cast<double>(f) <= x) return f;
    if (f == 0.0f) return -std::numeric_limits<float>::denorm_min();
    // One step towards -infinity: away from zero increments the bits.
    const auto bits = std::bit_cast<std::uint32_t>(f);
    return std::bit_cast<float>(f > 0.0f ? bits - 1 : bits + 1);
}
inline float round_up(double x) {
    return -round_down(-x);
}

/// Bound of the distance of a computed hit from the ray, relative to the distances involved.
inline constexpr double kExactTestSlack = 0x1p-38;

/// A bound that grows with the distance of a ray's origin, measured by its largest local
/// coordinate.
struct DistanceBound {
    float slope, constant;
    [[nodiscard]] float at(float distance) const { return slope * distance + constant; }
    friend bool operator==(const DistanceBound&, const DistanceBound&) = default;
};

/// Constants of the slack of the rays of one frame (see SlabRay). All are a little larger than the
/// exact sums, for their own rounding.
struct FrameSlack {
    DistanceBound delta;  ///< displacement that covers the errors of computations in double
    DistanceBound reach;  ///< bound of the distance of all scene coordinates from the origin
    DistanceBound slab;   ///< slack of the slab test for a direction of length 1
    float least_length;   ///< rays with a shorter direction take the slow path
                          ///< (local_ray_from_afar)

    /// `offset` is LocalFrame::offset, `usual` is LocalFrame::usual.
    explicit FrameSlack(double offset = 0, bool usual = true)
        : delta{kMore * static_cast<float>(kExactTestSlack),
                kMore * static_cast<float>(kExactTestSlack * (1.0 + offset))},
          reach{kMore + 2.0f * delta.slope, kMore + 2.0f * delta.constant},
          slab{6.5f * 0x1p-24f * reach.slope + kMore * delta.slope,
               6.5f * 0x1p-24f * reach.constant + kMore * delta.constant},
          least_length(usual ? 0x1p-40f : std::numeric_limits<float>::infinity()) {}

    friend bool operator==(const FrameSlack&, const FrameSlack&) = default;

  private:
    static constexpr float kMore = 1.0001f;
};

struct LocalFrame {
    Vec3 center;
    double scale = 1;
    double inverse_scale = 1;
    /// Largest coordinate of the center, in local units: the loss of precision by the translation.
    double offset = 0;
    /// False if exponents could leave the range of double in the exact tests.
    bool usual = true;
    FrameSlack slack;

    LocalFrame() = default;
    /// `box` must be finite or empty, with coordinates up to 1e150.
    explicit LocalFrame(const Box3& box) {
        if (box.empty()) return;
        const bool near = max_component(abs(box.center())) <= max_component(box.size());
        if (!near) center = short_center(box);
        const double far = max_component(abs(center));
        const double half =
            std::max(max_component(abs(box.lo - center)), max_component(abs(box.hi - center)));
        // Not finer than the rounding of the coordinates.
        const double reach = std::max({half, far * 0x1p-30, 0x1p-500});
        scale = std::ldexp(1.0, -std::ilogb(reach) - 1);
        inverse_scale = 1.0 / scale;
        offset = far * scale;
        usual = is_usual(scale);
        slack = FrameSlack(offset, usual);
    }

    /// About the center of a box that is farther from the origin than it is long. Along an axis
    /// where it is not, 0: a float less the center would need more digits than it has.
    [[nodiscard]] static Vec3 short_center(const Box3& box) {
        const Vec3 middle = box.center(), size = box.size();
        const double unit =
            std::max({max_component(size), max_component(abs(middle)) * 0x1p-46, 0x1p-500});
        const double step = std::ldexp(1.0, std::ilogb(unit) - 4);
        Vec3 center;
        for (int k = 0; k < 3; ++k) {
            if (std::abs(middle[k]) > size[k] + step) {
                center[k] = std::round(middle[k] / step) * step;
            }
        }
        return center;
    }
    [[nodiscard]] static bool is_usual(double scale) {
        return scale >= 0x1p-200 && scale <= 0x1p200;
    }
    [[nodiscard]] Vec3 local(const Vec3& p) const { return scale * (p - center); }
    /// The point with these local coordinates, rounded.
    [[nodiscard]] Vec3 world(const Vec3& local) const { return inverse_scale * local + center; }
    [[nodiscard]] FloatBox local(const Box3& box) const {
        const Vec3 lo = local(box.lo);
        const Vec3 hi = local(box.hi);
        FloatBox out;
        for (int k = 0; k < 3; ++k) {
            out.lo[k] = round_down(lo[k]);
            out.hi[k] = round_up(hi[k]);
        }
        return out;
    }
};

}  // namespace alhazen

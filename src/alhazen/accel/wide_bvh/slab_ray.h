#pragma once
/// A ray made ready for the slab test on float boxes: the test never loses a box in which the
/// exact test, in double, of a primitive can find a hit.
///
/// Source: Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013 (the problem).
/// Differs: a relative factor on the far distance is not enough for the form p * r + c; all slack
/// is absolute and folded into the constants c, once per ray.
/// For a hit at parameter s with |s| <= T, and e = 2^-24:
/// - plane parameter s_p = (p - o) / d; computed fl(fl(p r) + c), r = (1 / d) (1 + e1), |e1| <= e
/// - near plane, s_p <= s: computed <= s when c is lowered by 2.2 e T (rounding of r and of the
///   sum), e |r| (of the product, where multiply-add is not fused) and delta |r|
/// - far plane: the mirror image
///
/// `delta` is a displacement in space that covers everything done in double: the local frame, the
/// shift of the origin, the rounding inside the exact tests (whose computed hit lies that near to
/// the ray). A direction component below 2^-60 is replaced by that: inside the scene this
/// displaces the ray by less than delta. An origin that is not near the scene is first moved
/// along the ray to the point nearest to the scene's center.
/// Conventions: parameters in the local frame, s = t * t_scale - t_shift, with the largest
/// direction component in [1, 2). A ray from farther than 2^40 scene sizes passes every box:
/// doubles say nothing at that distance.

#include <bit>
#include <cstdint>

#include "alhazen/accel/wide_bvh/local_frame.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

/// Bound, relative to the distances in play, of how far from the ray a computed hit can be.
inline constexpr double kExactTestSlack = 0x1p-38;

/// A float not above `x` (or not below), by up to two steps more than needed, without a branch:
/// which way a number is rounded cannot be predicted.
inline float well_below(double x) {
    return static_cast<float>(x - (std::abs(x) * 0x1p-23 + 0x1p-100));
}
inline float well_above(double x) {
    return static_cast<float>(x + (std::abs(x) * 0x1p-23 + 0x1p-100));
}

struct SlabRay {
    float reciprocal[3];
    float near_offset[3], far_offset[3];
    float s_min, s_max;
    std::uint32_t near_row[3];  ///< row of WideNode::planes of the near plane of each axis
    double t_scale = 0;         ///< 0: parameters do not fit, nothing is skipped because of them
    double t_shift = 0;

    /// The ray must be valid.
    SlabRay(const LocalFrame& frame, const Ray& ray);

    [[nodiscard]] std::uint32_t far_row(int axis) const { return (near_row[axis] + 3) % 6; }
    /// The local parameter of t, rounded up: boxes that begin beyond it cannot hold a hit at t.
    [[nodiscard]] float local_max(double t) const {
        if (t_scale == 0) return std::numeric_limits<float>::infinity();
        const double s = t * t_scale;
        return well_above(s - t_shift + margin(s));
    }
    /// Rounded down.
    [[nodiscard]] float local_min(double t) const {
        if (t_scale == 0) return -std::numeric_limits<float>::infinity();
        const double s = t * t_scale;
        return well_below(s - t_shift - margin(s));
    }

  private:
    [[nodiscard]] double margin(double s) const {
        return 0x1p-50 * (std::abs(s) + std::abs(t_shift));
    }
    void pass_everything();
};

inline void SlabRay::pass_everything() {
    for (int k = 0; k < 3; ++k) {
        // A free slot still fails: its planes are infinite.
        reciprocal[k] = 1.0f;
        near_offset[k] = -1e30f;
        far_offset[k] = 1e30f;
        near_row[k] = static_cast<std::uint32_t>(k);
    }
    s_min = -std::numeric_limits<float>::infinity();
    s_max = std::numeric_limits<float>::infinity();
    t_scale = 0;
}

/// 2^n for -1022 <= n <= 1023.
inline double power_of_two(int n) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(n + 1023) << 52);
}
/// floor(log2 x) of a normal x > 0.
inline int exponent_of(double x) {
    return static_cast<int>(std::bit_cast<std::uint64_t>(x) >> 52 & 0x7FF) - 1023;
}

inline SlabRay::SlabRay(const LocalFrame& frame, const Ray& ray) {
    const auto largest = [](const Vec3& a) {
        const Vec3 m = abs(a);
        return std::max(m.x, std::max(m.y, m.z));
    };
    Vec3 origin = frame.local(ray.origin);
    const double distance = largest(origin);
    const double length = largest(ray.direction);
    // Outside these limits (never in a real scene) exponents would leave the range of double.
    if (!(distance <= 0x1p40 && length >= 0x1p-400 && length <= 0x1p400)) {
        pass_everything();
        return;
    }
    const int exponent = exponent_of(length);
    const Vec3 direction = power_of_two(-exponent) * ray.direction;
    t_scale = power_of_two(exponent) * frame.scale;
    if (!(t_scale >= 0x1p-900 && t_scale <= 0x1p900)) {
        pass_everything();
        return;
    }
    if (distance > 2.0) {
        t_shift = -dot(origin, direction) / dot(direction, direction);
        origin += t_shift * direction;
    }
    const double delta = kExactTestSlack * (1.0 + distance + frame.offset);
    const double reach = largest(origin) + 1.0 + 2.0 * delta;
    for (int k = 0; k < 3; ++k) {
        const double d = direction[k];
        const double steep = std::abs(d) < 0x1p-60 ? std::copysign(0x1p-60, d) : d;
        const float r = static_cast<float>(1.0 / steep);
        const double c = -origin[k] * static_cast<double>(r);
        const double slack =
            0x1p-24 * 2.2 * reach + (0x1p-24 + delta) * std::abs(static_cast<double>(r));
        reciprocal[k] = r;
        near_offset[k] = well_below(c - slack);
        far_offset[k] = well_above(c + slack);
        near_row[k] = static_cast<std::uint32_t>(std::signbit(d) ? k + 3 : k);
    }
    s_min = local_min(ray.t_min);
    s_max = local_max(ray.t_max);
}

}  // namespace alhazen

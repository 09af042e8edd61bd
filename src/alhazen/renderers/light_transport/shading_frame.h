#pragma once
/// The local frame of a surface point: x along the tangent, z the shading normal.

#include <cmath>

#include "alhazen/math/vec.h"

namespace alhazen {

struct ShadingFrame {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< orthonormal, right-handed

    /// `normal` must be unit; `tangent` may have any length. If it is along the normal, x is
    /// arbitrary.
    [[nodiscard]] static ShadingFrame of(const Vec3& normal, const Vec3& tangent) {
        const Vec3 across = tangent - dot(tangent, normal) * normal;
        const double squared = length_squared(across);
        const bool usable = squared > 1e-12 * length_squared(tangent) && squared > 1e-100;
        const Vec3 x = usable ? across / std::sqrt(squared) : perpendicular(normal);
        return {x, cross(normal, x), normal};
    }

    [[nodiscard]] Vec3 to_local(const Vec3& v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
    [[nodiscard]] Vec3 to_world(const Vec3& v) const { return v.x * x + v.y * y + v.z * z; }
};

}  // namespace alhazen

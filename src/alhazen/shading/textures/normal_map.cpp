#include "alhazen/shading/textures/normal_map.h"

#include <cmath>

#include "alhazen/math/unit_vector.h"

namespace alhazen {

TangentFrame frame_from_derivatives(const Vec3& n, const Vec3& dpdu, const Vec3& dpdv) {
    // Normalised first, to avoid overflow and underflow with large or small coordinates.
    return frame_from_tangents(n, unit_or(dpdu, {}), unit_or(dpdv, {}));
}

TangentFrame frame_from_tangents(const Vec3& n, const Vec3& tangent, const Vec3& bitangent) {
    const Vec3 t = unit_or(tangent - dot(n, tangent) * n, {});
    if (t == Vec3{}) return {};
    const Vec3 b = cross(n, t);
    return {t, dot(b, bitangent) < 0.0 ? -b : b};
}

void apply_uv_transform(const UvTransform& transform, Vec3& dpdu, Vec3& dpdv) {
    if (transform.uu == 1.0 && transform.uv == 0.0 && transform.vu == 0.0 && transform.vv == 1.0) {
        return;
    }
    const double determinant = transform.uu * transform.vv - transform.uv * transform.vu;
    if (determinant == 0.0) {
        dpdu = dpdv = {};
        return;
    }
    const Vec3 by_u = (transform.vv * dpdu - transform.vu * dpdv) / determinant;
    const Vec3 by_v = (transform.uu * dpdv - transform.uv * dpdu) / determinant;
    const bool usable = is_finite(by_u) && is_finite(by_v);
    dpdu = usable ? by_u : Vec3{};
    dpdv = usable ? by_v : Vec3{};
}

Vec3 bent_normal(const Rgb& texel, double scale, const Vec3& n, const TangentFrame& frame) {
    if (frame.tangent == Vec3{}) return n;
    const double x = scale * (2.0 * texel.r - 1.0);
    const double y = scale * (2.0 * texel.g - 1.0);
    const double z = 2.0 * texel.b - 1.0;
    const Vec3 bent = unit_or(x * frame.tangent + y * frame.bitangent + z * n, {});
    return bent == Vec3{} ? n : bent;
}

}  // namespace alhazen

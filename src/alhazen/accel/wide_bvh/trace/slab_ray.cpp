#include "alhazen/accel/wide_bvh/trace/slab_ray.h"

#include <algorithm>

namespace alhazen {

LocalRay local_ray_from_afar(const LocalFrame& frame, const Ray& ray) {
    LocalRay local{};
    local.valid = is_valid(ray);
    if (!local.valid) return local;
    const Vec3 origin = frame.local(ray.origin);
    const double distance = max_component(abs(origin));
    const double length = max_component(abs(ray.direction));
    // Outside these limits exponents could leave the range of double, here or in the exact test,
    // whose products have the third power of a length.
    local.regular = frame.usual && distance <= 0x1p40 && length >= 0x1p-200 && length <= 0x1p200;
    if (!local.regular) {
        local.above[1] = std::numeric_limits<float>::infinity();
        return local;
    }
    const int exponent = std::ilogb(length);
    const Vec3 d = std::ldexp(1.0, -exponent) * ray.direction;
    // To the point nearest to the center, and back so far that the scene begins at 0 or later.
    const bool near = distance <= 2.0 && ray.t_min >= 0.0;
    const double shift = near ? 0.0 : -dot(origin, d) / dot(d, d) - 2.0;
    const Vec3 o = origin + shift * d;
    for (int k = 0; k < 3; ++k) {
        local.origin[k] = static_cast<float>(o[k]);
        local.direction[k] = static_cast<float>(d[k]);
    }
    local.main_axis = static_cast<std::uint32_t>(dominant_axis(ray.direction));
    const double delta = kExactTestSlack * (distance + 1.0 + frame.offset);
    local.delta = static_cast<float>(delta);
    local.reach = static_cast<float>(max_component(abs(o)) + 1.0 + 2.0 * delta);
    local.parameter = {std::ldexp(frame.scale, exponent), shift};
    constexpr double kEnd = 1e37;  // finite in float, beyond every scene
    const double first = std::max(ray.t_min, (shift - kEnd) / local.parameter.scale);
    const double last = std::min(ray.t_max, (shift + kEnd) / local.parameter.scale);
    local.below[0] = local.parameter.below(first);
    local.below[1] = local.parameter.below(last);
    local.above[0] = local.parameter.above(first);
    local.above[1] = local.parameter.above(last);
    return local;
}

void pass_everything(SlabRay& slabs) {
    for (std::size_t k = 0; k < 3; ++k) {
        slabs.reciprocal[k] = 1.0f;
        slabs.near_offset[k] = -1e30f;
        slabs.far_offset[k] = 1e30f;
    }
    slabs.near = kNearRows[0];
    slabs.s_min = 0.0f;
    slabs.s_max = std::numeric_limits<float>::infinity();
}

}  // namespace alhazen

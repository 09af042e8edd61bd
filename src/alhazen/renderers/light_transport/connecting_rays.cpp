#include "alhazen/renderers/light_transport/connecting_rays.h"

namespace alhazen {

Ray ray_ending_at(const Ray& ray, const Vec3& end, double facing) {
    const Vec3 way = end - ray.origin;
    if (!(dot(way, ray.direction) > 0.0)) {
        return {ray.origin, ray.direction, ray.t_min, ray.t_min};
    }
    const double distance = length(way);
    const double off = rounding_of_tests(ray.origin, distance);
    return {ray.origin, way / distance, ray.t_min, end_before(distance, off, facing)};
}

}  // namespace alhazen

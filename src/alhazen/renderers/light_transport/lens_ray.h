#pragma once
/// Rays that connect light paths to the lens.

#include "alhazen/renderers/light_transport/camera_lens.h"
#include "alhazen/renderers/light_transport/camera_rays.h"
#include "alhazen/renderers/light_transport/connecting_rays.h"
#include "alhazen/renderers/light_transport/random_walk.h"

namespace alhazen {

/// The ray from the lens to a vertex; it ends before the surface of the vertex. Its end is outside
/// the error bound of the surface. That contains the rounding of tests of rays from near it: the
/// ray ends earlier by what those from the lens round more.
[[nodiscard]] inline Ray from_lens(const PathVertex& v, const LensConnection& joined) {
    const Ray back = v.leaving(joined.to_lens, joined.distance);
    Ray ray{back.at(joined.distance), -joined.to_lens};
    const double off = rounding_of_tests(ray.origin, joined.distance);
    ray.t_max = end_before(joined.distance, off, v.facing(joined.to_lens));
    return ray;
}

/// The volumes around the origin of that ray. If none scatters and no boundary is open, those at
/// the vertex, since the whole ray is in one volume. `behind`: storage, as in
/// PathVertex::media_along.
[[nodiscard]] inline const MediumStack& media_from_lens(const CameraRays& camera, const Ray& ray,
                                                        float time, const PathVertex& v,
                                                        MediumStack& behind) {
    if (!camera.follows_volumes()) return v.media_along(-ray.direction, behind);
    behind = camera.media(ray, time);
    return behind;
}

}  // namespace alhazen

#pragma once
/// What surrounds a ray of Whitted's equation, and where a ray that leaves a surface is.

#include <cstdint>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/renderers/core/local_shading.h"

namespace alhazen {

/// The medium in which a ray starts.
struct RayMedium {
    bool inside = false;       ///< a transparent solid, or behind the front of an open surface
    bool hidden = false;       ///< shadow rays do not start in it: it has no inside, or is unseen
    Rgb absorption;            ///< of it
    std::uint32_t medium = 0;  ///< of ExactOptics if used, else of TintedMedia
};

/// True if a ray that leaves the point along `direction` starts on the other side of the surface
/// than that from which the point is seen. The true surface decides, not interpolated normals.
[[nodiscard]] inline bool goes_behind(const ShadingPoint& point, const Vec3& direction) {
    // As LeavingRays: the start and the medium are on the same side.
    return (dot(direction, point.surface.normal) >= 0.0) != point.entering;
}

/// True if behind the surface is another medium than before it, or may be.
[[nodiscard]] inline bool bounds_media(const ShadingPoint& point) {
    const BehindSurface& behind = point.behind;
    if (point.material->thin && !behind.joined) return false;
    // Where a body is opaque it is not entered.
    if (behind.known) return !behind.inside || !behind.kt.is_black();
    return !point.entering || !point.medium.is_black();
}

}  // namespace alhazen

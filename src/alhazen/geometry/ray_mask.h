#pragma once
/// Visibility masks of rays and primitives.
///
/// Source: Embree and OptiX manuals, visibility masks of geometries and instances.
/// Conventions: a ray sees a primitive if both masks share a bit and, inside instances, if the same
/// holds for every instance around it. A ray of mask 0 sees nothing. Renderers query with one bit,
/// that of the ray's kind; other programs may define the bits themselves.

#include <array>
#include <cstddef>
#include <cstdint>

namespace alhazen {

using RayMask = std::uint32_t;

/// The default mask of primitives and rays.
inline constexpr RayMask kAllRays = 0xFFFFFFFFu;

/// Kinds of rays of a renderer, as in published ray counts.
enum class RayKind { Eye, Shadow, Reflection, Refraction };
inline constexpr std::size_t kRayKindCount = 4;
inline constexpr std::array<const char*, kRayKindCount> kRayKindNames{"eye", "shadow", "reflection",
                                                                      "refraction"};

[[nodiscard]] constexpr RayMask mask_of(RayKind kind) {
    return RayMask{1} << static_cast<unsigned>(kind);
}
/// The bits of all kinds; renderers ignore all others.
inline constexpr RayMask kRaysOfAllKinds = (RayMask{1} << kRayKindCount) - 1;

/// Light between two points of a path of light transport. Its bit is that of shadow rays, except on
/// the surfaces of lights: they cast no shadow rays' shadow, but paths meet them as any surface.
inline constexpr RayMask kConnectingRays = RayMask{1} << kRayKindCount;
/// The mask of the surface of a light.
inline constexpr RayMask kLightSurfaceMask =
    (kRaysOfAllKinds & ~mask_of(RayKind::Shadow)) | kConnectingRays;

}  // namespace alhazen

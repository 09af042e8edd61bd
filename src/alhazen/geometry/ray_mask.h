#pragma once
/// Which rays see what: every primitive says which it is visible to, every query which rays it is
/// for.
///
/// Source: Embree and OptiX, visibility masks of geometries and instances, by their manuals.
/// Differs: nothing.
/// Conventions: a primitive is seen where its mask and that of the ray have a bit in common; inside
/// of instances, where that holds for every instance around it too. A ray of mask 0 sees nothing.
/// Renderers ask with one bit, that of the ray's kind; other programs give the bits meanings of
/// their own.

#include <array>
#include <cstddef>
#include <cstdint>

namespace alhazen {

using RayMask = std::uint32_t;

/// What a primitive is visible to, and what a ray sees, unless something else is said.
inline constexpr RayMask kAllRays = 0xFFFFFFFFu;

/// Rays of a renderer, as the field's published counts know them.
enum class RayKind { Eye, Shadow, Reflection, Refraction };
inline constexpr std::size_t kRayKindCount = 4;
inline constexpr std::array<const char*, kRayKindCount> kRayKindNames{"eye", "shadow", "reflection",
                                                                      "refraction"};

[[nodiscard]] constexpr RayMask mask_of(RayKind kind) {
    return RayMask{1} << static_cast<unsigned>(kind);
}
/// The rays of all kinds; other bits mean nothing to renderers.
inline constexpr RayMask kRaysOfAllKinds = (RayMask{1} << kRayKindCount) - 1;

}  // namespace alhazen

#pragma once
/// Chains of one or two mirror reflections or refractions at one part of a scene, traced from a
/// point, with the derivatives of their end.
///
/// Source: Igehy, "Tracing Ray Differentials", SIGGRAPH 1999; Born and Wolf, "Principles of
/// Optics", 7th edition, 1999, section 1.5 (the laws of reflection and refraction).
/// Differs: derivatives are by the direction of the first ray, along two vectors perpendicular to
/// it.
/// Conventions: rays intersect only the part; occlusion by other parts is tested elsewhere.
/// Directions are unit. Reflection and refraction use the shading normal, as paths do.

#include <array>
#include <cstdint>
#include <optional>

#include "alhazen/primitives/surface.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

enum class ChainKind : std::uint8_t { Reflection, Refraction, TwoRefractions };
[[nodiscard]] constexpr int length_of(ChainKind kind) {
    return kind == ChainKind::TwoRefractions ? 2 : 1;
}
[[nodiscard]] constexpr bool refracts(ChainKind kind) {
    return kind != ChainKind::Reflection;
}

/// Key of a part: the surfaces of one material in an outermost instance, shape, mesh or solid.
[[nodiscard]] inline std::uint64_t part_key(std::uint32_t instance, MaterialId material) {
    return std::uint64_t{instance} << 32 | static_cast<std::uint32_t>(material);
}
[[nodiscard]] inline std::uint64_t part_key(const Surface& surface) {
    return part_key(surface.instance, surface.materials[0]);
}

inline constexpr int kMostBends = 2;

struct ChainVertex {
    Ray ray;  ///< the ray of `hit`
    Hit hit;
    Surface surface;
    Vec3 arriving;     ///< direction of the light path, from the eye's side
    Vec3 normal;       ///< unit shading normal, against `arriving`
    Vec3 leaving;      ///< direction after reflection or refraction
    double travelled;  ///< distance from the previous vertex
    double eta = 1;    ///< refractions: index in front over behind
    bool entering = true;
};

struct Chain {
    ChainKind kind = ChainKind::Reflection;
    Vec3 direction;  ///< the first direction
    std::array<ChainVertex, kMostBends> at;

    [[nodiscard]] int length() const { return length_of(kind); }
    [[nodiscard]] const ChainVertex& last() const {
        return at[static_cast<std::size_t>(length() - 1)];
    }
};

/// Indices of a chain, in front over behind, with the sides for which they are valid.
struct ChainIndices {
    std::array<double, kMostBends> eta{1, 1};
    std::array<bool, kMostBends> entering{true, true};
};

/// Derivatives of the end of a chain by its first direction.
struct ChainSlope {
    std::array<Vec3, 2> first;      ///< perpendicular to the first direction
    std::array<Vec3, 2> point;      ///< derivatives of the first vertex by these
    std::array<Vec3, 2> end;        ///< derivatives of the last vertex
    std::array<Vec3, 2> direction;  ///< derivatives of the last direction
};

class ChainTracer {
  public:
    ChainTracer(const Scene& scene, RayCounters& counters) : scene_(scene), counters_(counters) {}

    /// The next surface of the part along a ray; false if there is none.
    [[nodiscard]] bool find(Ray ray, std::uint64_t part, RayKind kind, float time,
                            ChainVertex& vertex) const;
    /// Reflects or refracts at a vertex. False beyond the critical angle, or if the geometric
    /// normal disagrees.
    [[nodiscard]] static bool bend(bool refracted, ChainVertex& vertex);
    /// Traces the chain that leaves `from` along `direction`; false if there is none, or not with
    /// those indices.
    [[nodiscard]] bool follow(const ShapeSurface& from, const Vec3& direction, ChainKind kind,
                              std::uint64_t part, const ChainIndices& indices, float time,
                              Chain& chain) const;
    /// Empty if a normal has no derivative.
    [[nodiscard]] std::optional<ChainSlope> slope(const Chain& chain, float time) const;

  private:
    const Scene& scene_;
    RayCounters& counters_;
};

}  // namespace alhazen

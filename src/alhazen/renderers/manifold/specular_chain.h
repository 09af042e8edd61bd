#pragma once
/// Chains of one or two mirror reflections and refractions at one part of a scene, followed from a
/// point, with the derivatives of where they lead.
///
/// Source: Igehy, "Tracing Ray Differentials", SIGGRAPH 1999; Born and Wolf, "Principles of
/// Optics", 7th edition, 1999, section 1.5 (the laws of reflection and refraction).
/// Differs: derivatives by the direction of the first ray, in two vectors perpendicular to it.
/// Conventions: only the part counts: rays pass all else, which is left to the tests of visibility.
/// Directions are unit. Bends are those of the shading normal, as paths are.

#include <array>
#include <cstdint>
#include <optional>

#include "alhazen/primitives/surface.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

enum class ChainKind : std::uint8_t { Reflection, Refraction, TwoRefractions };
inline constexpr int kChainKinds = 3;
[[nodiscard]] constexpr int length_of(ChainKind kind) {
    return kind == ChainKind::TwoRefractions ? 2 : 1;
}
[[nodiscard]] constexpr bool refracts(ChainKind kind) {
    return kind != ChainKind::Reflection;
}

/// The surfaces of one material in what a part of the scene placed: a shape, a mesh, a solid.
[[nodiscard]] inline std::uint64_t part_key(std::uint32_t instance, MaterialId material) {
    return std::uint64_t{instance} << 32 | static_cast<std::uint32_t>(material);
}
[[nodiscard]] inline std::uint64_t part_key(const Surface& surface) {
    return part_key(surface.instance, surface.materials[0]);
}

inline constexpr int kMostBends = 2;

struct ChainVertex {
    Ray ray;  ///< that found `hit`
    Hit hit;
    Surface surface;
    Vec3 arriving;     ///< direction of the light path, from the eye's side
    Vec3 normal;       ///< unit, shading, against `arriving`
    Vec3 leaving;      ///< direction behind it
    double travelled;  ///< since the vertex before
    double eta = 1;    ///< index before it over that behind; of refractions
    bool entering = true;
};

struct Chain {
    ChainKind kind = ChainKind::Reflection;
    Vec3 direction;  ///< with which it sets out
    std::array<ChainVertex, kMostBends> at;

    [[nodiscard]] int length() const { return length_of(kind); }
    [[nodiscard]] const ChainVertex& last() const {
        return at[static_cast<std::size_t>(length() - 1)];
    }
};

/// Indices of a chain, before over behind, with the sides they hold for.
struct ChainIndices {
    std::array<double, kMostBends> eta{1, 1};
    std::array<bool, kMostBends> entering{true, true};
};

/// How the end of a chain changes with its first direction.
struct ChainSlope {
    std::array<Vec3, 2> first;      ///< perpendicular to the first direction
    std::array<Vec3, 2> point;      ///< change of the first vertex by these
    std::array<Vec3, 2> end;        ///< of the last vertex
    std::array<Vec3, 2> direction;  ///< of the direction behind it
};

class ChainTracer {
  public:
    ChainTracer(const Scene& scene, RayCounters& counters) : scene_(scene), counters_(counters) {}

    /// The next surface of the part along a ray; false: it does not meet it.
    [[nodiscard]] bool find(Ray ray, std::uint64_t part, RayKind kind, float time,
                            ChainVertex& vertex) const;
    /// Turns the vertex' direction. False beyond the critical angle, and where the geometric normal
    /// disagrees.
    [[nodiscard]] static bool bend(bool refracted, ChainVertex& vertex);
    /// The chain that leaves `from` along `direction`; false where there is none, or not of those
    /// indices.
    [[nodiscard]] bool follow(const ShapeSurface& from, const Vec3& direction, ChainKind kind,
                              std::uint64_t part, const ChainIndices& indices, float time,
                              Chain& chain) const;
    /// None where a normal has no derivative.
    [[nodiscard]] std::optional<ChainSlope> slope(const Chain& chain, float time) const;

  private:
    const Scene& scene_;
    RayCounters& counters_;
};

}  // namespace alhazen

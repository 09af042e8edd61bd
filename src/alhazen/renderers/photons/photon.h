#pragma once
/// Light that has arrived at a surface, or at a scattering event in a volume, in 48 bytes.
///
/// Source: Jensen, "Global Illumination using Photon Maps", EGWR 1996, section 4 (a compact
/// photon); Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors",
/// JCGT 3(2), 2014 (octahedral vectors).
/// Differs: three floats of power instead of a shared exponent; positions in double, for scenes far
/// from the origin; stores the normal of the surface, to exclude light of the other side of a wall.
/// Conventions: world space; directions are accurate to 10^-4 rad.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "alhazen/math/vec.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

/// A unit vector in 32 bits.
class OctahedralVector {
  public:
    OctahedralVector() = default;
    explicit OctahedralVector(const Vec3& v) {
        const double sum = std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
        double x = v.x / sum, y = v.y / sum;
        if (v.z < 0.0) {
            const double folded = (1.0 - std::abs(y)) * sign(x);
            y = (1.0 - std::abs(x)) * sign(y);
            x = folded;
        }
        x_ = rounded(x);
        y_ = rounded(y);
    }
    [[nodiscard]] Vec3 vector() const { return normalize(along()); }
    /// The direction, not of unit length.
    [[nodiscard]] Vec3 along() const {
        double x = x_ / kScale, y = y_ / kScale;
        const double z = 1.0 - std::abs(x) - std::abs(y);
        if (z < 0.0) {
            const double folded = (1.0 - std::abs(y)) * sign(x);
            y = (1.0 - std::abs(x)) * sign(y);
            x = folded;
        }
        return {x, y, z};
    }
    /// A special value without a direction: `vector` is undefined.
    [[nodiscard]] static OctahedralVector none() {
        OctahedralVector v;
        v.x_ = kNone;
        return v;
    }
    [[nodiscard]] bool is_none() const { return x_ == kNone; }
    friend bool operator==(const OctahedralVector&, const OctahedralVector&) = default;

  private:
    static constexpr std::int16_t kNone = -32768;
    static constexpr double kScale = 32767.0;
    [[nodiscard]] static double sign(double v) { return v < 0.0 ? -1.0 : 1.0; }
    [[nodiscard]] static std::int16_t rounded(double v) {
        return static_cast<std::int16_t>(std::lround(std::clamp(v, -1.0, 1.0) * kScale));
    }

    std::int16_t x_ = 0, y_ = 0;
};

/// Encodes light in 96 bits: RGB channels, or four wavelengths with their radiance.
///
/// Conventions: not negative. Wavelengths have 23 bits each, rounded (within 2^-16); the sign of
/// the first float marks them.
[[nodiscard]] std::array<float, 3> stored_light(const Spectrum& light, const Wavelengths& waves);

struct Photon {
    std::array<double, 3> position{};
    std::array<float, 3> power{};  ///< arriving power, as `stored_light`
    OctahedralVector from;         ///< direction towards its origin
    OctahedralVector normal;       ///< geometric, on that side; none in a volume

    [[nodiscard]] Vec3 point() const { return {position[0], position[1], position[2]}; }
    [[nodiscard]] Spectrum light() const {
        return std::signbit(power[0]) ? light_of_waves()
                                      : Spectrum{power[0], power[1], power[2], power[2]};
    }
    [[nodiscard]] bool in_volume() const { return normal.is_none(); }
    /// True if the hero carries the light of all wavelengths.
    [[nodiscard]] bool hero_only() const {
        return (std::bit_cast<std::uint32_t>(power[0]) >> 30) == 3;
    }

  private:
    [[nodiscard]] Spectrum light_of_waves() const;
};
static_assert(sizeof(Photon) == 48);

/// The scattering of a photon between its light and the surface.
enum class PhotonKind : std::uint8_t {
    Direct,    ///< none
    Caustic,   ///< only mirrors and smooth glass
    Indirect,  ///< some scattering with a density
};

/// A set of kinds.
class PhotonKinds {
  public:
    constexpr PhotonKinds() = default;
    constexpr PhotonKinds(std::initializer_list<PhotonKind> kinds) {
        for (const PhotonKind kind : kinds) bits_ |= bit(kind);
    }
    [[nodiscard]] constexpr bool has(PhotonKind kind) const { return (bits_ & bit(kind)) != 0; }

  private:
    static constexpr unsigned bit(PhotonKind kind) { return 1u << static_cast<unsigned>(kind); }
    unsigned bits_ = 0;
};

}  // namespace alhazen

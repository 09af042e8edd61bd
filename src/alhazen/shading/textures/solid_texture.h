#pragma once
/// Solid textures: patterns in space that can be averaged over an aperture.
///
/// Source: Perlin, "An Image Synthesizer", SIGGRAPH 1985 (noise, marble, wood); Perlin, "Improving
/// Noise", SIGGRAPH 2002; Kirk, "The Simulation of Natural Features Using Cone Tracing", The Visual
/// Computer 3(2), 1987 (the cone's radius as the aperture of a texture); Norton, Rockwood and
/// Computer 3(2), 1987 (the cone's radius as the aperture of a texture); Norton, Rockwood and
/// Skolmoski, "Clamping", SIGGRAPH 1982 (octaves beyond the resolution of the aperture are
/// omitted).
/// Differs: checks and stripes are integrated exactly over the aperture, in closed form if few
/// edges cross it; waves are multiplied by the Fourier transform of the disc.
/// Conventions: world space. The aperture is an ellipse around a point, given by two conjugate
/// semi-axes; both zero: a point. The mean over a large aperture is halfway between the colours.

#include <cstdint>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/vec.h"

namespace alhazen {

/// The place of a lookup.
struct SolidAperture {
    Vec3 point;
    Vec3 a, b;  ///< semi-axes
};

struct SolidTexture {
    enum class Kind : std::uint8_t {
        Checks,   ///< cubes of side `size`
        Stripes,  ///< slabs of thickness `size` across `direction`
        Noise,    ///< sums of octaves, the largest of wavelength `size`
        Marble,   ///< waves of length 2 `size` along `direction`, bent by noise
        Wood,     ///< rings of width `size` around the line along `direction`, bent by noise
    };
    Kind kind = Kind::Checks;
    Rgba color{1, 1, 1, 1};  ///< colour of the cube or slab that begins at `origin`
    Rgba other{0, 0, 0, 1};
    Vec3 origin;
    double size = 1;          ///< > 0
    Vec3 direction{0, 0, 1};  ///< axis of the pattern, of any length but 0
    int octaves = 4;          ///< 1 to 16
    double turbulence = 1;    ///< marble and wood: displacement by noise, in units of `size`
    friend bool operator==(const SolidTexture&, const SolidTexture&) = default;
};

/// The mean colour over the aperture.
[[nodiscard]] Rgba evaluate(const SolidTexture& texture, const SolidAperture& aperture);

/// Gradient noise of wavelength 1, about -1 to 1, zero at whole coordinates.
[[nodiscard]] double gradient_noise(const Vec3& p);

}  // namespace alhazen

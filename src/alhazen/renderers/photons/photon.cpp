#include "alhazen/renderers/photons/photon.h"

namespace alhazen {

namespace {

// Layout of the 96 bits: the mark, the flag of the hero, the first wavelength and 7 bits of the
// last one; the second and 9 bits; the third and 7 bits.
constexpr std::uint32_t kMark = 1u << 31, kHero = 1u << 30;

/// Exponent and 15 fraction bits of a non-negative float.
std::uint32_t rounded_float(double value) {
    const float f = static_cast<float>(std::max(0.0, value));
    return std::min((std::bit_cast<std::uint32_t>(f) + 0x80u) >> 8, 0x7f7fffu);
}
double float_of(std::uint32_t bits) {
    return double{std::bit_cast<float>(bits << 8)};
}

}  // namespace

std::array<float, 3> stored_light(const Spectrum& light, const Wavelengths& waves) {
    if (!waves.is_spectral()) {
        return {static_cast<float>(light.a), static_cast<float>(light.b),
                static_cast<float>(light.c)};
    }
    const std::uint32_t d = rounded_float(light.d);
    const std::uint32_t hero = waves.hero_only() ? kHero : 0u;
    return {std::bit_cast<float>(kMark | hero | rounded_float(light.a) << 7 | d >> 16),
            std::bit_cast<float>(rounded_float(light.b) << 9 | (d >> 7 & 0x1ffu)),
            std::bit_cast<float>(rounded_float(light.c) << 9 | (d & 0x7fu))};
}

Spectrum Photon::light_of_waves() const {
    const auto bits = [&](std::size_t i) { return std::bit_cast<std::uint32_t>(power[i]); };
    const std::uint32_t x = bits(0), y = bits(1), z = bits(2);
    const std::uint32_t d = (x & 0x7fu) << 16 | (y & 0x1ffu) << 7 | (z & 0x7fu);
    return {float_of(x >> 7 & 0x7fffffu), float_of(y >> 9), float_of(z >> 9), float_of(d)};
}

}  // namespace alhazen

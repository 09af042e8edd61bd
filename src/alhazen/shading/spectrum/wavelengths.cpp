#include "alhazen/shading/spectrum/wavelengths.h"

#include <algorithm>

#include "alhazen/shading/spectrum/color_lift.h"
#include "alhazen/shading/spectrum/color_matching.h"
#include "alhazen/shading/spectrum/illuminant_spectrum.h"

namespace alhazen {

namespace {

bool is_grey(const Rgb& c) {
    return c.r == c.g && c.g == c.b;
}

Spectrum at_places(const SmoothReflectance& r, const Spectrum& places) {
    return {r.at(places.a), r.at(places.b), r.at(places.c), r.at(places.d)};
}

template <class F>
Spectrum at_each(const Spectrum& nm, F&& f) {
    return {f(nm.a), f(nm.b), f(nm.c), f(nm.d)};
}

}  // namespace

Wavelengths::Wavelengths(const DrawnWaves& four)
    : spectral_(true),
      nm_(four.nm),
      places_(at_each(four.nm, [](double nm) { return SmoothReflectance::place(nm); })),
      white_(four.white),
      seen_(four.color) {}

Wavelengths Wavelengths::drawn(double u) {
    return Wavelengths(draw_waves(u));
}

Wavelengths Wavelengths::single(double nm) {
    DrawnWaves four{Spectrum::all(nm), Spectrum::all(white_light(nm)), {}};
    four.color.fill(response(nm));
    return Wavelengths(four);
}

Spectrum Wavelengths::lifted_reflectance(const Rgb& c) const {
    if (is_grey(c)) return Spectrum::all(c.r);
    if (c.max() > 1.0) return lifted_of_any_size(c);
    return at_places(lifted(c), places_);
}

Spectrum Wavelengths::lifted_of_any_size(const Rgb& c) const {
    if (is_grey(c)) return Spectrum::all(c.r);
    const double most = c.max();
    if (!(most > 0.0) || !c.is_finite()) return {};
    // Half of the range of a reflectance: spectra are smoother than near 1.
    const double scale = 2.0 * most;
    return scale * at_places(lifted_half((1.0 / scale) * c), places_);
}

Spectrum Wavelengths::spectrum_of(const Illuminant& illuminant, const Rgb& color) const {
    const Illuminant scaled{illuminant.kind, illuminant.kelvin, luminance_of(color)};
    return at_each(nm_, [&](double nm) { return radiance_of(scaled, nm); });
}

Spectrum Wavelengths::between_channels(const Rgb& value) const {
    // Dominant wavelengths of the primaries of sRGB (metals.h).
    constexpr double kRed = 611.4, kGreen = 549.1, kBlue = 464.3;
    return at_each(nm_, [&](double nm) {
        const bool upper = nm > kGreen;
        const double from = upper ? kGreen : kBlue, to = upper ? kRed : kGreen;
        const double share = std::clamp((nm - from) / (to - from), 0.0, 1.0);
        return upper ? value.g + share * (value.r - value.g)
                     : value.b + share * (value.g - value.b);
    });
}

Spectrum Wavelengths::index(double index_d, const Dispersion& dispersion) const {
    if (!spectral_) return Spectrum::all(index_d);
    if (hero_only_) return Spectrum::all(dispersion.index(index_d, nm_.a));
    return at_each(nm_, [&](double nm) { return dispersion.index(index_d, nm); });
}

Rgb Wavelengths::seen(const Spectrum& light) const {
    Rgb sum;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        sum += light[i] * seen_[static_cast<std::size_t>(i)];
    }
    return (1.0 / Spectrum::kCount) * sum;
}

}  // namespace alhazen

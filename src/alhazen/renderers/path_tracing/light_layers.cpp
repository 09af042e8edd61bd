#include "alhazen/renderers/path_tracing/light_layers.h"

#include <algorithm>
#include <cmath>

#include "alhazen/shading/spectrum/color_matching.h"

namespace alhazen {

namespace {

constexpr std::array kKinds{AovKind::Emission,     AovKind::Direct,   AovKind::Indirect,
                            AovKind::Diffuse,      AovKind::Specular, AovKind::Transmission,
                            AovKind::LightVariance};
constexpr std::array kPolarization{AovKind::PolarizationDegree, AovKind::PolarizationAngle,
                                   AovKind::Stokes};

/// The part of the light for a layer other than the variance.
Spectrum part_of(AovKind kind, const LightParts& parts) {
    switch (kind) {
        case AovKind::Emission:
            return parts.emission;
        case AovKind::Direct:
            return parts.direct.sum();
        case AovKind::Indirect:
            return parts.indirect.sum();
        case AovKind::Diffuse:
            return parts.direct.diffuse + parts.indirect.diffuse;
        case AovKind::Specular:
            return parts.direct.specular + parts.indirect.specular;
        default:
            return parts.direct.transmitted + parts.indirect.transmitted;
    }
}

/// The variance of the mean.
Rgb variance(const SampleSum& sum) {
    if (sum.count < 2) return {};
    const double n = sum.count;
    const Rgb spread = sum.squares - (1.0 / n) * (sum.plain * sum.plain);
    const auto of = [&](double s) { return std::max(0.0, s) / (n * (n - 1.0)); };
    return {of(spread.r), of(spread.g), of(spread.b)};
}

}  // namespace

bool LightLayers::has_any(const AovSet& wanted) {
    const auto is_wanted = [&](AovKind k) { return wanted.has(k); };
    return std::ranges::any_of(kKinds, is_wanted) || std::ranges::any_of(kPolarization, is_wanted);
}

LightLayers::LightLayers(const PixelBox& crop, const AovSet& wanted, double mean_sign)
    : crop_(crop), mean_sign_(mean_sign), counts_(crop.area()) {
    signs_.resize(mean_sign == 1.0 ? 0 : crop.area());
    for (const AovKind kind : kKinds) {
        if (wanted.has(kind)) layers_.push_back(layer_of(kind));
    }
    if (std::ranges::any_of(kPolarization, [&](AovKind k) { return wanted.has(k); })) {
        intensity_ = layer_of(AovKind::Stokes);
        stokes_ = layer_of(AovKind::Stokes);
    }
}

LightLayers::Layer LightLayers::layer_of(AovKind kind) const {
    Layer layer{kind, std::vector<Rgb>(crop_.area()), {}, {}};
    if (kind == AovKind::LightVariance) {
        layer.squares.resize(crop_.area());
    } else {
        layer.with_signs.resize(signs_.size());
    }
    return layer;
}

void LightLayers::add(Layer& layer, std::size_t pixel, const Rgb& light, double sign) {
    layer.plain[pixel] += light;
    if (!layer.with_signs.empty()) layer.with_signs[pixel] += sign * light;
    if (!layer.squares.empty()) layer.squares[pixel] += light * light;
}

void LightLayers::add(const SampleId& id, const LightParts& parts, const Wavelengths& waves,
                      const Rgb& radiance) {
    if (!radiance.is_finite()) return;
    const std::size_t pixel = std::size_t(id.pixel.y - crop_.y0) * std::size_t(crop_.width()) +
                              std::size_t(id.pixel.x - crop_.x0);
    ++counts_[pixel];
    if (!signs_.empty()) signs_[pixel] += id.sign;
    for (Layer& layer : layers_) {
        const Rgb light = layer.kind == AovKind::LightVariance
                              ? radiance
                              : waves.color(part_of(layer.kind, parts));
        add(layer, pixel, light, id.sign);
    }
    if (!stokes_) return;
    const StokesLight& s = parts.polarized;
    add(*intensity_, pixel, {luminance_of(radiance), 0, 0}, id.sign);
    add(*stokes_, pixel,
        {luminance_of(waves.color(s.q)), luminance_of(waves.color(s.u)),
         luminance_of(waves.color(s.v))},
        id.sign);
}

SampleSum LightLayers::sum_of(const Layer& layer, std::size_t pixel) const {
    SampleSum sum;
    sum.plain = layer.plain[pixel];
    sum.count = counts_[pixel];
    if (!layer.with_signs.empty()) {
        sum.with_signs = layer.with_signs[pixel];
        sum.signs = signs_[pixel];
    }
    if (!layer.squares.empty()) sum.squares = layer.squares[pixel];
    return sum;
}

void LightLayers::write_polarization(AovFilm& film, int x, int y, std::size_t pixel) const {
    const double light = sum_of(*intensity_, pixel).value(mean_sign_).r;
    const Rgb s = sum_of(*stokes_, pixel).value(mean_sign_);
    const double q = s.r, u = s.g, v = s.b;
    // Rounding and negative lobes of the filter may give a degree above 1.
    const double degree =
        light > 0.0 ? std::min(1.0, std::sqrt(q * q + u * u + v * v) / light) : 0.0;
    film.set(AovKind::PolarizationDegree, x, y, std::array{degree});
    film.set(AovKind::PolarizationAngle, x, y, std::array{0.5 * std::atan2(u, q)});
    film.set(AovKind::Stokes, x, y, std::array{q, u, v});
}

void LightLayers::write(AovFilm& film) const {
    for (std::size_t pixel = 0; stokes_ && pixel < crop_.area(); ++pixel) {
        const auto width = std::size_t(crop_.width());
        write_polarization(film, crop_.x0 + int(pixel % width), crop_.y0 + int(pixel / width),
                           pixel);
    }
    for (const Layer& layer : layers_) {
        std::size_t pixel = 0;
        for (int y = crop_.y0; y < crop_.y1; ++y) {
            for (int x = crop_.x0; x < crop_.x1; ++x) {
                const SampleSum sum = sum_of(layer, pixel++);
                const bool is_variance = layer.kind == AovKind::LightVariance;
                const Rgb c = is_variance ? variance(sum) : sum.value(mean_sign_);
                film.set(layer.kind, x, y, std::array{c.r, c.g, c.b});
            }
        }
    }
}

}  // namespace alhazen

#include "alhazen/renderers/light_transport/light_layers.h"

#include <algorithm>

namespace alhazen {

namespace {

constexpr std::array kKinds{AovKind::Emission,     AovKind::Direct,   AovKind::Indirect,
                            AovKind::Diffuse,      AovKind::Specular, AovKind::Transmission,
                            AovKind::LightVariance};

/// Of the layers but the variance.
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

/// Of the mean.
Rgb variance(const SampleSum& sum) {
    if (sum.count < 2) return {};
    const double n = sum.count;
    const Rgb spread = sum.squares - (1.0 / n) * (sum.plain * sum.plain);
    const auto of = [&](double s) { return std::max(0.0, s) / (n * (n - 1.0)); };
    return {of(spread.r), of(spread.g), of(spread.b)};
}

}  // namespace

bool LightLayers::has_any(const AovSet& wanted) {
    return std::any_of(kKinds.begin(), kKinds.end(), [&](AovKind k) { return wanted.has(k); });
}

LightLayers::LightLayers(const PixelBox& crop, const AovSet& wanted, double mean_sign)
    : crop_(crop), mean_sign_(mean_sign), counts_(crop.area()) {
    const std::size_t signed_pixels = mean_sign == 1.0 ? 0 : crop.area();
    signs_.resize(signed_pixels);
    for (const AovKind kind : kKinds) {
        if (!wanted.has(kind)) continue;
        Layer& layer = layers_.emplace_back();
        layer.kind = kind;
        layer.plain.resize(crop.area());
        if (kind == AovKind::LightVariance) {
            layer.squares.resize(crop.area());
        } else {
            layer.with_signs.resize(signed_pixels);
        }
    }
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
        layer.plain[pixel] += light;
        if (!layer.with_signs.empty()) layer.with_signs[pixel] += id.sign * light;
        if (!layer.squares.empty()) layer.squares[pixel] += light * light;
    }
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

void LightLayers::write(AovFilm& film) const {
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

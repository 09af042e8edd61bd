#include "alhazen/shading/textures/texture.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

/// Index of the texel that stands at `i` after wrapping; `n` > 0.
int wrapped(long long i, int n, Wrap wrap) {
    if (i >= 0 && i < n) return static_cast<int>(i);
    switch (wrap) {
        case Wrap::Clamp:
            return static_cast<int>(std::clamp<long long>(i, 0, n - 1));
        case Wrap::Mirror: {
            const long long period = 2LL * n;
            const long long m = ((i % period) + period) % period;
            return static_cast<int>(m < n ? m : period - 1 - m);
        }
        case Wrap::Repeat:
            break;
    }
    return static_cast<int>(((i % n) + n) % n);
}

/// A texel of level 0; the position is inside.
Rgba texel(const ImageTexture& texture, int x, int y) {
    const StoredImage& image = *texture.image;
    return image.pixel(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(x),
                       texture.decode_srgb);
}

/// Clamps coordinates beyond which no fraction is left to interpolate; also keeps NaN and infinity
/// from the integer conversion.
double bounded(double x) {
    return x > -1e9 && x < 1e9 ? x : 0.0;
}

/// Interpolates `texel_at(x, y)` at (x, y) of a grid of `width` x `height` texels, where texel i
/// stands at i.
template <class TexelAt>
Rgba bilinear(const ImageTexture& texture, double x, double y, int width, int height,
              TexelAt&& texel_at) {
    const double x0 = std::floor(x);
    const double y0 = std::floor(y);
    const double fx = x - x0;
    const double fy = y - y0;
    const long long ix = static_cast<long long>(x0);
    const long long iy = static_cast<long long>(y0);
    const int left = wrapped(ix, width, texture.wrap_u);
    const int right = wrapped(ix + 1, width, texture.wrap_u);
    const int above = wrapped(iy, height, texture.wrap_v);
    const int below = wrapped(iy + 1, height, texture.wrap_v);
    const Rgba top = (1 - fx) * texel_at(left, above) + fx * texel_at(right, above);
    const Rgba bottom = (1 - fx) * texel_at(left, below) + fx * texel_at(right, below);
    return (1 - fy) * top + fy * bottom;
}

/// The texel of level 0 nearest to (x, y), with texel i at i.
Rgba nearest(const ImageTexture& texture, double x, double y) {
    const auto at = [](double place, int n, Wrap wrap) {
        return wrapped(static_cast<long long>(std::floor(place + 0.5)), n, wrap);
    };
    return texel(texture, at(x, texture.image->width, texture.wrap_u),
                 at(y, texture.image->height, texture.wrap_v));
}

/// Interpolates at (x, y), in texels of level 0 with texel i at i, between the two nearest levels.
Rgba trilinear(const ImageTexture& texture, double x, double y, double level) {
    const MipPyramid& pyramid = *texture.pyramid;
    const auto at_level = [&](int l) {
        const int width = pyramid.width(l);
        const int height = pyramid.height(l);
        const double lx = (x + 0.5) * width / pyramid.width(0) - 0.5;
        const double ly = (y + 0.5) * height / pyramid.height(0) - 0.5;
        return bilinear(texture, lx, ly, width, height,
                        [&](int i, int j) { return pyramid.texel(l, i, j); });
    };
    const int last = pyramid.levels() - 1;
    if (!(level > 0.0)) {
        return texture.filter == TextureFilter::NearestMipmapped ? nearest(texture, x, y)
                                                                 : at_level(0);
    }
    if (level >= last) return at_level(last);
    const int finer = static_cast<int>(level);
    const double f = level - finer;
    return (1 - f) * at_level(finer) + f * at_level(finer + 1);
}

/// The diameters of an ellipse in texels: its long axis and the length of the short one.
struct Axes {
    double major_x = 0, major_y = 0;
    double major = 0, minor = 0;
};

/// The axes of the ellipse that has `a` and `b` as conjugate diameters.
Axes axes_of(const Vec2& a, const Vec2& b) {
    // p(s) = a cos s + b sin s has its extreme length where its derivative is perpendicular to it.
    const double aa = a.x * a.x + a.y * a.y;
    const double bb = b.x * b.x + b.y * b.y;
    const double ab = a.x * b.x + a.y * b.y;
    const double s = 0.5 * std::atan2(2.0 * ab, aa - bb);
    const double c = std::cos(s), d = std::sin(s);
    Axes axes;
    axes.major_x = c * a.x + d * b.x;
    axes.major_y = c * a.y + d * b.y;
    axes.major = std::hypot(axes.major_x, axes.major_y);
    axes.minor = std::hypot(c * b.x - d * a.x, c * b.y - d * a.y);
    return axes;
}

constexpr int kMaxProbes = 16;

/// The mean over the footprint around (x, y), in texels of level 0.
Rgba filtered(const ImageTexture& texture, double x, double y, const UvFootprint& footprint) {
    const double sx = texture.image->width, sy = texture.image->height;
    Axes axes = axes_of({footprint.a.x * sx, -footprint.a.y * sy},
                        {footprint.b.x * sx, -footprint.b.y * sy});
    if (!(axes.major < 1e9)) axes = {0, 0, 1e9, 1e9};
    const double minor = std::max({axes.minor, axes.major / kMaxProbes, 1.0});
    const double level = std::log2(minor);
    const int probes = std::clamp(static_cast<int>(std::ceil(axes.major / minor)), 1, kMaxProbes);
    // The smallest copy is one texel, the same for every probe.
    if (level >= texture.pyramid->levels() - 1)
        return texture.pyramid->texel(texture.pyramid->levels() - 1, 0, 0);
    if (probes == 1) return trilinear(texture, x, y, level);
    Rgba sum{0, 0, 0, 0};
    for (int i = 0; i < probes; ++i) {
        const double along = (i + 0.5) / probes - 0.5;
        sum += trilinear(texture, x + along * axes.major_x, y + along * axes.major_y, level);
    }
    return (1.0 / probes) * sum;
}

}  // namespace

Rgba evaluate(const ImageTexture& texture, const Vec2& uv, const UvFootprint& footprint) {
    const StoredImage& image = *texture.image;
    const double u = bounded(uv.x);
    const double v = 1.0 - bounded(uv.y);  // rows run downward
    const double corner = texture.corner_texels ? 0.0 : 0.5;
    const double x = u * image.width - corner;
    const double y = v * image.height - corner;
    if (texture.filter == TextureFilter::Nearest) return nearest(texture, x, y);
    if (has_pyramid(texture.filter) && texture.pyramid) {
        return filtered(texture, x, y, footprint);
    }
    return bilinear(texture, x, y, image.width, image.height,
                    [&](int i, int j) { return texel(texture, i, j); });
}

}  // namespace alhazen

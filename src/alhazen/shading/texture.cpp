#include "alhazen/shading/texture.h"

#include <cmath>

#include "alhazen/imaging/encoding.h"

namespace alhazen {

namespace {

/// Index of the texel that stands at `i` after wrapping; `n` > 0.
int wrapped(long long i, int n, Wrap wrap) {
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

Rgb texel(const Texture& texture, long long x, long long y) {
    const Image& image = *texture.image;
    Rgb c = image.rgb(wrapped(x, image.width, texture.wrap_u),
                      wrapped(y, image.height, texture.wrap_v));
    if (texture.decode_srgb)
        c = {linear_from_srgb(c.r), linear_from_srgb(c.g), linear_from_srgb(c.b)};
    return c;
}

/// Coordinates beyond this many repeats carry no fraction worth interpolating; also keeps NaN and
/// infinity away from the integer conversion.
double bounded(double x) {
    return x > -1e9 && x < 1e9 ? x : 0.0;
}

}  // namespace

Rgb evaluate(const Texture& texture, const Vec2& uv) {
    const Image& image = *texture.image;
    const double u = bounded(uv.x);
    const double v = 1.0 - bounded(uv.y);  // rows run downward
    double x, y;
    if (texture.corner_texels) {
        x = u * (image.width - 1);
        y = v * (image.height - 1);
    } else {
        x = u * image.width - 0.5;
        y = v * image.height - 0.5;
    }
    if (texture.filter == TextureFilter::Nearest) {
        return texel(texture, static_cast<long long>(std::floor(x + 0.5)),
                     static_cast<long long>(std::floor(y + 0.5)));
    }
    const double x0 = std::floor(x);
    const double y0 = std::floor(y);
    const double fx = x - x0;
    const double fy = y - y0;
    const long long ix = static_cast<long long>(x0);
    const long long iy = static_cast<long long>(y0);
    const Rgb top = (1 - fx) * texel(texture, ix, iy) + fx * texel(texture, ix + 1, iy);
    const Rgb bottom = (1 - fx) * texel(texture, ix, iy + 1) + fx * texel(texture, ix + 1, iy + 1);
    return (1 - fy) * top + fy * bottom;
}

}  // namespace alhazen

#include "alhazen/imaging/figures/false_color.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "alhazen/imaging/figures/heat_map.h"
#include "alhazen/imaging/figures/tiny_font.h"

namespace alhazen {

namespace {

constexpr int kMinWidth = 220;
constexpr int kMargin = 4, kBarHeight = 8, kGap = 3;
constexpr int kStripHeight =
    kMargin + kGlyphHeight + kGap + kBarHeight + kGap + kGlyphHeight + kMargin;
/// Image width at which letters double their size; they triple it at twice the width, and so on.
constexpr int kWidthPerScale = 900;

Rgb color_of(const ColorScale& scale, double value) {
    if (!std::isfinite(value)) return {};
    const double range = scale.high - scale.low;
    const double t = range > 0.0 ? (value - scale.low) / range : 0.0;
    return scale_color(scale.colors, t);
}

class Canvas {
  public:
    Canvas(int width, int height) {
        image_.width = width;
        image_.height = height;
        image_.samples.resize(3 * static_cast<std::size_t>(width) *
                              static_cast<std::size_t>(height));
    }

    void set(int x, int y, const Rgb& display) {
        if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
        const std::size_t at =
            3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                 static_cast<std::size_t>(x));
        for (int c = 0; c < 3; ++c) {
            image_.samples[at + static_cast<std::size_t>(c)] =
                static_cast<std::uint16_t>(std::lround(255.0 * std::clamp(display[c], 0.0, 1.0)));
        }
    }

    void text(int x, int y, int size, const std::string& letters) {
        for (std::size_t i = 0; i < letters.size(); ++i) {
            const int left = x + size * kGlyphAdvance * static_cast<int>(i);
            for (int v = 0; v < size * kGlyphHeight; ++v) {
                for (int u = 0; u < size * kGlyphWidth; ++u) {
                    if (glyph_pixel(letters[i], u / size, v / size)) {
                        set(left + u, y + v, {0.9, 0.9, 0.9});
                    }
                }
            }
        }
    }

    [[nodiscard]] EncodedImage take() { return std::move(image_); }

  private:
    EncodedImage image_;
};

/// Draws the title, the bar, and the numbers at its ends and middle.
void draw_scale(Canvas& canvas, int top, int width, int size, const ColorScale& scale) {
    const auto span = [&](const std::string& text) { return size * text_width(text); };
    const int left = size * kMargin;
    const int right = width - size * kMargin;
    const int title_y = top + size * kMargin;
    const int bar_y = title_y + size * (kGlyphHeight + kGap);
    const int number_y = bar_y + size * (kBarHeight + kGap);
    canvas.text((width - span(scale.title)) / 2, title_y, size, scale.title);
    for (int x = left; x < right; ++x) {
        const double t = (x - left + 0.5) / (right - left);
        const Rgb color = color_of(scale, scale.low + t * (scale.high - scale.low));
        for (int y = 0; y < size * kBarHeight; ++y) canvas.set(x, bar_y + y, color);
    }
    const auto number = [](double value) { return fmt::format("{:.4g}", value); };
    const std::string low = number(scale.low);
    const std::string middle = number(0.5 * (scale.low + scale.high));
    const std::string high = number(scale.high);
    canvas.text(left, number_y, size, low);
    canvas.text((width - span(middle)) / 2, number_y, size, middle);
    canvas.text(right - span(high), number_y, size, high);
}

}  // namespace

Rgb scale_color(ColorScale::Colors colors, double t) {
    if (colors == ColorScale::Colors::Heat) return heat_color(t);
    const double grey = 1.0 - 0.85 * std::clamp(t, 0.0, 1.0);
    return {grey, grey, grey};
}

EncodedImage false_color(std::span<const float> values, int width, int height,
                         const ColorScale& scale) {
    const int size = 1 + width / kWidthPerScale;
    const int full_width = scale.drawn ? std::max(width, kMinWidth) : width;
    Canvas canvas(full_width, scale.drawn ? height + size * kStripHeight : height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                   static_cast<std::size_t>(x);
            canvas.set(x, y, color_of(scale, static_cast<double>(values[at])));
        }
    }
    if (scale.drawn) draw_scale(canvas, height, full_width, size, scale);
    return canvas.take();
}

std::array<std::uint16_t, 3> id_color(std::uint32_t id) {
    if (id == 0) return {0, 0, 0};
    // Multiples of the golden ratio spread any number of hues evenly.
    const double hue = 6.0 * std::fmod(id * 0.6180339887498949, 1.0);
    const double value = 1.0 - 0.22 * (id / 3 % 3);
    const double saturation = 0.85 - 0.2 * (id / 2 % 3);
    std::array<std::uint16_t, 3> codes{};
    for (int c = 0; c < 3; ++c) {
        const double distance = std::abs(std::fmod(hue + 6.0 - 2.0 * c + 3.0, 6.0) - 3.0);
        const double pure = std::clamp(2.0 - distance, 0.0, 1.0);
        codes[static_cast<std::size_t>(c)] = static_cast<std::uint16_t>(
            std::lround(255.0 * value * (1.0 - saturation * (1.0 - pure))));
    }
    return codes;
}

}  // namespace alhazen

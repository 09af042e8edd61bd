#include "alhazen/shading/mip_pyramid.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

/// The part of a row of `from` texels that one of `to` texels stands for: the first texel, and the
/// weight of each, which sum to 1.
struct Span {
    int first = 0;
    std::vector<double> weights;
};

std::vector<Span> spans(int from, int to) {
    std::vector<Span> result(static_cast<std::size_t>(to));
    const double step = static_cast<double>(from) / to;
    for (int i = 0; i < to; ++i) {
        const double begin = i * step;
        const double end = std::min<double>(from, (i + 1) * step);
        Span& span = result[static_cast<std::size_t>(i)];
        span.first = static_cast<int>(begin);
        for (int k = span.first; k < from && k < end; ++k) {
            const double covered = std::min<double>(end, k + 1) - std::max<double>(begin, k);
            span.weights.push_back(covered / (end - begin));
        }
    }
    return result;
}

void append(const Rgba& c, int channels, std::vector<float>& samples) {
    const double values[] = {c.r, c.g, c.b, c.a};
    if (channels < 3) {
        samples.push_back(static_cast<float>(c.r));
        if (channels == 2) samples.push_back(static_cast<float>(c.a));
        return;
    }
    for (int i = 0; i < channels; ++i) samples.push_back(static_cast<float>(values[i]));
}

void append(const Rgba& c, int channels, std::vector<std::uint16_t>& samples) {
    const auto code = [](double v) { return static_cast<std::uint16_t>(std::lround(65535.0 * v)); };
    const double values[] = {c.r, c.g, c.b, c.a};
    if (channels < 3) {
        samples.push_back(code(c.r));
        if (channels == 2) samples.push_back(code(c.a));
        return;
    }
    for (int i = 0; i < channels; ++i) samples.push_back(code(values[i]));
}

template <class Sample>
StoredImage halved(const StoredImage& from, bool decode_srgb) {
    StoredImage to{
        std::max(1, from.width / 2), std::max(1, from.height / 2), from.channels, true, {}};
    const std::vector<Span> columns = spans(from.width, to.width);
    const std::vector<Span> rows = spans(from.height, to.height);
    std::vector<Sample> samples;
    samples.reserve(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height) *
                    static_cast<std::size_t>(to.channels));
    std::vector<Rgba> sums(static_cast<std::size_t>(from.width));
    for (const Span& row : rows) {
        std::fill(sums.begin(), sums.end(), Rgba{0, 0, 0, 0});
        for (std::size_t k = 0; k < row.weights.size(); ++k) {
            const std::size_t begin =
                (static_cast<std::size_t>(row.first) + k) * static_cast<std::size_t>(from.width);
            for (std::size_t x = 0; x < sums.size(); ++x) {
                sums[x] += row.weights[k] * from.pixel(begin + x, decode_srgb);
            }
        }
        for (const Span& column : columns) {
            Rgba mean{0, 0, 0, 0};
            for (std::size_t k = 0; k < column.weights.size(); ++k) {
                mean += column.weights[k] * sums[static_cast<std::size_t>(column.first) + k];
            }
            append(mean, to.channels, samples);
        }
    }
    to.samples = std::move(samples);
    return to;
}

}  // namespace

MipPyramid::MipPyramid(std::shared_ptr<const StoredImage> image, bool decode_srgb)
    : image_(std::move(image)), decode_srgb_(decode_srgb) {
    const bool floats = std::holds_alternative<std::vector<float>>(image_->samples);
    while (at(levels() - 1).width > 1 || at(levels() - 1).height > 1) {
        const bool decode = decode_srgb_ && smaller_.empty();
        const StoredImage& last = at(levels() - 1);
        smaller_.push_back(floats ? halved<float>(last, decode)
                                  : halved<std::uint16_t>(last, decode));
    }
}

Rgba MipPyramid::texel(int level, int x, int y) const {
    const StoredImage& image = at(level);
    return image.pixel(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(x),
                       decode_srgb_ && level == 0);
}

std::size_t MipPyramid::memory_bytes() const {
    std::size_t total = 0;
    for (const StoredImage& image : smaller_) total += image.memory_bytes();
    return total;
}

}  // namespace alhazen

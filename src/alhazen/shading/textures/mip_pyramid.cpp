#include "alhazen/shading/textures/mip_pyramid.h"

#include <algorithm>

namespace alhazen {

namespace {

/// The part of a row of `from` texels that one of `to` texels covers: the first texel, and the
/// weight of each; the weights sum to 1.
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

void store(double value, float& sample) {
    sample = static_cast<float>(value);
}
/// The nearest code, rounded as by lround; `value` is not negative.
void store(double value, std::uint16_t& sample) {
    const double code = 65535.0 * value;
    const auto below = static_cast<std::uint32_t>(code);
    sample = static_cast<std::uint16_t>(below + (code - below >= 0.5 ? 1 : 0));
}

template <class Sample>
StoredImage halved(const StoredImage& from, bool decode_srgb) {
    StoredImage to{
        std::max(1, from.width / 2), std::max(1, from.height / 2), from.channels, true, {}};
    const std::vector<Span> columns = spans(from.width, to.width);
    const std::vector<Span> rows = spans(from.height, to.height);
    const auto channels = static_cast<std::size_t>(from.channels);
    const auto width = static_cast<std::size_t>(from.width);
    std::vector<Sample> samples(static_cast<std::size_t>(to.width) *
                                static_cast<std::size_t>(to.height) * channels);
    std::vector<double> row(width * channels), sums(row.size());
    Sample* out = samples.data();
    for (const Span& span : rows) {
        std::fill(sums.begin(), sums.end(), 0.0);
        for (std::size_t k = 0; k < span.weights.size(); ++k) {
            const std::size_t begin = (static_cast<std::size_t>(span.first) + k) * width;
            from.read_pixels(begin, width, decode_srgb, row.data());
            for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += span.weights[k] * row[i];
        }
        for (const Span& column : columns) {
            const double* first = sums.data() + static_cast<std::size_t>(column.first) * channels;
            for (std::size_t i = 0; i < channels; ++i) {
                double mean = 0.0;
                for (std::size_t k = 0; k < column.weights.size(); ++k) {
                    mean += column.weights[k] * first[k * channels + i];
                }
                store(mean, *out++);
            }
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

std::uint64_t MipPyramid::memory_bytes_for(const StoredImage& image) {
    const bool floats = std::holds_alternative<std::vector<float>>(image.samples);
    const auto texel_bytes = std::uint64_t(image.channels) * (floats ? 4 : 2);
    std::uint64_t texels = 0;
    for (int w = image.width, h = image.height; w > 1 || h > 1;) {
        w = std::max(1, w / 2);
        h = std::max(1, h / 2);
        texels += std::uint64_t(w) * std::uint64_t(h);
    }
    return texels * texel_bytes;
}

std::size_t MipPyramid::memory_bytes() const {
    std::size_t total = 0;
    for (const StoredImage& image : smaller_) total += image.memory_bytes();
    return total;
}

}  // namespace alhazen

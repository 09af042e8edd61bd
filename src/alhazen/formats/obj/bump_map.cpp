#include "alhazen/formats/obj/bump_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "alhazen/shading/materials/texture_inputs.h"

namespace alhazen {

namespace {

/// Limit of slopes: near vertical, and products of two limits stay finite.
constexpr double kMaxSlope = 1e6;

bool is_direction(const Rgba& texel) {
    if (!(texel.b >= texel.r && texel.b >= texel.g)) return false;
    if (!(texel.b - std::min(texel.r, texel.g) >= 0.1)) return false;
    const Vec3 v{2.0 * texel.r - 1.0, 2.0 * texel.g - 1.0, 2.0 * texel.b - 1.0};
    return std::abs(length(v) - 1.0) <= 0.2;
}

/// The index of a neighbour; `i` may exceed either end by one.
int neighbour(int i, int count, Wrap wrap) {
    if (wrap == Wrap::Clamp) return std::clamp(i, 0, count - 1);
    return (i + count) % count;
}

std::vector<double> row_of(const StoredImage& picture, int y, Channel channel) {
    std::vector<double> row(std::size_t(picture.width));
    const std::size_t first = std::size_t(y) * row.size();
    for (std::size_t x = 0; x < row.size(); ++x) {
        const double height = channel_of(picture.pixel(first + x, false), channel);
        row[x] = std::isfinite(height) ? height : 0.0;
    }
    return row;
}

std::uint8_t normal_code(double component) {
    return static_cast<std::uint8_t>(std::lround(127.5 * (component + 1.0)));
}

}  // namespace

bool looks_like_normal_map(const StoredImage& picture) {
    if (picture.channels < 3) return false;
    const std::size_t count = std::size_t(picture.width) * std::size_t(picture.height);
    std::size_t directions = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (is_direction(picture.pixel(i, false))) ++directions;
    }
    return count > 0 && directions >= count - count / 4;
}

StoredImage normals_from_heights(const StoredImage& heights, const HeightMap& map) {
    const int width = heights.width, height = heights.height;
    const double side = std::sqrt(double(width) * double(height));
    // Central difference over two texels.
    const double scale =
        std::clamp(map.strength * (side / kHeightsPerSide) / 2.0, -kMaxSlope, kMaxSlope);
    const auto slope = [&](double from, double to) {
        return std::clamp(scale * (to - from), -kMaxSlope, kMaxSlope);
    };
    std::vector<std::uint8_t> codes;
    codes.reserve(std::size_t(width) * std::size_t(height) * 3);
    const auto row = [&](int y) {
        return row_of(heights, neighbour(y, height, map.wrap), map.channel);
    };
    if (width > 0 && height > 0) {
        std::vector<double> above = row(-1), here = row(0);
        for (int y = 0; y < height; ++y) {
            std::vector<double> below = row(y + 1);
            for (int x = 0; x < width; ++x) {
                const auto left = std::size_t(neighbour(x - 1, width, map.wrap));
                const auto right = std::size_t(neighbour(x + 1, width, map.wrap));
                // Rows run downwards, v upwards.
                const Vec3 n =
                    normalize(Vec3{-slope(here[left], here[right]),
                                   -slope(below[std::size_t(x)], above[std::size_t(x)]), 1.0});
                codes.insert(codes.end(), {normal_code(n.x), normal_code(n.y), normal_code(n.z)});
            }
            above = std::move(here);
            here = std::move(below);
        }
    }
    return {width, height, 3, false, std::move(codes)};
}

}  // namespace alhazen

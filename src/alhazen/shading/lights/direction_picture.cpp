#include "alhazen/shading/lights/direction_picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "alhazen/imaging/image/encoding.h"
#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

double mean_of(const Rgb& c) {
    return (c.r + c.g + c.b) / 3.0;
}

/// The longitude as a share of the picture's width.
double column_of(const Vec3& direction) {
    return 0.5 + std::atan2(direction.x, direction.y) / (2.0 * kPi);
}

double row_of(const Vec3& direction) {
    return std::atan2(std::hypot(direction.x, direction.y), direction.z) / kPi;
}

int index_below(double share, int count) {
    return std::clamp(static_cast<int>(share * count), 0, count - 1);
}

}  // namespace

DirectionPicture::DirectionPicture(Image picture) : picture_(std::move(picture)) {
    if (!picture_.linear) {
        const int colors = picture_.channels < 3 ? 1 : 3;
        for (std::size_t i = 0; i < picture_.samples.size(); ++i) {
            if (static_cast<int>(i % std::size_t(picture_.channels)) >= colors) continue;
            picture_.samples[i] = static_cast<float>(linear_from_srgb(picture_.samples[i]));
        }
        picture_.linear = true;
    }
    blacken_bad_texels();
    make_distribution();
}

void DirectionPicture::blacken_bad_texels() {
    const auto good = [](double v) { return v >= 0.0 && v <= kLargestRadiance; };
    for (int y = 0; y < picture_.height; ++y) {
        for (int x = 0; x < picture_.width; ++x) {
            const Rgb c = picture_.rgb(x, y);
            if (good(c.r) && good(c.g) && good(c.b)) continue;
            ++bad_texels_;
            std::fill_n(picture_.pixel(x, y), picture_.channels, 0.0f);
        }
    }
}

Rgb DirectionPicture::texel(int x, int y) const {
    const int w = picture_.width;
    const int around = x < 0 ? x + w : x < w ? x : x - w;
    // A direction that is no number asks anywhere.
    return picture_.rgb(std::clamp(around, 0, w - 1), std::clamp(y, 0, picture_.height - 1));
}

void DirectionPicture::make_distribution() {
    const int w = picture_.width, h = picture_.height;
    for (int border = 0; border <= h; ++border) {
        heights_.push_back(std::cos(kPi * border / h));
    }
    rows_.assign(1, 0.0);
    columns_.reserve(std::size_t(h) * std::size_t(w + 1));
    std::vector<Rgb> row(std::size_t(w) + 2);
    std::vector<double> sums(std::size_t(w) + 1, 0.0);
    for (int y = 0; y < h; ++y) {
        // Means of the interpolated picture over texels: 1/8, 3/4, 1/8 of the three nearest.
        for (int x = -1; x <= w; ++x) {
            row[std::size_t(x + 1)] =
                0.125 * texel(x, y - 1) + 0.75 * texel(x, y) + 0.125 * texel(x, y + 1);
        }
        Rgb row_sum;
        for (std::size_t x = 0; x < std::size_t(w); ++x) {
            const Rgb mean = 0.125 * row[x] + 0.75 * row[x + 1] + 0.125 * row[x + 2];
            row_sum += mean;
            sums[x + 1] = sums[x] + mean_of(mean);
        }
        const double solid = 2.0 * kPi / w * (height(y) - height(y + 1));
        mean_ += solid / (4.0 * kPi) * row_sum;
        rows_.push_back(rows_.back() + solid * sums.back());
        const double scale = sums.back() > 0.0 ? 1.0 / sums.back() : 0.0;
        for (const double sum : sums) columns_.push_back(static_cast<float>(sum * scale));
    }
}

Rgb DirectionPicture::radiance(const Vec3& direction) const {
    const double x = column_of(direction) * picture_.width - 0.5;
    const double y = row_of(direction) * picture_.height - 0.5;
    const double left = std::floor(x), above = std::floor(y);
    const double fx = x - left, fy = y - above;
    const int i = static_cast<int>(left), j = static_cast<int>(above);
    return (1.0 - fy) * ((1.0 - fx) * texel(i, j) + fx * texel(i + 1, j)) +
           fy * ((1.0 - fx) * texel(i, j + 1) + fx * texel(i + 1, j + 1));
}

Vec3 DirectionPicture::sample(const Vec2& u) const {
    // The last row or column that begins at or before the wanted share, and has one itself.
    const auto pick = [](auto begin, auto end, auto wanted) {
        auto after = std::upper_bound(begin, end, wanted);
        if (after == end) after = std::lower_bound(begin, end, *(end - 1));
        return std::max(after - begin - 1, std::ptrdiff_t{0});
    };
    const double wanted_row = u.y * rows_.back();
    const std::size_t y = std::size_t(pick(rows_.begin(), rows_.end(), wanted_row));
    const std::size_t w = std::size_t(picture_.width);
    const auto first = columns_.begin() + std::ptrdiff_t(y * (w + 1));
    const float wanted = static_cast<float>(u.x);
    const std::size_t x = std::size_t(pick(first, first + std::ptrdiff_t(w + 1), wanted));
    const double share_y =
        std::clamp((wanted_row - rows_[y]) / (rows_[y + 1] - rows_[y]), 0.0, 1.0);
    const double from = first[std::ptrdiff_t(x)], to = first[std::ptrdiff_t(x + 1)];
    const double share_x = std::clamp((u.x - from) / (to - from), 0.0, 1.0);
    const double top = height(static_cast<int>(y)), bottom = height(static_cast<int>(y) + 1);
    const double z = top + share_y * (bottom - top);
    const double angle = 2.0 * kPi * ((static_cast<double>(x) + share_x) / picture_.width - 0.5);
    const double across = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {across * std::sin(angle), across * std::cos(angle), z};
}

double DirectionPicture::density(const Vec3& direction) const {
    const int y = index_below(row_of(direction), picture_.height);
    const int x = index_below(column_of(direction), picture_.width);
    const std::size_t row = std::size_t(y);
    const double share = (rows_[row + 1] - rows_[row]) / rows_.back();
    const std::size_t first = row * std::size_t(picture_.width + 1) + std::size_t(x);
    const double of_row = double(columns_[first + 1]) - double(columns_[first]);
    const double solid = 2.0 * kPi / picture_.width * (height(y) - height(y + 1));
    return share * of_row / solid;
}

}  // namespace alhazen

#include "alhazen/shading/lights/direction_picture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <utility>

#include "alhazen/imaging/image/encoding.h"
#include "alhazen/math/angles.h"
#include "alhazen/math/constants.h"
#include "alhazen/shading/lights/direction_lanes.h"

namespace alhazen {

namespace {

double mean_of(const Rgb& c) {
    return (c.r + c.g + c.b) / 3.0;
}

/// Longitude as a fraction of the picture's width.
double column_of(const Vec3& direction) {
    const double longitude = std::copysign(angle_from_axis(direction.x, direction.y), direction.x);
    return 0.5 + longitude / (2.0 * kPi);
}

double row_of(const Vec3& direction) {
    const double across = std::sqrt(direction.x * direction.x + direction.y * direction.y);
    return angle_from_axis(across, direction.z) / kPi;
}

/// The number of entries up to the first above `wanted`, which lies between `least` and `most`, in
/// an ascending list. Without branches that depend on the entries.
template <class Entries, class Value>
std::size_t first_above(const Entries& entries, std::size_t least, std::size_t most, Value wanted) {
    const auto* const begin = entries.data();
    const auto* found = begin + least;
    for (std::size_t left = most - least; left > 0;) {
        const std::size_t half = (left + 1) / 2;
        // A mask: compilers make a branch of a choice.
        found += half & (std::size_t{0} - std::size_t{found[half - 1] <= wanted});
        left -= half;
    }
    return static_cast<std::size_t>(found - begin);
}

/// Index of the last entry at or below `wanted` whose own share is not 0, in an ascending list. The
/// first entry above `wanted` lies between `least` and `most`.
template <class Entries, class Value>
std::size_t pick(const Entries& entries, std::size_t least, std::size_t most, Value wanted) {
    std::size_t after = first_above(entries, least, most, wanted);
    if (after == entries.size()) {
        after = static_cast<std::size_t>(
            std::lower_bound(entries.begin(), entries.end(), entries.back()) - entries.begin());
    }
    return after > 0 ? after - 1 : 0;
}

/// Index of the part of [0, 1) that contains `share`.
std::size_t part_of(double share, std::size_t parts) {
    return std::min(static_cast<std::size_t>(share * static_cast<double>(parts)), parts - 1);
}

/// Appends for the start of each part of [0, 1), times `scale`, the number of entries not above it;
/// then the number of entries.
template <class Entries>
void append_guide(const Entries& entries, std::size_t parts, double scale,
                  std::vector<std::uint32_t>& guide) {
    for (std::size_t i = 0; i < parts; ++i) {
        const double begin = static_cast<double>(i) / static_cast<double>(parts) * scale;
        const auto after = std::upper_bound(entries.begin(), entries.end(), begin);
        guide.push_back(static_cast<std::uint32_t>(after - entries.begin()));
    }
    guide.push_back(static_cast<std::uint32_t>(entries.size()));
}

/// A NaN is before all.
int index_below(double share, int count) {
    return share > 0.0 ? std::min(static_cast<int>(share * count), count - 1) : 0;
}
/// The index of the texel on the lower side of a place, which is at least -1; a NaN has that of -1.
int lower_texel(double place) {
    return place > -1.0 ? static_cast<int>(place) : -1;
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
    make_guides();
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
        // Means over texels of the interpolated picture: weights 1/8, 3/4, 1/8 of the three
        // nearest.
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

void DirectionPicture::make_guides() {
    // Powers of two make the starts of parts exact.
    row_parts_ = std::bit_floor(std::max(rows_.size() / 4, std::size_t{1}));
    append_guide(rows_, row_parts_, rows_.back(), row_guide_);
    const std::size_t w = std::size_t(picture_.width), h = std::size_t(picture_.height);
    column_parts_ = std::bit_floor(std::max(w / 8, std::size_t{1}));
    column_guides_.reserve(h * (column_parts_ + 1));
    for (std::size_t y = 0; y < h; ++y) {
        append_guide(std::span(columns_).subspan(y * (w + 1), w + 1), column_parts_, 1.0,
                     column_guides_);
    }
}

DirectionPicture::Place DirectionPicture::place_of(const Vec3& direction) {
    return {column_of(direction), row_of(direction)};
}

Rgb DirectionPicture::radiance(const Vec3& direction) const {
    return radiance_at(place_of(direction));
}

double DirectionPicture::density(const Vec3& direction) const {
    return density_at(place_of(direction));
}

DirectionPicture::Sight DirectionPicture::sight(const Vec3& direction) const {
    const Place place = place_of(direction);
    return {radiance_at(place), density_at(place)};
}

// Inlined: it has no effect, and compilers leave out calls of such functions.
[[gnu::always_inline]] inline void DirectionPicture::fetch(const Place& place) const {
    const int y = index_below(place.row, picture_.height);
    const int x = index_below(place.column, picture_.width);
    __builtin_prefetch(
        &columns_[std::size_t(y) * std::size_t(picture_.width + 1) + std::size_t(x)]);
    // The texels to the left of the place.
    const auto at = [](double share, int size) {
        return std::clamp(lower_texel(share * size - 0.5), 0, size - 1);
    };
    const int left = at(place.column, picture_.width), above = at(place.row, picture_.height);
    __builtin_prefetch(picture_.pixel(left, above));
    __builtin_prefetch(picture_.pixel(left, std::min(above + 1, picture_.height - 1)));
}

void DirectionPicture::find_sights(std::span<const Vec3> directions, Sight* sights) const {
    DirectionLanes lanes;
    for (std::size_t done = 0; done < directions.size(); done += DirectionLanes::kMost) {
        const std::size_t count = std::min(DirectionLanes::kMost, directions.size() - done);
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3& direction = directions[done + i];
            lanes.x[i] = direction.x;
            lanes.y[i] = direction.y;
            lanes.z[i] = direction.z;
        }
        lanes.find_places(count);
        for (std::size_t i = 0; i < count; ++i) fetch({lanes.column[i], lanes.row[i]});
        for (std::size_t i = 0; i < count; ++i) {
            const Place place{lanes.column[i], lanes.row[i]};
            sights[done + i] = {radiance_at(place), density_at(place)};
        }
    }
}

Rgb DirectionPicture::radiance_at(const Place& place) const {
    const double x = place.column * picture_.width - 0.5;
    const double y = place.row * picture_.height - 0.5;
    const double left = std::floor(x), above = std::floor(y);
    const double fx = x - left, fy = y - above;
    const int i = lower_texel(left), j = lower_texel(above);
    const bool is_within = i >= 0 && i + 1 < picture_.width && j >= 0 && j + 1 < picture_.height;
    if (is_within && picture_.channels >= 3) {
        const float *p = picture_.pixel(i, j), *q = picture_.pixel(i, j + 1);
        const int next = picture_.channels;
        const auto at = [](const float* t) { return Rgb{t[0], t[1], t[2]}; };
        return (1.0 - fy) * ((1.0 - fx) * at(p) + fx * at(p + next)) +
               fy * ((1.0 - fx) * at(q) + fx * at(q + next));
    }
    return (1.0 - fy) * ((1.0 - fx) * texel(i, j) + fx * texel(i + 1, j)) +
           fy * ((1.0 - fx) * texel(i, j + 1) + fx * texel(i + 1, j + 1));
}

std::size_t DirectionPicture::row_for(double share) const {
    const std::size_t part = part_of(share, row_parts_);
    return pick(rows_, row_guide_[part], row_guide_[part + 1], share * rows_.back());
}

const std::uint32_t* DirectionPicture::guide_for(const Search& search) const {
    const std::size_t part = part_of(static_cast<float>(search.u.x), column_parts_);
    return &column_guides_[search.row * (column_parts_ + 1) + part];
}

DirectionPicture::Search DirectionPicture::begin(const Vec2& u) const {
    Search search{u};
    search.row = row_for(u.y);
    const double above = rows_[search.row], below = rows_[search.row + 1];
    search.share_y = std::clamp((u.y * rows_.back() - above) / (below - above), 0.0, 1.0);
    __builtin_prefetch(guide_for(search));
    return search;
}

void DirectionPicture::approach(const Search& search) const {
    __builtin_prefetch(shares_of(search.row).data() + *guide_for(search));
}

void DirectionPicture::find(Search& search) const {
    const std::uint32_t* const guide = guide_for(search);
    search.column = pick(shares_of(search.row), guide[0], guide[1], static_cast<float>(search.u.x));
    // The rows between which radiance is interpolated.
    const int row = static_cast<int>(search.row) - (search.share_y < 0.5 ? 1 : 0);
    const int column = static_cast<int>(search.column);
    __builtin_prefetch(picture_.pixel(column, std::max(row, 0)));
    __builtin_prefetch(picture_.pixel(column, std::min(row + 1, picture_.height - 1)));
}

double DirectionPicture::height_of(const Search& search) const {
    const int row = static_cast<int>(search.row);
    const double top = height(row), bottom = height(row + 1);
    return top + search.share_y * (bottom - top);
}

double DirectionPicture::column_at(const Search& search) const {
    const std::span<const float> shares = shares_of(search.row);
    const double from = shares[search.column], to = shares[search.column + 1];
    const double share_x = std::clamp((search.u.x - from) / (to - from), 0.0, 1.0);
    return (static_cast<double>(search.column) + share_x) / picture_.width;
}

Vec3 DirectionPicture::direction(const Search& search) const {
    const double z = height_of(search), across = std::sqrt(std::max(0.0, 1.0 - z * z));
    // Longitude 0 is in the middle of the picture.
    const Vec2 from_edge = direction_after(column_at(search));
    return {across * -from_edge.y, across * -from_edge.x, z};
}

void DirectionPicture::find_directions(std::span<const Search> searches, Vec3* directions) const {
    DirectionLanes lanes;
    for (std::size_t done = 0; done < searches.size(); done += DirectionLanes::kMost) {
        const std::size_t count = std::min(DirectionLanes::kMost, searches.size() - done);
        for (std::size_t i = 0; i < count; ++i) {
            lanes.z[i] = height_of(searches[done + i]);
            lanes.column[i] = column_at(searches[done + i]);
        }
        lanes.find_directions(count);
        for (std::size_t i = 0; i < count; ++i) {
            directions[done + i] = {lanes.x[i], lanes.y[i], lanes.z[i]};
        }
    }
}

Vec3 DirectionPicture::sample(const Vec2& u) const {
    Search search = begin(u);
    find(search);
    return direction(search);
}

double DirectionPicture::density_at(const Place& place) const {
    const int y = index_below(place.row, picture_.height);
    const int x = index_below(place.column, picture_.width);
    const std::size_t row = std::size_t(y);
    const double share = (rows_[row + 1] - rows_[row]) / rows_.back();
    const std::size_t first = row * std::size_t(picture_.width + 1) + std::size_t(x);
    const double of_row = double(columns_[first + 1]) - double(columns_[first]);
    const double solid = 2.0 * kPi / picture_.width * (height(y) - height(y + 1));
    return share * of_row / solid;
}

}  // namespace alhazen

#include "alhazen/renderers/antialias/adaptive_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/base/error.h"

namespace alhazen {

namespace {

/// Side of the blocks by which corners and pixels are ordered.
constexpr int kGridBlock = 8;
/// Largest number of points that a division adds: its own and the centres of pixels around it.
constexpr std::size_t kMostOfADivision = 5 + 8;

}  // namespace

/// The range of the shades in a cell, weighted by its share of the pixel and clamped to 1 as on
/// display.
class AdaptiveGrid::Range {
  public:
    explicit Range(double weight) : weight_(weight) {}
    void include(const Rgb& shade) {
        for (int channel = 0; channel < 3; ++channel) {
            const double value = std::min(weight_ * shade[channel], 1.0);
            least_[channel] = std::min(least_[channel], value);
            most_[channel] = std::max(most_[channel], value);
        }
    }
    [[nodiscard]] bool exceeds(double threshold) const {
        for (int channel = 0; channel < 3; ++channel) {
            if (most_[channel] - least_[channel] > threshold) return true;
        }
        return false;
    }

  private:
    static constexpr double kInf = std::numeric_limits<double>::infinity();
    double weight_;
    double least_[3] = {kInf, kInf, kInf}, most_[3] = {-kInf, -kInf, -kInf};
};

AdaptiveGrid::AdaptiveGrid(int width, int height, const AntialiasSettings& settings)
    : settings_(settings), width_(width), height_(height) {
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    if (pixels >= kMostPoints / 2) {
        throw Error(ErrorKind::Resource, "--antialias: the picture has too many pixels");
    }
    pixels_.resize(pixels);
    asked_.resize(pixels);
    added_.resize(static_cast<std::size_t>(settings.depth) + 1);
    divided_.resize(added_.size());
    if (settings.neighbours) ended_pixels_.resize(pixels, NumberTable::kNone);
    add_corners();
}

void AdaptiveGrid::add_corners() {
    const std::size_t count = std::size_t(width_ + 1) * std::size_t(height_ + 1);
    points_.resize(count);
    shades_.resize(count);
    distances_.resize(count);
    added_[0] = count;
    for (int y = 0; y <= height_; ++y) {
        for (int x = 0; x <= width_; ++x) {
            points_[corner_index(x, y)] = {x << settings_.depth, y << settings_.depth};
            const int i = std::min(x, width_ - 1), j = std::min(y, height_ - 1);
            ++asked_[std::size_t(j) * std::size_t(width_) + std::size_t(i)];
        }
    }
    open_.reserve(pixels_.size());
    for (int y0 = 0; y0 < height_; y0 += kGridBlock) {
        for (int x0 = 0; x0 < width_; x0 += kGridBlock) {
            for (int y = y0; y < std::min(y0 + kGridBlock, height_); ++y) {
                for (int x = x0; x < std::min(x0 + kGridBlock, width_); ++x) {
                    open_.push_back({{x, y},
                                     {corner_index(x, y), corner_index(x + 1, y),
                                      corner_index(x, y + 1), corner_index(x + 1, y + 1)},
                                     std::uint32_t(y) * std::uint32_t(width_) + std::uint32_t(x),
                                     0,
                                     0,
                                     0});
                }
            }
        }
    }
}

/// Corners are ordered by blocks, and row by row within a block.
std::uint32_t AdaptiveGrid::corner_index(int x, int y) const {
    const int x0 = x / kGridBlock * kGridBlock, y0 = y / kGridBlock * kGridBlock;
    const int block_width = std::min(kGridBlock, width_ + 1 - x0);
    const int block_height = std::min(kGridBlock, height_ + 1 - y0);
    return std::uint32_t(y0) * std::uint32_t(width_ + 1) +
           std::uint32_t(x0 * block_height + (y - y0) * block_width + (x - x0));
}

double AdaptiveGrid::farthest_of_pixel(int x, int y) const {
    return std::max({distances_[corner_index(x, y)], distances_[corner_index(x + 1, y)],
                     distances_[corner_index(x, y + 1)], distances_[corner_index(x + 1, y + 1)]});
}

/// NumberTable::kNone if the point has no ray. Not for corners of pixels.
std::uint32_t AdaptiveGrid::sample_at(GridPoint p) const {
    return samples_.find(grid_key(0, p));
}

std::uint32_t AdaptiveGrid::add_point(GridPoint p, int level, std::uint32_t pixel) {
    const auto fresh = static_cast<std::uint32_t>(first_ + points_.size());
    const std::uint32_t sample = samples_.find_or_add(grid_key(0, p), fresh);
    if (sample == fresh) {
        points_.push_back(p);
        ++asked_[pixel];
        ++added_[static_cast<std::size_t>(level)];
    }
    return sample;
}

void AdaptiveGrid::look_for(std::span<const WatchedObject> objects) {
    watched_.clear();
    for (const WatchedObject& o : objects) watched_.push_back(o.object);
    for (Cell& cell : open_) {
        const auto begin =
            std::lower_bound(objects.begin(), objects.end(), WatchedObject{cell.pixel, 0});
        auto end = begin;
        while (end != objects.end() && end->pixel == cell.pixel) ++end;
        cell.first_watched = static_cast<std::uint32_t>(begin - objects.begin());
        cell.watched = static_cast<std::uint32_t>(end - begin);
    }
}

bool AdaptiveGrid::refine(const ObjectWatch* watch) {
    first_ = shades_.size();
    points_.clear();
    do {
        choose(watch);
        if (first_ + kMostOfADivision * split_.size() > kMostPoints) {
            throw Error(ErrorKind::Resource,
                        "--antialias: too many rays; a smaller depth needs fewer");
        }
        for (const Cell& cell : split_) divide(cell);
        open_.swap(next_open_);
    } while (points_.empty() && !open_.empty());
    shades_.resize(first_ + points_.size());
    distances_.resize(shades_.size());
    if (!points_.empty()) return true;
    for (const Cell& cell : ended_) {
        if (!cell.is_divided) add_to_pixel(cell);
    }
    return false;
}

/// Selects the cells to divide, among the open cells and the ended cells next to new points. All
/// points have shades here.
void AdaptiveGrid::choose(const ObjectWatch* watch) {
    split_.clear();
    next_open_.clear();
    next_watched_.clear();
    for (const Cell& cell : open_) {
        live_.clear();
        near_.clear();
        const bool is_near_smaller = watch != nullptr && keep_near(cell, *watch);
        const bool weigh = settings_.weigh && !is_near_smaller;
        const bool last = cell.level == settings_.depth;
        if (last || (live_.empty() && !differs(cell, weigh))) {
            end(cell);
            continue;
        }
        Cell& kept = split_.emplace_back(cell);
        kept.first_watched = static_cast<std::uint32_t>(next_watched_.size());
        kept.watched = static_cast<std::uint32_t>(near_.size());
        next_watched_.insert(next_watched_.end(), near_.begin(), near_.end());
    }
    watched_.swap(next_watched_);
    for (const std::uint32_t number : woken_) {
        Cell& cell = ended_[number];
        cell.is_woken = false;
        if (!differs(cell, settings_.weigh)) continue;
        cell.is_divided = true;
        cell.watched = 0;
        split_.push_back(cell);
        if (cell.level == 0) {
            ended_pixels_[cell.pixel] = NumberTable::kNone;
        } else {
            ended_cells_.set(grid_key(cell.level, cell.at), NumberTable::kNone);
        }
    }
    woken_.clear();
}

bool AdaptiveGrid::differs(const Cell& cell, bool weigh) const {
    Range range(weigh ? std::ldexp(1.0, -2 * cell.level) : 1.0);
    for (const std::uint32_t corner : cell.corners) range.include(shades_[corner]);
    if (range.exceeds(settings_.threshold)) return true;
    if (!settings_.neighbours || cell.level == settings_.depth) return false;
    const int side = 1 << (settings_.depth - cell.level);
    const GridPoint a{cell.at.x * side, cell.at.y * side}, b{a.x + side, a.y + side};
    include_side(range, a, {b.x, a.y});
    include_side(range, a, {a.x, b.y});
    include_side(range, {b.x, a.y}, b);
    include_side(range, {a.x, b.y}, b);
    if (cell.level == 0) {
        const std::uint32_t centre = sample_at({a.x + side / 2, a.y + side / 2});
        if (centre != NumberTable::kNone) range.include(shades_[centre]);
    }
    return range.exceeds(settings_.threshold);
}

/// Includes the points between two corners, which exist if the adjacent cell was divided.
void AdaptiveGrid::include_side(Range& range, GridPoint a, GridPoint b) const {
    const GridPoint middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
    const std::uint32_t sample = sample_at(middle);
    if (sample == NumberTable::kNone) return;
    range.include(shades_[sample]);
    if (std::max(b.x - a.x, b.y - a.y) == 2) return;
    include_side(range, a, middle);
    include_side(range, middle, b);
}

bool AdaptiveGrid::keep_near(const Cell& cell, const ObjectWatch& watch) {
    bool any_smaller = false;
    double farthest = 0.0;
    for (const std::uint32_t corner : cell.corners) {
        farthest = std::max(farthest, distances_[corner]);
    }
    for (std::uint32_t k = 0; k < cell.watched; ++k) {
        const std::uint32_t object = watched_[cell.first_watched + k];
        const bool sought = watch.is_sought(object);
        const bool smaller = watch.is_smaller(object, cell.level);
        if (!sought && !smaller) continue;
        if (!watch.may_hide(object, cell.level, cell.at, farthest)) continue;
        near_.push_back(object);
        if (sought) live_.push_back(object);
        any_smaller = any_smaller || smaller;
    }
    return any_smaller;
}

/// Keeps the cell if it may have to be divided later, else adds it to its pixel.
void AdaptiveGrid::end(const Cell& cell) {
    if (!settings_.neighbours || cell.level == settings_.depth) return add_to_pixel(cell);
    const auto number = static_cast<std::uint32_t>(ended_.size());
    ended_.push_back(cell);
    if (cell.level == 0) {
        ended_pixels_[cell.pixel] = number;
    } else {
        ended_cells_.set(grid_key(cell.level, cell.at), number);
    }
}

void AdaptiveGrid::add_to_pixel(const Cell& cell) {
    Rgb sum;
    int finite = 0;
    for (const std::uint32_t corner : cell.corners) {
        if (!shades_[corner].is_finite()) continue;
        sum += shades_[corner];
        ++finite;
    }
    if (finite == 0) return;
    pixels_[cell.pixel] += std::ldexp(1.0, -2 * cell.level) * ((1.0 / finite) * sum);
}

void AdaptiveGrid::divide(const Cell& cell) {
    ++divided_[cell.level];
    const int level = cell.level + 1, half = 1 << (settings_.depth - level);
    const std::int32_t x = 2 * cell.at.x, y = 2 * cell.at.y;
    const auto add = [&](std::int32_t dx, std::int32_t dy) {
        return add_point({half * (x + dx), half * (y + dy)}, level, cell.pixel);
    };
    const std::uint32_t* c = cell.corners;
    const std::uint32_t up = add(1, 0), left = add(0, 1), middle = add(1, 1), right = add(2, 1),
                        down = add(1, 2);
    const auto child = [&](std::int32_t dx, std::int32_t dy, std::uint32_t a, std::uint32_t b,
                           std::uint32_t d, std::uint32_t e) {
        next_open_.push_back({{x + dx, y + dy},
                              {a, b, d, e},
                              cell.pixel,
                              cell.first_watched,
                              cell.watched,
                              static_cast<std::uint8_t>(level)});
    };
    child(0, 0, c[0], up, left, middle);
    child(1, 0, up, c[1], middle, right);
    child(0, 1, left, middle, c[2], down);
    child(1, 1, middle, right, down, c[3]);
    if (!settings_.neighbours) return;
    wake_beside(cell);
    if (cell.level == 0) look_at_centres_around(cell);
}

/// Marks the adjacent ended cells that are not smaller for another test.
void AdaptiveGrid::wake_beside(const Cell& cell) {
    constexpr GridPoint kBeside[] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    for (const GridPoint& d : kBeside) {
        GridPoint at{cell.at.x + d.x, cell.at.y + d.y};
        if (at.x < 0 || at.y < 0 || at.x >= width_ << cell.level || at.y >= height_ << cell.level) {
            continue;
        }
        for (int level = cell.level; level >= 0; --level, at = {at.x / 2, at.y / 2}) {
            const std::uint32_t ended = ended_at(level, at);
            if (ended == NumberTable::kNone) continue;
            wake(ended);
            break;
        }
    }
}

/// Adds the centres of those of the eight pixels around a divided one that are not divided.
void AdaptiveGrid::look_at_centres_around(const Cell& cell) {
    const int half = 1 << settings_.depth >> 1;
    for (int y = std::max(cell.at.y - 1, 0); y <= std::min(cell.at.y + 1, height_ - 1); ++y) {
        for (int x = std::max(cell.at.x - 1, 0); x <= std::min(cell.at.x + 1, width_ - 1); ++x) {
            const std::uint32_t ended = ended_at(0, {x, y});
            if (ended == NumberTable::kNone) continue;
            (void)add_point({half * (2 * x + 1), half * (2 * y + 1)}, 1, ended_[ended].pixel);
            wake(ended);
        }
    }
}

std::uint32_t AdaptiveGrid::ended_at(int level, GridPoint at) const {
    if (level > 0) return ended_cells_.find(grid_key(level, at));
    return ended_pixels_[std::size_t(at.y) * std::size_t(width_) + std::size_t(at.x)];
}

void AdaptiveGrid::wake(std::uint32_t ended) {
    Cell& cell = ended_[ended];
    if (cell.is_woken) return;
    cell.is_woken = true;
    woken_.push_back(ended);
}

}  // namespace alhazen

#include "alhazen/renderers/antialias/adaptive_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "alhazen/base/error.h"

namespace alhazen {

namespace {

/// Side of the blocks in which corners and pixels are ordered.
constexpr int kGridBlock = 8;
constexpr std::size_t kMostPoints = std::numeric_limits<std::uint32_t>::max() / 2;

double shown(double channel) {
    return std::min(channel, 1.0);
}

}  // namespace

/// The points that a level adds, by their coordinates: open addressing.
class PointTable {
  public:
    /// `cells`: to be divided.
    explicit PointTable(std::size_t cells)
        : keys_(std::bit_ceil(std::max<std::size_t>(16, 8 * cells)), kFree),
          values_(keys_.size()) {}

    /// The value of the point, set to `fresh` where it has none.
    std::uint32_t find(GridPoint p, std::uint32_t fresh) {
        const std::uint64_t key = std::uint64_t(std::uint32_t(p.y)) << 32 | std::uint32_t(p.x);
        std::size_t slot = (key * 0x9E3779B97F4A7C15u) >> 20 & (keys_.size() - 1);
        while (keys_[slot] != kFree && keys_[slot] != key) slot = (slot + 1) & (keys_.size() - 1);
        if (keys_[slot] == kFree) {
            keys_[slot] = key;
            values_[slot] = fresh;
        }
        return values_[slot];
    }

  private:
    static constexpr std::uint64_t kFree = ~std::uint64_t{0};
    std::vector<std::uint64_t> keys_;
    std::vector<std::uint32_t> values_;
};

AdaptiveGrid::AdaptiveGrid(int width, int height, const AntialiasSettings& settings)
    : settings_(settings), width_(width), height_(height) {
    const std::size_t pixels = std::size_t(width) * std::size_t(height);
    if (pixels >= kMostPoints / 2) {
        throw Error(ErrorKind::Resource, "--antialias: the picture has too many pixels");
    }
    pixels_.resize(pixels);
    asked_.resize(pixels);
    add_corners();
}

void AdaptiveGrid::add_corners() {
    const std::size_t count = std::size_t(width_ + 1) * std::size_t(height_ + 1);
    points_.resize(count);
    shades_.resize(count);
    distances_.resize(count);
    for (int y = 0; y <= height_; ++y) {
        for (int x = 0; x <= width_; ++x) {
            points_[corner_index(x, y)] = {x, y};
            const int i = std::min(x, width_ - 1), j = std::min(y, height_ - 1);
            ++asked_[std::size_t(j) * std::size_t(width_) + std::size_t(i)];
        }
    }
    cells_.reserve(pixels_.size());
    for (int y0 = 0; y0 < height_; y0 += kGridBlock) {
        for (int x0 = 0; x0 < width_; x0 += kGridBlock) {
            for (int y = y0; y < std::min(y0 + kGridBlock, height_); ++y) {
                for (int x = x0; x < std::min(x0 + kGridBlock, width_); ++x) {
                    cells_.push_back({{x, y},
                                      {corner_index(x, y), corner_index(x + 1, y),
                                       corner_index(x, y + 1), corner_index(x + 1, y + 1)},
                                      std::uint32_t(y) * std::uint32_t(width_) + std::uint32_t(x),
                                      0,
                                      0});
                }
            }
        }
    }
}

/// Corners are ordered in blocks, these row by row.
std::uint32_t AdaptiveGrid::corner_index(int x, int y) const {
    const int x0 = x / kGridBlock * kGridBlock, y0 = y / kGridBlock * kGridBlock;
    const int block_width = std::min(kGridBlock, width_ + 1 - x0);
    const int block_height = std::min(kGridBlock, height_ + 1 - y0);
    return std::uint32_t(y0) * std::uint32_t(width_ + 1) +
           std::uint32_t(x0 * block_height + (y - y0) * block_width + (x - x0));
}

void AdaptiveGrid::look_for(std::span<const WatchedObject> objects) {
    watched_.clear();
    for (const WatchedObject& o : objects) watched_.push_back(o.object);
    for (Cell& cell : cells_) {
        const auto begin =
            std::lower_bound(objects.begin(), objects.end(), WatchedObject{cell.pixel, 0});
        auto end = begin;
        while (end != objects.end() && end->pixel == cell.pixel) ++end;
        cell.first_watched = static_cast<std::uint32_t>(begin - objects.begin());
        cell.watched = static_cast<std::uint32_t>(end - begin);
    }
}

bool AdaptiveGrid::refine(const ObjectWatch* watch) {
    std::vector<Cell> split;
    next_watched_.clear();
    const bool last = level_ == settings_.depth;
    for (const Cell& cell : cells_) {
        live_.clear();
        if (watch != nullptr) keep_live(cell, *watch);
        if (last || (live_.empty() && !differs(cell))) {
            add_to_pixel(cell);
            for (const std::uint32_t object : live_) below_depth_.push_back({cell.pixel, object});
            continue;
        }
        Cell& kept = split.emplace_back(cell);
        kept.first_watched = static_cast<std::uint32_t>(next_watched_.size());
        kept.watched = static_cast<std::uint32_t>(live_.size());
        next_watched_.insert(next_watched_.end(), live_.begin(), live_.end());
    }
    watched_.swap(next_watched_);
    divided_.push_back(split.size());
    if (split.empty()) {
        std::sort(below_depth_.begin(), below_depth_.end());
        below_depth_.erase(std::unique(below_depth_.begin(), below_depth_.end()),
                           below_depth_.end());
        return false;
    }
    if (shades_.size() + 5 * split.size() > kMostPoints) {
        throw Error(ErrorKind::Resource, "--antialias: too many rays; a smaller depth needs fewer");
    }
    first_ = shades_.size();
    points_.clear();
    next_cells_.clear();
    next_cells_.reserve(4 * split.size());
    PointTable table(split.size());
    for (const Cell& cell : split) divide(cell, table);
    cells_.swap(next_cells_);
    shades_.resize(first_ + points_.size());
    distances_.resize(shades_.size());
    ++level_;
    return true;
}

bool AdaptiveGrid::differs(const Cell& cell) const {
    for (int channel = 0; channel < 3; ++channel) {
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (const std::uint32_t corner : cell.corners) {
            const double value = shown(shades_[corner][channel]);
            least = std::min(least, value);
            most = std::max(most, value);
        }
        if (most - least > settings_.threshold) return true;
    }
    return false;
}

/// Collects the objects of the cell that are still sought and close to one of its corners.
void AdaptiveGrid::keep_live(const Cell& cell, const ObjectWatch& watch) {
    for (std::uint32_t k = 0; k < cell.watched; ++k) {
        const std::uint32_t object = watched_[cell.first_watched + k];
        if (!watch.is_sought(object)) continue;
        for (int c = 0; c < 4; ++c) {
            const GridPoint corner{cell.at.x + (c & 1), cell.at.y + (c >> 1)};
            if (!watch.passes(object, level_, corner, distances_[cell.corners[c]])) continue;
            live_.push_back(object);
            break;
        }
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
    pixels_[cell.pixel] += std::ldexp(1.0, -2 * level_) * ((1.0 / finite) * sum);
}

void AdaptiveGrid::divide(const Cell& cell, PointTable& table) {
    const std::int32_t x = 2 * cell.at.x, y = 2 * cell.at.y;
    const auto add = [&](std::int32_t dx, std::int32_t dy) {
        const GridPoint p{x + dx, y + dy};
        const auto fresh = static_cast<std::uint32_t>(first_ + points_.size());
        const std::uint32_t index = table.find(p, fresh);
        if (index == fresh) {
            points_.push_back(p);
            ++asked_[cell.pixel];
        }
        return index;
    };
    const std::uint32_t* c = cell.corners;
    const std::uint32_t up = add(1, 0), left = add(0, 1), middle = add(1, 1), right = add(2, 1),
                        down = add(1, 2);
    const auto child = [&](std::int32_t dx, std::int32_t dy, std::uint32_t a, std::uint32_t b,
                           std::uint32_t d, std::uint32_t e) {
        next_cells_.push_back(
            {{x + dx, y + dy}, {a, b, d, e}, cell.pixel, cell.first_watched, cell.watched});
    };
    child(0, 0, c[0], up, left, middle);
    child(1, 0, up, c[1], middle, right);
    child(0, 1, left, middle, c[2], down);
    child(1, 1, middle, right, down, c[3]);
}

}  // namespace alhazen

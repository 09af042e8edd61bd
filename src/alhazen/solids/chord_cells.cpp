#include "alhazen/solids/chord_cells.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

namespace alhazen {

namespace {

/// Share of the variance of a cell along a rim that each of its quarters inherits (h^5).
constexpr float kRimShare = 1.0f / 32;
/// Bits of a Morton number: pairs of the bits of x and y, the bit of the first halving foremost.
constexpr std::uint64_t kAlongX = 0xaaaaaaaaaaaaaaaa, kAlongY = 0x5555555555555555;
/// Cells of more halvings have the number of one that contains them.
constexpr unsigned kMostHalvings = 32;

/// The Morton number one step along an axis away from the parent; none outside of the patch.
std::optional<std::uint64_t> step(std::uint64_t place, std::uint64_t axis, std::uint64_t size) {
    const bool forward = (place & size) != 0;
    const std::uint64_t moved = (forward ? (place | ~axis) + size : (place & axis) - size) & axis;
    const bool is_outside = forward ? moved == 0 : (place & axis) == 0;
    return is_outside ? std::nullopt : std::optional(moved | (place & ~axis));
}

}  // namespace

ChordCells::ChordCells(std::vector<Patch> patches) : patches_(std::move(patches)), covered_(0) {
    for (const Patch& p : patches_) {
        covered_ += p.area();
        narrowest_[0] = std::min(narrowest_[0], double{p.width});
        narrowest_[1] = std::min(narrowest_[1], double{p.height});
    }
}

void ChordCells::make_grid(std::size_t cells) {
    for (std::size_t p = 0; p < patches_.size(); ++p) {
        const Patch& patch = patches_[p];
        const double wanted = static_cast<double>(cells) * patch.area() / covered_;
        std::vector<ChordCell> grid{{patch.x, patch.y, patch.width, patch.height}};
        grid.front().patch = static_cast<std::uint8_t>(p);
        while (static_cast<double>(16 * grid.size()) <= wanted) {
            std::vector<ChordCell> finer;
            for (const ChordCell& c : grid) {
                for (const ChordCell& quarter : c.quarters()) finer.push_back(quarter);
            }
            grid = std::move(finer);
        }
        for (ChordCell& c : grid) c.quarter = false;
        cells_.insert(cells_.end(), grid.begin(), grid.end());
    }
}

std::array<ChordCell, 4> ChordCell::quarters() const {
    ChordCell part = *this;
    part.width *= 0.5f;
    part.height *= 0.5f;
    part.scatter *= kRimShare;
    for (float& second : part.curvature) second *= 0.25f;
    part.quarter = true;
    part.surveyed = false;
    ++part.level;
    std::array<ChordCell, 4> all{part, part, part, part};
    all[1].y += part.height;
    all[2].x += part.width;
    all[3].x += part.width;
    all[3].y += part.height;
    if (part.level <= kMostHalvings) {
        for (std::uint64_t k = 1; k < 4; ++k) all[k].place += k << (64 - 2 * part.level);
    }
    return all;
}

void ChordCells::cut(std::size_t cells, double share_for_size) {
    if (cells <= cells_.size()) return;
    const std::size_t wanted = std::min(cells_.size(), (cells - cells_.size() + 2) / 3);
    std::vector<std::uint32_t> order(cells_.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto for_size = static_cast<std::size_t>(share_for_size * static_cast<double>(wanted));
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(wanted - for_size);
    const auto by = [&](auto&& size) {
        return [&, size](std::uint32_t a, std::uint32_t b) {
            const double of_a = size(cells_[a]), of_b = size(cells_[b]);
            return of_a != of_b ? of_a > of_b : a < b;
        };
    };
    std::vector<bool> is_cut(cells_.size());
    std::size_t count = 0;
    const auto by_scatter = by([](const ChordCell& c) { return c.scatter; });
    std::nth_element(order.begin(), first, order.end(), by_scatter);
    std::sort(order.begin(), first, by_scatter);
    for (auto i = order.begin(); i != first && count < wanted - for_size; ++i) {
        if (!(cells_[*i].scatter > 0)) break;
        if (!is_cut[*i]) count += mark(*i, is_cut);
    }
    if (count < wanted) {
        const auto rest =
            std::partition(order.begin(), order.end(), [&](std::uint32_t i) { return is_cut[i]; });
        const auto last = rest + static_cast<std::ptrdiff_t>(wanted - count);
        std::nth_element(rest, last, order.end(), by([](const ChordCell& c) { return c.area(); }));
        for (auto i = rest; i != last; ++i) {
            if (!is_cut[*i]) count += mark(*i, is_cut);
        }
    }
    std::vector<ChordCell> finer;
    finer.reserve(cells_.size() + 3 * count);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const ChordCell& c = cells_[i];
        if (!is_cut[i]) {
            finer.push_back(c);
            continue;
        }
        for (const ChordCell& quarter : c.quarters()) finer.push_back(quarter);
    }
    cells_ = std::move(finer);
}

std::size_t ChordCells::mark(std::size_t cell, std::vector<bool>& is_cut) const {
    std::size_t count = 0;
    std::vector<std::size_t> open{cell};
    is_cut[cell] = true;
    while (!open.empty()) {
        const ChordCell& c = cells_[open.back()];
        open.pop_back();
        ++count;
        if (c.level == 0 || c.level > kMostHalvings) continue;
        // A larger cell that touches it does so across the sides that it shares with its parent.
        const std::uint64_t up = std::uint64_t{1} << (64 - 2 * c.level), right = 2 * up;
        const auto beside = step(c.place, kAlongX, right), above = step(c.place, kAlongY, up);
        for (const auto& place :
             {beside, above, beside ? step(*beside, kAlongY, up) : std::nullopt}) {
            if (!place) continue;
            const std::size_t other = cell_at(c.patch, *place);
            if (cells_[other].level >= c.level || is_cut[other]) continue;
            is_cut[other] = true;
            open.push_back(other);
        }
    }
    return count;
}

std::size_t ChordCells::cell_at(std::uint8_t patch, std::uint64_t place) const {
    const auto after = std::partition_point(cells_.begin(), cells_.end(), [&](const ChordCell& c) {
        return c.patch != patch ? c.patch < patch : c.place <= place;
    });
    return static_cast<std::size_t>(after - cells_.begin()) - 1;
}

}  // namespace alhazen

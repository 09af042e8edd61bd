#include "alhazen/sampling/samplers/grid_samplers.h"

#include <cmath>

namespace alhazen {

EqualCells::EqualCells(std::uint32_t count)
    : count_(count),
      rows_(std::max(1u, static_cast<std::uint32_t>(std::lround(std::sqrt(count))))),
      short_row_(count / rows_),
      long_rows_(count % rows_) {}

Vec2 EqualCells::at(std::uint32_t i, const Vec2& in) const {
    // The long rows come first and have one cell more.
    const std::uint32_t in_long = long_rows_ * (short_row_ + 1);
    const bool is_long = i < in_long;
    const std::uint32_t columns = is_long ? short_row_ + 1 : short_row_;
    const std::uint32_t begin =
        is_long ? i / columns * columns : in_long + (i - in_long) / columns * columns;
    return {(i - begin + in.x) / columns, (begin + in.y * columns) / count_};
}

Vec2 RooksSampler::point(std::uint64_t key, std::uint32_t i) const {
    const Vec2 in = uniform_pair(key, i);
    const std::uint32_t row = permuted(i, count(), mix64(key + 1));
    return {(i + in.x) / count(), (row + in.y) / count()};
}

MultiJitteredSampler::MultiJitteredSampler(std::uint64_t seed, std::uint32_t count)
    : SetSampler(seed, count),
      rows_(std::max(1u, static_cast<std::uint32_t>(std::sqrt(static_cast<double>(count))))),
      columns_((count + rows_ - 1) / rows_) {}

Vec2 MultiJitteredSampler::point(std::uint64_t key, std::uint32_t i) const {
    const std::uint32_t cells = rows_ * columns_;
    const std::uint32_t cell = cells == count() ? i : permuted(i, cells, mix64(key + 1));
    const std::uint32_t column = cell % columns_, row = cell / columns_;
    // The cells of a column have different fine columns; the cells of a row different fine rows.
    const std::uint32_t fine_column = permuted(row, rows_, mix64(key + 2) + column);
    const std::uint32_t fine_row = permuted(column, columns_, mix64(key + 3) + row);
    const Vec2 in = uniform_pair(key, i);
    return {(column + (fine_column + in.x) / rows_) / columns_,
            (row + (fine_row + in.y) / columns_) / rows_};
}

}  // namespace alhazen

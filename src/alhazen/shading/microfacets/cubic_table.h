#pragma once
/// A table of a smooth function of D numbers in [0, 1], at even steps, read by cubic interpolation.
///
/// Source: Catmull and Rom, "A Class of Local Interpolating Splines", 1974.
/// Differs: beyond the ends the table is extrapolated by the parabola through its last three
/// values.
/// Complexity and threads: 4^D values per lookup; const functions may be called concurrently.

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace alhazen {

template <std::size_t D>
class CubicTable {
  public:
    using Point = std::array<double, D>;

    CubicTable() = default;
    /// `sizes`: number of values along each axis, at least 3. `function` takes a Point.
    template <class F>
    CubicTable(const std::array<int, D>& sizes, const F& function) : sizes_(sizes) {
        std::size_t count = 1;
        for (const int size : sizes) count *= static_cast<std::size_t>(size);
        values_.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            Point p;
            std::size_t rest = i;
            for (std::size_t axis = D; axis-- > 0;) {
                const auto size = static_cast<std::size_t>(sizes[axis]);
                p[axis] = static_cast<double>(rest % size) / static_cast<double>(size - 1);
                rest /= size;
            }
            values_.push_back(function(p));
        }
    }

    [[nodiscard]] double at(const Point& p) const { return along<0>(p, 0); }
    /// Writes the values along the first of two axes at the coordinate `y` of the second;
    /// interpolating them with `at` equals a lookup in the table.
    void get_slice(double y, std::span<double> out) const requires(D == 2) {
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = along<1>({0, y}, i);
    }
    /// Interpolates in a slice of `get_slice`.
    [[nodiscard]] static double at(std::span<const double> slice, double x) {
        return interpolated(static_cast<int>(slice.size()), x,
                            [&](int i) { return slice[static_cast<std::size_t>(i)]; });
    }

    /// A cubic between two neighbouring values.
    struct Piece {
        double constant, linear, square, cube;

        [[nodiscard]] double at(double t) const {
            return constant + 0.5 * t * (linear + t * (square + t * cube));
        }
    };
    /// Writes the pieces of a slice, one fewer than its values.
    static void get_pieces(std::span<const double> slice, std::span<Piece> out) {
        const std::size_t size = slice.size();
        for (std::size_t cell = 0; cell + 1 < size; ++cell) {
            out[cell] = piece(cell, size, [&](std::size_t i) { return slice[i]; });
        }
    }
    /// Interpolates by the pieces of a slice: the bits of `at`.
    [[nodiscard]] static double at(std::span<const Piece> pieces, double x) {
        const auto [cell, t] = place_in(pieces.size(), x);
        return pieces[cell].at(t);
    }

  private:
    template <std::size_t Axis>
    [[nodiscard]] double along(const Point& p, std::size_t start) const {
        const int size = sizes_[Axis];
        return interpolated(size, p[Axis], [&](int i) {
            const std::size_t index =
                start * static_cast<std::size_t>(size) + static_cast<std::size_t>(i);
            if constexpr (Axis + 1 == D) {
                return values_[index];
            } else {
                return along<Axis + 1>(p, index);
            }
        });
    }

    struct Place {
        std::size_t cell;
        double t;  ///< 0..1 within the cell
    };
    /// The place of x in [0, 1] among `cells`; NaN is 0.
    [[nodiscard]] static Place place_in(std::size_t cells, double x) {
        const double at = (x > 0.0 ? std::min(x, 1.0) : 0.0) * static_cast<double>(cells);
        const int cell = std::min(static_cast<int>(at), static_cast<int>(cells) - 1);
        return {static_cast<std::size_t>(cell), at - cell};
    }
    /// The cubic through the four neighbours of a cell, for t in [0, 1] between the middle two.
    template <class Value>
    [[nodiscard]] static Piece piece(std::size_t cell, std::size_t size, const Value& value) {
        const double b = value(cell), c = value(cell + 1);
        const double a = cell > 0 ? value(cell - 1) : 3.0 * b - 3.0 * c + value(cell + 2);
        const double d = cell + 2 < size ? value(cell + 2) : 3.0 * c - 3.0 * b + a;
        return {b, c - a, 2.0 * a - 5.0 * b + 4.0 * c - d, 3.0 * (b - c) + d - a};
    }
    /// Interpolates `size` values at x in [0, 1] from the first to the last.
    template <class Value>
    [[nodiscard]] static double interpolated(int size, double x, const Value& value) {
        const auto [cell, t] = place_in(static_cast<std::size_t>(size) - 1, x);
        return piece(cell, static_cast<std::size_t>(size),
                     [&](std::size_t i) { return value(static_cast<int>(i)); })
            .at(t);
    }

    std::array<int, D> sizes_{};
    std::vector<double> values_;
};

}  // namespace alhazen

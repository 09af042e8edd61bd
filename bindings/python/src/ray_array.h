#pragma once
/// Rays and points from numpy arrays, converted block by block: arrays that are contiguous and
/// float32 or float64 are never copied as a whole.
///
/// Conventions: rays (..., 6) are origin x, y, z and direction x, y, z; (..., 8) also t_min, t_max.
/// Results have the shape (...) and the precision of the rays: float32 for float32, else float64.

#include <pybind11/numpy.h>

#include <cstddef>
#include <span>
#include <vector>

#include "alhazen/geometry/ray.h"

namespace alhazen::python {

/// Throws Error (Usage) for an array with masked numbers (numpy.ma): its mask would be lost.
void refuse_masked(const pybind11::object& numbers, const char* what);

class NumberArray {
  public:
    /// Converts arrays of other types and layouts once. Throws Error (Usage) unless the last
    /// dimension is one of `columns` and no number is masked.
    NumberArray(const pybind11::object& numbers, std::initializer_list<pybind11::ssize_t> columns,
                const char* what);

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] std::size_t columns() const { return columns_; }
    [[nodiscard]] bool single() const { return single_; }
    /// The shape without the last dimension.
    [[nodiscard]] const std::vector<pybind11::ssize_t>& shape() const { return shape_; }
    [[nodiscard]] double at(std::size_t row, std::size_t column) const {
        const std::size_t i = row * columns_ + column;
        return single_ ? double(static_cast<const float*>(data_)[i])
                       : static_cast<const double*>(data_)[i];
    }
    [[nodiscard]] Vec3 vector(std::size_t row, std::size_t column) const {
        return {at(row, column), at(row, column + 1), at(row, column + 2)};
    }
    [[nodiscard]] const void* data() const { return data_; }

  private:
    pybind11::array array_;  ///< owns the numbers
    const void* data_ = nullptr;
    std::size_t count_ = 1, columns_ = 0;
    bool single_ = false;
    std::vector<pybind11::ssize_t> shape_;
};

class RayArray {
  public:
    explicit RayArray(const pybind11::object& rays) : numbers_(rays, {6, 8}, "rays") {}

    [[nodiscard]] std::size_t count() const { return numbers_.count(); }
    [[nodiscard]] bool single() const { return numbers_.single(); }
    [[nodiscard]] const std::vector<pybind11::ssize_t>& shape() const { return numbers_.shape(); }
    /// True if the array has the layout of `Ray` (float64, (..., 8), aligned). The rays are then
    /// traced in place.
    [[nodiscard]] bool in_place() const;
    /// The rays of a range: those of the array itself, or converted into `scratch`.
    [[nodiscard]] std::span<const Ray> rays(std::size_t begin, std::size_t end,
                                            std::vector<Ray>& scratch) const;

  private:
    NumberArray numbers_;
};

}  // namespace alhazen::python

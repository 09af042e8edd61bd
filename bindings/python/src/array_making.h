#pragma once
/// New numpy arrays of a given shape, and access to their elements.

#include <pybind11/numpy.h>

#include <cstddef>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen::python {

using Shape = std::vector<pybind11::ssize_t>;

/// An array of float32 or float64, written as double.
class RealArray {
  public:
    RealArray() = default;
    /// `columns`: size of an additional last dimension; 0: none.
    RealArray(bool single, Shape shape, pybind11::ssize_t columns) : single_(single) {
        if (columns > 0) shape.push_back(columns);
        if (single) {
            array_ = pybind11::array_t<float>(shape);
        } else {
            array_ = pybind11::array_t<double>(shape);
        }
        data_ = array_.mutable_data();
    }
    [[nodiscard]] explicit operator bool() const { return data_ != nullptr; }
    void set(std::size_t i, double value) const {
        if (single_) {
            static_cast<float*>(data_)[i] = static_cast<float>(value);
        } else {
            static_cast<double*>(data_)[i] = value;
        }
    }
    void set(std::size_t i, const Vec3& v) const {
        for (int k = 0; k < 3; ++k) set(3 * i + static_cast<std::size_t>(k), v[k]);
    }
    [[nodiscard]] const pybind11::array& array() const { return array_; }

  private:
    pybind11::array array_;
    void* data_ = nullptr;
    bool single_ = false;
};

template <class T>
class PlainArray {
  public:
    PlainArray() = default;
    explicit PlainArray(const Shape& shape) : array_(shape), data_(array_.mutable_data()) {}
    [[nodiscard]] explicit operator bool() const { return data_ != nullptr; }
    T& operator[](std::size_t i) const { return data_[i]; }
    [[nodiscard]] T* data() const { return data_; }
    [[nodiscard]] const pybind11::array_t<T>& array() const { return array_; }

  private:
    pybind11::array_t<T> array_;
    T* data_ = nullptr;
};

/// A one-dimensional shape.
[[nodiscard]] inline Shape length(std::size_t count) {
    return {static_cast<pybind11::ssize_t>(count)};
}

}  // namespace alhazen::python

#include "ray_array.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "alhazen/base/error.h"

namespace py = pybind11;

namespace alhazen::python {

namespace {

template <class Real>
using Plain = py::array_t<Real, py::array::c_style>;

/// A copy of an array of any layout and byte order.
template <class Real>
py::array copy_of(const py::object& numbers, const char* what) {
    try {
        return py::array_t<Real, py::array::c_style | py::array::forcecast>(numbers);
    } catch (const py::error_already_set& error) {
        if (error.matches(PyExc_MemoryError)) {
            throw Error(ErrorKind::Resource,
                        std::string(what) + ": no memory for a contiguous copy of the array");
        }
        throw Error(ErrorKind::Usage, std::string(what) + ": expected an array of numbers");
    }
}

/// Throws unless the items are real numbers, or Python's objects, whose conversion may fail later.
void check_numbers(const py::array& array, const char* what) {
    const char kind = array.dtype().kind();
    if (kind == 'c') throw Error(ErrorKind::Usage, std::string(what) + ": expected real numbers");
    if (std::string_view("fiubO").find(kind) == std::string_view::npos) {
        throw Error(ErrorKind::Usage, std::string(what) + ": expected an array of numbers");
    }
}

/// The array itself if it is contiguous and float32 or float64, else a copy as float64.
py::array as_plain(const py::object& numbers, const char* what) {
    refuse_masked(numbers, what);
    if (py::isinstance<py::array>(numbers)) {
        const auto array = py::reinterpret_borrow<py::array>(numbers);
        if (py::isinstance<Plain<float>>(array) || py::isinstance<Plain<double>>(array))
            return array;
        check_numbers(array, what);
        if (array.dtype().kind() == 'f' && array.itemsize() == sizeof(float)) {
            return copy_of<float>(array, what);
        }
        return copy_of<double>(array, what);
    }
    const py::array array = py::array::ensure(numbers);
    if (!array) PyErr_Clear();  // copy_of reports it
    if (array) check_numbers(array, what);
    return copy_of<double>(array ? py::object(array) : numbers, what);
}

std::string shape_text(const py::array& array) {
    std::string text = "(";
    for (py::ssize_t k = 0; k < array.ndim(); ++k) {
        text += (k > 0 ? ", " : "") + std::to_string(array.shape(k));
    }
    return text + (array.ndim() == 1 ? ",)" : ")");
}

}  // namespace

void refuse_masked(const py::object& numbers, const char* what) {
    if (!py::isinstance<py::array>(numbers) || !py::hasattr(numbers, "_mask")) return;
    if (!py::module_::import("numpy.ma").attr("is_masked")(numbers).cast<bool>()) return;
    throw Error(ErrorKind::Usage, std::string(what) +
                                      ": some numbers are masked; expected an array without a "
                                      "mask, as of numpy.ma.filled");
}

NumberArray::NumberArray(const py::object& numbers, std::initializer_list<py::ssize_t> columns,
                         const char* what)
    : array_(as_plain(numbers, what)) {
    const py::ssize_t dimensions = array_.ndim();
    const py::ssize_t last = dimensions > 0 ? array_.shape(dimensions - 1) : 0;
    if (std::find(columns.begin(), columns.end(), last) == columns.end()) {
        std::string expected;
        for (const py::ssize_t c : columns) {
            expected += (expected.empty() ? "(..., " : " or (..., ") + std::to_string(c) + ")";
        }
        throw Error(ErrorKind::Usage, std::string(what) + ": expected the shape " + expected +
                                          ", found " + shape_text(array_));
    }
    columns_ = static_cast<std::size_t>(last);
    for (py::ssize_t k = 0; k + 1 < dimensions; ++k) {
        shape_.push_back(array_.shape(k));
        count_ *= static_cast<std::size_t>(array_.shape(k));
    }
    single_ = py::isinstance<py::array_t<float>>(array_);
    data_ = array_.data();
}

bool RayArray::in_place() const {
    return !numbers_.single() && numbers_.columns() == 8 &&
           reinterpret_cast<std::uintptr_t>(numbers_.data()) % alignof(Ray) == 0;
}

std::span<const Ray> RayArray::rays(std::size_t begin, std::size_t end,
                                    std::vector<Ray>& scratch) const {
    if (in_place()) {
        return {reinterpret_cast<const Ray*>(numbers_.data()) + begin, end - begin};
    }
    scratch.resize(end - begin);
    const bool limits = numbers_.columns() == 8;
    for (std::size_t i = begin; i < end; ++i) {
        Ray& ray = scratch[i - begin];
        ray.origin = numbers_.vector(i, 0);
        ray.direction = numbers_.vector(i, 3);
        ray.t_min = limits ? numbers_.at(i, 6) : 0.0;
        ray.t_max = limits ? numbers_.at(i, 7) : std::numeric_limits<double>::infinity();
    }
    return scratch;
}

}  // namespace alhazen::python

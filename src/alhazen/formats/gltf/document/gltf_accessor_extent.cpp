#include "alhazen/formats/gltf/document/gltf_accessor_extent.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "alhazen/formats/gltf/document/gltf_accessors.h"

namespace alhazen::gltf {

namespace {

/// Extent of one column of `rows` components; constant `rows` lets the compiler unroll the loop.
template <class T, std::size_t rows>
bool widen(const char* from, std::size_t stride, std::uint64_t count, T* min, T* max) {
    std::array<T, rows> lo, hi;
    std::copy_n(min, rows, lo.begin());
    std::copy_n(max, rows, hi.begin());
    T sum = 0;  // of x - x: nonzero if a component is NaN or infinite
    for (std::uint64_t i = 0; i < count; ++i, from += stride) {
        std::array<T, rows> value;
        std::memcpy(value.data(), from, sizeof(value));
        for (std::size_t row = 0; row < rows; ++row) {
            lo[row] = value[row] < lo[row] ? value[row] : lo[row];
            hi[row] = hi[row] < value[row] ? value[row] : hi[row];
            if constexpr (std::is_floating_point_v<T>) sum += value[row] - value[row];
        }
    }
    std::copy_n(lo.begin(), rows, min);
    std::copy_n(hi.begin(), rows, max);
    return sum == 0;
}

template <class T>
Extent extent_as(const Document& document, const Accessor& accessor) {
    const ElementLayout layout = layout_of(accessor.component, accessor.type);
    std::array<T, 16> min, max;
    min.fill(std::is_floating_point_v<T> ? std::numeric_limits<T>::infinity()
                                         : std::numeric_limits<T>::max());
    max.fill(std::is_floating_point_v<T> ? -std::numeric_limits<T>::infinity()
                                         : std::numeric_limits<T>::lowest());
    bool finite = true;
    constexpr std::array<T, 16> kZeros{};
    each_run(document, accessor, [&](const ElementRun& run) {
        const bool zeros = run.data == nullptr;
        const std::uint64_t count = zeros ? 1 : run.count;
        for (std::size_t column = 0; column < layout.columns; ++column) {
            const char* from = zeros ? reinterpret_cast<const char*>(kZeros.data())
                                     : run.data + column * layout.column_stride;
            T* lo = min.data() + column * layout.rows;
            T* hi = max.data() + column * layout.rows;
            bool good = true;
            switch (layout.rows) {
                case 1:
                    good = widen<T, 1>(from, run.stride, count, lo, hi);
                    break;
                case 2:
                    good = widen<T, 2>(from, run.stride, count, lo, hi);
                    break;
                case 3:
                    good = widen<T, 3>(from, run.stride, count, lo, hi);
                    break;
                default:
                    good = widen<T, 4>(from, run.stride, count, lo, hi);
                    break;
            }
            finite = finite && good;
        }
    });
    Extent extent;
    extent.is_finite = finite;
    std::copy(min.begin(), min.end(), extent.min.begin());
    std::copy(max.begin(), max.end(), extent.max.begin());
    return extent;
}

}  // namespace

Extent extent_of(const Document& document, const Accessor& accessor) {
    switch (accessor.component) {
        case ComponentType::Byte:
            return extent_as<std::int8_t>(document, accessor);
        case ComponentType::UnsignedByte:
            return extent_as<std::uint8_t>(document, accessor);
        case ComponentType::Short:
            return extent_as<std::int16_t>(document, accessor);
        case ComponentType::UnsignedShort:
            return extent_as<std::uint16_t>(document, accessor);
        case ComponentType::UnsignedInt:
            return extent_as<std::uint32_t>(document, accessor);
        case ComponentType::Float:
            break;
    }
    return extent_as<float>(document, accessor);
}

}  // namespace alhazen::gltf

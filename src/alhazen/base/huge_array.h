#pragma once
/// Uninitialised arrays of plain values in large pages.

#include <cstddef>
#include <memory>
#include <type_traits>

#include "alhazen/base/huge_pages.h"

namespace alhazen {

/// Frees the memory of a HugeArray.
template <class T>
struct HugeArrayDelete {
    std::size_t size = 0;
    void operator()(T* memory) const { HugePageAllocator<T>().deallocate(memory, size); }
};

/// Memory for values that are written before they are read.
template <class T>
using HugeArray = std::unique_ptr<T[], HugeArrayDelete<T>>;

/// Leaves the memory uninitialised. Throws std::bad_alloc.
template <class T>
[[nodiscard]] HugeArray<T> make_huge_array(std::size_t size) {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
    return HugeArray<T>(HugePageAllocator<T>().allocate(size), HugeArrayDelete<T>{size});
}

}  // namespace alhazen

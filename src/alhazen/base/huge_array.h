#pragma once
/// Arrays of plain values in large pages, which nobody sets before they are used.

#include <cstddef>
#include <memory>
#include <type_traits>

#include "alhazen/base/huge_pages.h"

namespace alhazen {

/// Gives back the memory of a HugeArray.
template <class T>
struct HugeArrayDelete {
    std::size_t size = 0;
    void operator()(T* memory) const { HugePageAllocator<T>().deallocate(memory, size); }
};

/// Room for values that are written before they are read.
template <class T>
using HugeArray = std::unique_ptr<T[], HugeArrayDelete<T>>;

/// Nothing is done to the memory. Throws std::bad_alloc.
template <class T>
[[nodiscard]] HugeArray<T> make_huge_array(std::size_t size) {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
    return HugeArray<T>(HugePageAllocator<T>().allocate(size), HugeArrayDelete<T>{size});
}

}  // namespace alhazen

#pragma once
/// Zeros in pages that the system clears when they are first touched: a large container is made at
/// once, and the threads that fill it share the work of clearing it.

#include <cstddef>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

#include "alhazen/base/huge_pages.h"

namespace alhazen {

/// Zeros that the system clears in large pages when they are first touched, by any thread. Throws
/// std::bad_alloc.
[[nodiscard]] void* map_zeros(std::size_t bytes);
void unmap_zeros(void* memory, std::size_t bytes);

/// Allocator for containers of values whose default is all zero bits, which are sized once: large
/// ones are not touched by the thread that makes them. Small blocks stay in the heap, which has
/// pages that were cleared before.
template <class T>
struct ZeroPageAllocator {
    using value_type = T;
    static constexpr std::size_t kMapped = std::size_t{16} << 20;

    ZeroPageAllocator() = default;
    template <class U>
    explicit ZeroPageAllocator(const ZeroPageAllocator<U>&) {}

    [[nodiscard]] T* allocate(std::size_t n) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (is_mapped(n)) return static_cast<T*>(map_zeros(n * sizeof(T)));
        T* const memory = HugePageAllocator<T>().allocate(n);
        std::memset(static_cast<void*>(memory), 0, n * sizeof(T));
        return memory;
    }
    void deallocate(T* memory, std::size_t n) {
        if (is_mapped(n)) return unmap_zeros(memory, n * sizeof(T));
        HugePageAllocator<T>().deallocate(memory, n);
    }
    /// A value by default is there already.
    void construct(T*) {}
    template <class... Args>
    void construct(T* at, Args&&... args) {
        ::new (static_cast<void*>(at)) T(std::forward<Args>(args)...);
    }
    friend bool operator==(const ZeroPageAllocator&, const ZeroPageAllocator&) { return true; }

  private:
    static bool is_mapped(std::size_t n) {
        if (n > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_array_new_length();
        return n * sizeof(T) >= kMapped;
    }
};

}  // namespace alhazen

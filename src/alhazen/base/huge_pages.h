#pragma once
/// Memory in large pages where the system provides them; ordinary memory elsewhere. Data read at
/// random, such as a tree traversed by rays, then avoids a page walk at almost every step.

#include <cstddef>
#include <cstdlib>
#include <new>
#include <span>
#include <vector>

namespace alhazen {

inline constexpr std::size_t kHugePageBytes = std::size_t{2} << 20;

/// Requests large pages for memory that has not been touched.
void prefer_huge_pages(void* memory, std::size_t bytes);
/// Moves memory in use to large pages, where whole large pages lie inside it.
void collapse_to_huge_pages(const void* memory, std::size_t bytes);
template <class T>
void collapse_to_huge_pages(std::span<T> values) {
    collapse_to_huge_pages(values.data(), values.size_bytes());
}

/// A block of at least one large page begins with one; others are aligned as they must be. Throws
/// std::bad_alloc.
[[nodiscard]] void* allocate_pages(std::size_t bytes, std::size_t alignment);
/// Frees a block of allocate_pages of the same size and alignment.
void free_pages(void* memory, std::size_t bytes, std::size_t alignment);

/// Allocator for large containers, by allocate_pages.
template <class T>
struct HugePageAllocator {
    using value_type = T;
    HugePageAllocator() = default;
    template <class U>
    explicit HugePageAllocator(const HugePageAllocator<U>&) {}

    [[nodiscard]] T* allocate(std::size_t n) {
        if (n > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_array_new_length();
        return static_cast<T*>(allocate_pages(n * sizeof(T), alignof(T)));
    }
    void deallocate(T* memory, std::size_t n) { free_pages(memory, n * sizeof(T), alignof(T)); }
    friend bool operator==(const HugePageAllocator&, const HugePageAllocator&) { return true; }
};

template <class T>
using HugeVector = std::vector<T, HugePageAllocator<T>>;

}  // namespace alhazen

#include "alhazen/base/zero_pages.h"

#include <cstdint>
#include <cstdlib>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace alhazen {

#ifdef __linux__
namespace {

/// Rounded up; `bytes` is at most half of the address space.
std::size_t whole_pages(std::size_t bytes) {
    return (bytes + kHugePageBytes - 1) & ~(kHugePageBytes - 1);
}

}  // namespace
#endif

void* map_zeros(std::size_t bytes) {
#ifdef __linux__
    // Whole large pages, aligned to one: the ends of a larger mapping are given back.
    const std::size_t whole = whole_pages(bytes);
    void* const mapped = mmap(nullptr, whole + kHugePageBytes, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapped == MAP_FAILED) throw std::bad_alloc();
    auto* const begin = static_cast<std::byte*>(mapped);
    const std::size_t before =
        (kHugePageBytes - reinterpret_cast<std::uintptr_t>(begin) % kHugePageBytes) %
        kHugePageBytes;
    if (before > 0) (void)munmap(begin, before);
    (void)munmap(begin + before + whole, kHugePageBytes - before);
    prefer_huge_pages(begin + before, whole);
    return begin + before;
#else
    void* const memory = std::calloc(bytes, 1);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
#endif
}

void unmap_zeros(void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
    (void)munmap(memory, whole_pages(bytes));
#else
    std::free(memory);
#endif
}

}  // namespace alhazen

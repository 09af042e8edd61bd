#include "alhazen/base/heap.h"

#include <cstdlib>

#include "alhazen/base/huge_pages.h"

#ifdef __GLIBC__
#include <malloc.h>
#include <unistd.h>
#endif

namespace alhazen {

void prepare_heap() {
#ifdef __GLIBC__
    constexpr int kHeapBytes = 64 << 20, kDefaultPad = 128 << 10;
    // Larger blocks have mappings of their own, which are unmapped when they are freed.
    (void)mallopt(M_MMAP_THRESHOLD, 16 << 20);
    (void)mallopt(M_TRIM_THRESHOLD, 2 * kHeapBytes);
    (void)mallopt(M_TOP_PAD, kHeapBytes);
    auto* const before = static_cast<std::byte*>(sbrk(0));
    void* volatile block =
        std::malloc(kDefaultPad);  // volatile: keeps the compiler from removing both calls
    std::free(block);
    (void)mallopt(M_TOP_PAD, kDefaultPad);
    auto* const end = static_cast<std::byte*>(sbrk(0));
    // The break stays where it is if the heap has other memory, or may not grow.
    if (end > before) prefer_huge_pages(before, static_cast<std::size_t>(end - before));
#endif
}

void use_one_heap() {
#ifdef __GLIBC__
    (void)mallopt(M_ARENA_MAX, 1);
#endif
}

}  // namespace alhazen

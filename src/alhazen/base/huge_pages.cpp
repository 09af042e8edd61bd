#include "alhazen/base/huge_pages.h"

#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace alhazen {
namespace {

#ifdef __linux__
/// Calls madvise for the whole large pages in a range; ignores a refusal by the system.
void advise(const void* memory, std::size_t bytes, int advice) {
    const auto begin = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t first = (begin + kHugePageBytes - 1) & ~(kHugePageBytes - 1);
    const std::uintptr_t last = (begin + bytes) & ~(kHugePageBytes - 1);
    if (first >= last) return;
    (void)madvise(reinterpret_cast<void*>(first), last - first, advice);
}
#endif

}  // namespace

void prefer_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    advise(memory, bytes, MADV_HUGEPAGE);
#endif
}

void collapse_to_huge_pages([[maybe_unused]] const void* memory,
                            [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
#ifndef MADV_COLLAPSE
    constexpr int MADV_COLLAPSE = 25;  // Linux 6.1; older systems refuse it
#endif
    advise(memory, bytes, MADV_HUGEPAGE);
    advise(memory, bytes, MADV_COLLAPSE);
#endif
}

}  // namespace alhazen

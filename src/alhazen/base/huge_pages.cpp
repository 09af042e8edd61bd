#include "alhazen/base/huge_pages.h"

#include <cstdint>
#include <cstring>

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

/// The alignment of a block, or 0 if the C library has it anyway. The library itself takes more
/// than an aligned block needs and returns the rest: the hole that a block leaves does not fit the
/// next one of the same size, and the heap grows. So a block keeps one step more, and before its
/// first byte the address to free.
std::size_t step_of(std::size_t bytes, std::size_t alignment) {
    if (bytes >= kHugePageBytes) return kHugePageBytes;
    return alignment > __STDCPP_DEFAULT_NEW_ALIGNMENT__ ? alignment : 0;
}

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

void* allocate_pages(std::size_t bytes, std::size_t alignment) {
    const std::size_t step = step_of(bytes, alignment);
    if (step == 0) return ::operator new(bytes);
    if (bytes > static_cast<std::size_t>(-1) / 2) throw std::bad_alloc();
    void* const whole = ::operator new(bytes + step);
    // `whole` has the alignment of a pointer, and less than that of a step.
    const std::size_t past = reinterpret_cast<std::uintptr_t>(whole) % step;
    auto* const memory = static_cast<std::byte*>(whole) + (step - past);
    std::memcpy(memory - sizeof(whole), &whole, sizeof(whole));
    if (step == kHugePageBytes) prefer_huge_pages(memory, bytes);
    return memory;
}

void free_pages(void* memory, std::size_t bytes, std::size_t alignment) {
    if (step_of(bytes, alignment) == 0 || memory == nullptr) return ::operator delete(memory);
    void* whole = nullptr;
    std::memcpy(&whole, static_cast<std::byte*>(memory) - sizeof(whole), sizeof(whole));
    ::operator delete(whole);
}

}  // namespace alhazen

#include "alhazen/parallel/touch_pages.h"

#include "alhazen/parallel/parallel.h"

namespace alhazen {

void touch_pages(void* memory, std::size_t bytes) {
    constexpr std::size_t kPageBytes = 4096;
    constexpr std::size_t kAtOnce = std::size_t{2} << 20;
    // Less memory is not worth a task.
    if (bytes < 2 * kAtOnce) return;
    auto* const first = static_cast<volatile std::byte*>(memory);
    parallel_for(bytes, kAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; i += kPageBytes) first[i] = std::byte{0};
    });
}

}  // namespace alhazen

#pragma once
/// An interruptible std::sort (interruption.h). After an interruption the order of the items is
/// unspecified.

#include <algorithm>
#include <cstdint>

#include "alhazen/base/interruption.h"

namespace alhazen {

template <class Iterator, class Less>
void interruptible_sort(Iterator begin, Iterator end, Less less) {
    constexpr std::uint32_t kOften = 1u << 16;  // comparisons: below a millisecond
    std::uint32_t count = 0;
    std::sort(begin, end, [&](const auto& a, const auto& b) {
        if (++count % kOften == 0) interruption_point();
        return less(a, b);
    });
}

}  // namespace alhazen

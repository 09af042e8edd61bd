#pragma once
/// How much a test tries: a part of its cases every day, all of them before a release.
///
/// The entries NAME_thorough of CTest, labelled `heavy`, set ALHAZEN_TEST_THOROUGH=1. Tolerances
/// and confidence are those of every day; only cases are more
/// (docs/design/build.md#entries-of-ctest).

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace alhazen::testing {

/// Whether all cases are tried.
inline bool thorough() {
    static const bool all = [] {
        const char* value = std::getenv("ALHAZEN_TEST_THOROUGH");
        return value != nullptr && std::string_view(value) == "1";
    }();
    return all;
}

/// The number of cases to try.
inline int cases(int every_day, int all) {
    return thorough() ? all : every_day;
}

/// Whether to try case `index` of a list: every day one of `divisor`, beginning with `first`.
inline bool is_tried(std::size_t index, std::size_t divisor, std::size_t first = 0) {
    return thorough() || index % divisor == first % divisor;
}

/// All of a list, or every day one of `divisor`.
template <class T>
std::vector<T> tried_of(const std::vector<T>& list, std::size_t divisor) {
    std::vector<T> some;
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (is_tried(i, divisor)) some.push_back(list[i]);
    }
    return some;
}

/// A number that depends on the name alone: which of its cases a thing tries every day.
inline std::size_t number_of(std::string_view name) {
    std::uint64_t hash = 14695981039346656037u;  // FNV-1a
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
    return static_cast<std::size_t>(hash >> 33);
}

/// What is compared in the scene `name`: `all`, or every day the first and one other.
inline std::vector<std::string> to_compare(const std::vector<std::string>& all,
                                           std::string_view name) {
    if (thorough() || all.size() < 3) return all;
    return {all.front(), all[1 + number_of(name) % (all.size() - 1)]};
}

}  // namespace alhazen::testing

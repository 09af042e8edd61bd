#pragma once
/// Storage for a value that is constructed on assignment. An InlineVector of these constructs only
/// the values in use.

#include <type_traits>

namespace alhazen {

template <class T>
requires std::is_trivially_copyable_v<T>
union Unmade {
    Unmade() {}                                  // NOLINT(modernize-use-equals-default): is deleted
    Unmade(const T& given) : value(given) {}     // NOLINT(google-explicit-constructor)
    operator const T&() const { return value; }  // NOLINT(google-explicit-constructor)

    T value;
};

}  // namespace alhazen

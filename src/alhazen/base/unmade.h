#pragma once
/// Room for a value that is made when it is assigned: an InlineVector of these costs the values in
/// use alone, where a default T costs time.

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

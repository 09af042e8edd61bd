#pragma once
/// Declares the fields of a shape: name, member, unit and check of each. The native reader and
/// writer, validation, comparison and the random shapes of the tests are derived from them.
///
/// A shape lists its describing fields, without derived ones, in the order of its file format:
///
///     static constexpr auto kFields =
///         std::make_tuple(field("center", &Sphere::center, Unit::Point, Check::Point),
///                         field("radius", &Sphere::radius, Unit::Length, Check::Length));

#include <cstdint>
#include <tuple>
#include <type_traits>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The quantity of a field.
enum class Unit : std::uint8_t {
    Point,      ///< position, scene units
    Vector,     ///< vector with a length, scene units
    Direction,  ///< vector of any length
    Length,     ///< scene units
    Number,     ///< without unit: ratio, exponent, coefficient
    Count,      ///< number or index of elements
    Flag,       ///< true or false
    Text,       ///< expression
    Compound,   ///< list or struct with a textual form of its own
};

/// The valid values of a field. Magnitudes: kMinLength to kMaxCoordinate.
enum class Check : std::uint8_t {
    None,          ///< any value of its type
    Point,         ///< finite
    Vector,        ///< finite, not zero
    Length,        ///< positive
    LengthOrZero,  ///< positive or zero
    Shape,         ///< tested by the shape's `validate`, with other fields or with its own message
};

/// One field of the shape S. An optional field is omitted from files where it has its default.
template <class S, class T>
struct Field {
    const char* name;
    T S::*member;
    Unit unit;
    Check check;
    bool optional;
};

/// True if the check tests values of type T.
template <class T>
constexpr bool applies_to(Check check) {
    switch (check) {
        case Check::Point:
        case Check::Vector:
            return std::is_same_v<T, Vec3>;
        case Check::Length:
        case Check::LengthOrZero:
            return std::is_same_v<T, double>;
        case Check::None:
        case Check::Shape:
            return true;
    }
    return false;
}

template <class S, class T>
constexpr Field<S, T> checked_field(const char* name, T S::*member, Unit unit, Check check,
                                    bool optional) {
    if (!applies_to<T>(check)) throw "the check does not apply to the type of the field";
    return {name, member, unit, check, optional};
}

/// A check that does not apply to the member's type does not compile.
template <class S, class T>
consteval Field<S, T> field(const char* name, T S::*member, Unit unit, Check check) {
    return checked_field(name, member, unit, check, false);
}
template <class S, class T>
consteval Field<S, T> optional_field(const char* name, T S::*member, Unit unit, Check check) {
    return checked_field(name, member, unit, check, true);
}

/// Calls `visit(field)` for each field of S, in order.
template <class S, class Visit>
constexpr void for_each_field(const Visit& visit) {
    std::apply([&](const auto&... fields) { (visit(fields), ...); }, S::kFields);
}

}  // namespace alhazen

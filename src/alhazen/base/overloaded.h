#pragma once
/// One function object of several lambdas, for std::visit. A lambda per alternative makes a visit
/// exhaustive: a new alternative of the variant does not compile until it has one.

namespace alhazen {

template <class... F>
struct Overloaded : F... {
    using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;  // clang 14 does not deduce this by itself

}  // namespace alhazen

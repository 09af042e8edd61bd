#pragma once
/// A function object made of several lambdas, for std::visit. One lambda per alternative makes a
/// visit exhaustive: it does not compile without one for a new alternative of the variant.

namespace alhazen {

template <class... F>
struct Overloaded : F... {
    using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;  // clang 14 does not deduce this by itself

}  // namespace alhazen

#pragma once
/// A closed range of reals; empty if `lo > hi`.

#include <algorithm>
#include <limits>

namespace alhazen {

struct Interval {
    double lo = std::numeric_limits<double>::infinity();
    double hi = -std::numeric_limits<double>::infinity();

    [[nodiscard]] bool empty() const { return !(lo <= hi); }
    [[nodiscard]] bool contains(double x) const { return lo <= x && x <= hi; }
    [[nodiscard]] double width() const { return empty() ? 0.0 : hi - lo; }
    void include(double x) {
        lo = std::min(lo, x);
        hi = std::max(hi, x);
    }
    friend bool operator==(const Interval&, const Interval&) = default;
};

inline Interval hull(const Interval& a, const Interval& b) {
    return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}
inline Interval intersection(const Interval& a, const Interval& b) {
    return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
}

}  // namespace alhazen

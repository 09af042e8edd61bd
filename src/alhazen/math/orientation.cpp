#include "alhazen/math/orientation.h"

#include <array>
#include <cstddef>

#include "alhazen/math/double_double.h"

namespace alhazen {

namespace {

DoubleDouble two_difference(double a, double b) {
    return two_sum(a, -b);
}

/// An exact sum of doubles, as non-overlapping terms in ascending order of magnitude.
class ExactSum {
  public:
    void add(double term) {
        if (term == 0.0) return;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            const DoubleDouble next = two_sum(term, terms_[i]);
            if (next.low != 0.0) terms_[kept++] = next.low;
            term = next.high;
        }
        if (term != 0.0) terms_[kept++] = term;
        size_ = kept;
    }
    void add_product(double a, double b) {
        const DoubleDouble product = two_product(a, b);
        add(product.low);
        add(product.high);
    }
    /// Adds the product of two pairs, times `sign` (1 or -1).
    void add_product(const DoubleDouble& a, const DoubleDouble& b, double sign) {
        add_product(sign * a.low, b.low);
        add_product(sign * a.low, b.high);
        add_product(sign * a.high, b.low);
        add_product(sign * a.high, b.high);
    }
    [[nodiscard]] int sign() const {
        if (size_ == 0) return 0;
        const double leading = terms_[size_ - 1];
        return int(leading > 0.0) - int(leading < 0.0);
    }

  private:
    std::array<double, 16> terms_{};  ///< 8 products of two terms each
    std::size_t size_ = 0;
};

}  // namespace

int exact_orientation(Vec2 a, Vec2 b, Vec2 c) {
    ExactSum sum;
    sum.add_product(two_difference(a.x, c.x), two_difference(b.y, c.y), 1.0);
    sum.add_product(two_difference(a.y, c.y), two_difference(b.x, c.x), -1.0);
    return sum.sign();
}

}  // namespace alhazen

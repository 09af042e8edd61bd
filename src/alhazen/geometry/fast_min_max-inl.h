/// A double whose fmin and fmax are one instruction; a fragment without a guard, included as
/// sphere_roots_formula-inl.h is.

/// Of two zeros or a NaN among the operands fmin and fmax give either, so who reads a result that
/// is one of these has to ask again (`are_plain_roots`).
struct FastMinMaxDouble {
    double x;

    friend inline FastMinMaxDouble operator-(FastMinMaxDouble a) { return {-a.x}; }
    friend inline FastMinMaxDouble operator+(FastMinMaxDouble a, FastMinMaxDouble b) {
        return {a.x + b.x};
    }
    friend inline FastMinMaxDouble operator-(FastMinMaxDouble a, FastMinMaxDouble b) {
        return {a.x - b.x};
    }
    friend inline FastMinMaxDouble operator*(FastMinMaxDouble a, FastMinMaxDouble b) {
        return {a.x * b.x};
    }
    friend inline FastMinMaxDouble operator/(FastMinMaxDouble a, FastMinMaxDouble b) {
        return {a.x / b.x};
    }
    friend inline FastMinMaxDouble sqrt(FastMinMaxDouble a) { return {std::sqrt(a.x)}; }
    friend inline FastMinMaxDouble copysign(FastMinMaxDouble a, FastMinMaxDouble b) {
        return {std::copysign(a.x, b.x)};
    }
    friend inline FastMinMaxDouble fmin(FastMinMaxDouble a, FastMinMaxDouble b) {
        return {a.x < b.x ? a.x : b.x};
    }
    friend inline FastMinMaxDouble fmax(FastMinMaxDouble a, FastMinMaxDouble b) {
        return {a.x > b.x ? a.x : b.x};
    }
};

/// Roots as far as this are left to those.
inline constexpr double kFarRoot = 0x1p1000;

/// Whether both roots are what they would be by the fmin and fmax of the library. Written so that
/// what is not finite is not plain.
inline bool are_plain_roots(double t_near, double t_far) {
    return t_near <= t_far && t_near > -kFarRoot && t_far < kFarRoot && t_near != 0.0 &&
           t_far != 0.0;
}

/// A double whose fmin and fmax are single instructions; a fragment without an include guard,
/// included like sphere_roots_formula-inl.h.

/// For two zeros or a NaN operand, fmin and fmax return either operand: a result that is zero or
/// NaN must be recomputed (`are_plain_roots`).
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

/// Magnitude beyond which roots must be recomputed.
inline constexpr double kFarRoot = 0x1p1000;

/// True if both roots equal those computed with the library's fmin and fmax. False for NaN and
/// infinity.
inline bool are_plain_roots(double t_near, double t_far) {
    return t_near <= t_far && t_near > -kFarRoot && t_far < kFarRoot && t_near != 0.0 &&
           t_far != 0.0;
}

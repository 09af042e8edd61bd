#pragma once
/// Transported light: four numbers, the radiance at four wavelengths, or colour channels (see
/// wavelengths.h).
///
/// Source: Wilkie et al., "Hero Wavelength Spectral Sampling", EGSR 2014 (four wavelengths share a
/// path).
/// Conventions: colour channels are red, green, blue, and blue again, so that the maximum of the
/// four is that of the three.

#include <algorithm>
#include <cmath>

namespace alhazen {

struct Spectrum {
    static constexpr int kCount = 4;

    double a = 0, b = 0, c = 0, d = 0;

    [[nodiscard]] static Spectrum all(double x) { return {x, x, x, x}; }

    double& operator[](int i) { return (&a)[i]; }
    const double& operator[](int i) const { return (&a)[i]; }
    friend bool operator==(const Spectrum&, const Spectrum&) = default;

    [[nodiscard]] bool is_black() const { return a == 0.0 && b == 0.0 && c == 0.0 && d == 0.0; }
    [[nodiscard]] double max() const { return std::max(std::max(a, b), std::max(c, d)); }
    [[nodiscard]] bool is_finite() const {
        return std::isfinite(a) && std::isfinite(b) && std::isfinite(c) && std::isfinite(d);
    }
};

inline Spectrum operator+(const Spectrum& x, const Spectrum& y) {
    return {x.a + y.a, x.b + y.b, x.c + y.c, x.d + y.d};
}
inline Spectrum operator-(const Spectrum& x, const Spectrum& y) {
    return {x.a - y.a, x.b - y.b, x.c - y.c, x.d - y.d};
}
inline Spectrum operator*(const Spectrum& x, const Spectrum& y) {
    return {x.a * y.a, x.b * y.b, x.c * y.c, x.d * y.d};
}
inline Spectrum operator*(double s, const Spectrum& x) {
    return {s * x.a, s * x.b, s * x.c, s * x.d};
}
inline Spectrum operator*(const Spectrum& x, double s) {
    return s * x;
}
inline Spectrum& operator+=(Spectrum& x, const Spectrum& y) {
    return x = x + y;
}

/// Beer's law: exp(-absorption * distance); 1 for absorption 0 at any distance.
[[nodiscard]] inline Spectrum transmittance(const Spectrum& absorption, double distance) {
    const auto of = [&](double x) { return x > 0.0 ? std::exp(-x * distance) : 1.0; };
    const double c = of(absorption.c);
    return {of(absorption.a), of(absorption.b), c,
            absorption.d == absorption.c ? c : of(absorption.d)};
}

}  // namespace alhazen

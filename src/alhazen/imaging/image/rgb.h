#pragma once
/// A linear colour or radiance of three channels, in double.

#include <algorithm>
#include <cmath>

namespace alhazen {

struct Rgb {
    double r = 0, g = 0, b = 0;

    double& operator[](int channel) { return (&r)[channel]; }
    const double& operator[](int channel) const { return (&r)[channel]; }
    friend bool operator==(const Rgb&, const Rgb&) = default;

    [[nodiscard]] bool is_black() const { return r == 0.0 && g == 0.0 && b == 0.0; }
    [[nodiscard]] double max() const { return std::max(r, std::max(g, b)); }
    [[nodiscard]] bool is_finite() const {
        return std::isfinite(r) && std::isfinite(g) && std::isfinite(b);
    }
};

/// The same value in all channels.
inline Rgb grey(double value) {
    return {value, value, value};
}

inline Rgb operator+(const Rgb& a, const Rgb& b) {
    return {a.r + b.r, a.g + b.g, a.b + b.b};
}
inline Rgb operator-(const Rgb& a, const Rgb& b) {
    return {a.r - b.r, a.g - b.g, a.b - b.b};
}
inline Rgb operator*(const Rgb& a, const Rgb& b) {
    return {a.r * b.r, a.g * b.g, a.b * b.b};
}
inline Rgb operator*(double s, const Rgb& a) {
    return {s * a.r, s * a.g, s * a.b};
}
inline Rgb operator*(const Rgb& a, double s) {
    return s * a;
}
inline Rgb& operator+=(Rgb& a, const Rgb& b) {
    return a = a + b;
}

/// A colour with alpha.
struct Rgba {
    double r = 0, g = 0, b = 0, a = 1;

    friend bool operator==(const Rgba&, const Rgba&) = default;

    [[nodiscard]] Rgb rgb() const { return {r, g, b}; }
    [[nodiscard]] bool is_finite() const { return rgb().is_finite() && std::isfinite(a); }
};

inline Rgba operator+(const Rgba& x, const Rgba& y) {
    return {x.r + y.r, x.g + y.g, x.b + y.b, x.a + y.a};
}
inline Rgba operator*(double s, const Rgba& x) {
    return {s * x.r, s * x.g, s * x.b, s * x.a};
}
inline Rgba& operator+=(Rgba& x, const Rgba& y) {
    return x = x + y;
}

}  // namespace alhazen

#include "alhazen/shading/optics/polarization.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

/// Imaginary with a positive factor beyond the critical angle: the wave behind decays.
std::complex<double> cosine_behind(double c, double eta) {
    const double squared = 1.0 - eta * eta * (1.0 - c * c);
    if (squared >= 0.0) return std::sqrt(squared);
    return {0.0, std::sqrt(-squared)};
}

}  // namespace

FresnelAmplitudes dielectric_reflection(double cosine, double eta) {
    const double c = std::clamp(cosine, 0.0, 1.0);
    const std::complex<double> behind = cosine_behind(c, eta);
    const std::complex<double> across = eta * c + behind, along = c + eta * behind;
    // Both are 0 only at grazing incidence at the critical angle.
    if (std::norm(across) == 0.0 || std::norm(along) == 0.0) return {-1.0, 1.0};
    return {(eta * c - behind) / across, (c - eta * behind) / along};
}

FresnelAmplitudes dielectric_refraction(double cosine, double eta) {
    const double c = std::clamp(cosine, 0.0, 1.0);
    const std::complex<double> behind = cosine_behind(c, eta);
    if (behind.imag() != 0.0) return {};
    const double across = eta * c + behind.real(), along = c + eta * behind.real();
    if (!(across > 0.0 && along > 0.0)) return {};
    return {2.0 * eta * c / across, 2.0 * eta * c / along};
}

FresnelAmplitudes conductor_reflection(double cosine, double n, double k) {
    const double c = std::clamp(cosine, 0.0, 1.0);
    const std::complex<double> squared = std::complex<double>(n, k) * std::complex<double>(n, k);
    // The index times the cosine behind.
    const std::complex<double> w = std::sqrt(squared - (1.0 - c * c));
    const std::complex<double> across = c + w, along = squared * c + w;
    if (std::norm(across) == 0.0 || std::norm(along) == 0.0) return {-1.0, 1.0};
    return {(c - w) / across, (squared * c - w) / along};
}

BoundaryMueller mueller_of(const FresnelAmplitudes& amplitudes) {
    const double across = std::norm(amplitudes.across), along = std::norm(amplitudes.along);
    const double sum = across + along;
    if (!(sum > 0.0)) return {0.0, 1.0, 1.0, 0.0};
    const std::complex<double> both = amplitudes.across * std::conj(amplitudes.along);
    return {(across - along) / sum, 1.0, 2.0 * both.real() / sum, 2.0 * both.imag() / sum};
}

}  // namespace alhazen

#pragma once
/// Polarisation by a boundary: Fresnel's complex amplitudes, and their Mueller matrix in the frame
/// of the plane of incidence.
///
/// Source: Born and Wolf, "Principles of Optics", 7th edition, 1999, sections 1.5.2 and 1.5.4
/// (equations 20, 21, 54: amplitudes, total reflection) and 14.2 (metals); Collett, "Polarized
/// Light", 1993, chapters 5 and 8 (the matrices of reflection and refraction); Wilkie and Weidlich,
/// "Polarised Light in Computer Graphics", SIGGRAPH Asia 2012 courses.
/// Conventions: fields vary as exp(-i w t), so that a metal has the index n + i k. The frame of a
/// ray along k has x across the plane of incidence, the same before and after, and y = k x x in it.
/// Stokes vectors (I, Q, U, V): Q is light along x less light along y, U the same along the lines
/// at 45 and 135 degrees from x towards y, V = -2 Im(Ex conj(Ey)).

#include <complex>

namespace alhazen {

/// Amplitude ratios of the outgoing to the incoming field.
struct FresnelAmplitudes {
    std::complex<double> across, along;  ///< relative to the plane of incidence
};

/// A Mueller matrix divided by its first element:
///     1 q 0 0
///     q d 0 0
///     0 0 c e
///     0 0 -e c
/// d = 1 if nothing is depolarised; all 0: full depolarisation.
struct BoundaryMueller {
    double q = 0, d = 0, c = 0, e = 0;
};

/// Amplitudes for a cosine of 0..1 (clamped) to the normal; `eta` is the index on the side of the
/// ray over that behind.
[[nodiscard]] FresnelAmplitudes dielectric_reflection(double cosine, double eta);
/// Amplitudes of the refracted light; 0 beyond the critical angle.
[[nodiscard]] FresnelAmplitudes dielectric_refraction(double cosine, double eta);
/// Amplitudes of a conductor with index `n + i k` relative to the medium of the ray.
[[nodiscard]] FresnelAmplitudes conductor_reflection(double cosine, double n, double k);

/// The Mueller matrix; the identity if both amplitudes are 0.
[[nodiscard]] BoundaryMueller mueller_of(const FresnelAmplitudes& amplitudes);

}  // namespace alhazen

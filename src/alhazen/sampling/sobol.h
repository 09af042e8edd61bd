#pragma once
/// Points of Sobol's sequence, plain and randomly scrambled: sums over them converge faster than
/// over independent points, and several scramblings give an error estimate.
///
/// Source: Sobol', "On the Distribution of Points in a Cube ...", USSR Comp. Math. 7(4), 1967; Joe
/// and Kuo, "Constructing Sobol Sequences with Better Two-Dimensional Projections", SIAM J. Sci.
/// Comput. 30(5), 2008 (direction numbers); Owen, "Randomly Permuted (t,m,s)-Nets and
/// (t,s)-Sequences", 1995 (nested uniform scrambling).
/// Differs: uses Owen's scrambling itself instead of a common substitute: the flips of six
/// successive digits are the bits of one hash of the digits above them, and the digits below the
/// 30th are random for each point.
/// Conventions: points 0, 1, 2, ... 2^30 - 1; coordinates in [0, 1), multiples of 2^-53. A
/// scrambled point is uniform in the cube, and its coordinates depend only on (key, dimension,
/// index). The first 2^m points are a net for every m, so a sum may be continued by doubling the
/// number of points.

#include <cstdint>

namespace alhazen {

inline constexpr int kSobolDimensions = 16;
inline constexpr std::uint32_t kMaxSobolPoints = std::uint32_t{1} << 30;

/// The first 32 binary digits of a coordinate; the highest digit is the first.
/// Preconditions: 0 <= dimension < kSobolDimensions, index < kMaxSobolPoints.
[[nodiscard]] std::uint32_t sobol_digits(std::uint32_t index, int dimension);

/// A coordinate of the sequence scrambled with `key`.
[[nodiscard]] double scrambled_sobol(std::uint64_t key, std::uint32_t index, int dimension);

}  // namespace alhazen

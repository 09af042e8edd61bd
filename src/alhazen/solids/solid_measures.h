#pragma once
/// Volume, area, centroid and moments of a solid from lines through it, with 95 % confidence
/// intervals.
///
/// Source: Press and Farrar, "Recursive Stratified Sampling for Multidimensional Monte Carlo
/// Integration", Computers in Physics 4, 1990 (cells where the integrand varies are cut);
/// Hammersley and Morton, "A New Monte Carlo Technique: Antithetic Variates", 1956; Lavenberg and
/// Welch, "A Perspective on the Use of Control Variables ...", Management Science 27, 1981;
/// Crofton's formula as in Santaló, "Integral Geometry and Geometric Probability", 1976, section
/// 14.3; Roth, "Ray Casting for Modeling Solids", 1982 (volumes and moments of spans).
/// Differs: (1) A pilot run over six directions (the axes, and a frame oblique to them) chooses the
/// direction of least variance of the volume; its results are discarded. The variance is largest
/// for an end face seen along the axis of a cylinder. (2) Cells are cut by survey lines, which are
/// also discarded, so that the estimate has no bias and unseen features can still be found. A
/// survey takes seven lines per cell, on a hexagon that reaches beyond it, and yields the
/// curvature. A curvature different from that of the parent cell indicates a rim. Elsewhere a
/// parabola of known integral is subtracted from the lines of the estimate. (3) Area is the sum
/// over the three directions of a frame of |cosine| per crossing. It is exact, since the squares of
/// the three cosines sum to one, and stays bounded at grazing lines. Crofton's count of isotropic
/// lines serves as a check. (4) Intervals of volume and area come from the differences of the two
/// pairs of lines of every cell, by Student's distribution with the effective degrees of freedom of
/// the differences (Satterthwaite, "An Approximate Distribution of Estimates of Variance
/// Components", Biometrics Bulletin 2, 1946); they are many, so that the width of an interval
/// varies little. Intervals of centroid and moments come from sixteen balanced half samples
/// (McCarthy, "Pseudo-Replication: Half Samples", Review of the International Statistical Institute
/// 37, 1969; cells share rows of a Hadamard matrix at random). A part smaller than a cell that no
/// line has hit is not covered. Every interval has a term for rounding: surfaces may be displaced
/// by 64 roundings of the largest number that they are computed from, times their area. (5) If
/// hardly any line misses the solid within the rectangle of its projection, the empty corners are
/// too rare to show in the variance: the share of three lines is added (Hanley and Lippman-Hand,
/// "If Nothing Goes Wrong, Is Everything All Right?", JAMA 249, 1983). (6) No lines are cast in
/// wide gaps between the shadows of a solid's parts (chord_patches.h). If no line met the solid,
/// its intervals bound what three of the lines cast would have met.
/// Conventions: world units. Moments are for density 1.
/// Complexity and threads: errors fall about as N^-1 to N^-1.5 in the number of lines N while cells
/// are cut, then as N^-0.5. Uses all threads; the result is independent of their number unless the
/// time limit ends the work.

#include <array>
#include <cstdint>

#include "alhazen/base/progress.h"
#include "alhazen/sampling/confidence.h"
#include "alhazen/solids/isolated_solid.h"

namespace alhazen {

struct MeasureOptions {
    /// Work ends when the half-width of the interval is below this share of the area, and below
    /// half this share of the volume: the error of the volume is then below this in more than 95 of
    /// 100 cases.
    double relative_error = 1e-4;
    /// Work also ends when more lines would take longer; at least a few thousand are cast.
    double seconds = 2;
    bool area = true;  ///< also measures the area by both methods
    std::uint64_t seed = 1;
    /// From this many lines on, more lines are cast instead of cutting cells. A cell takes 12 bytes
    /// per line.
    std::uint64_t most_lines_of_round = std::uint64_t{1} << 23;
    /// Ends the work as `seconds` does. An Interruptible (base/interruption.h) ends it at once,
    /// without a result.
    const StopFlag* stop = nullptr;
};

struct SolidMeasures {
    Box3 box;
    Estimate volume;
    Estimate area;
    Estimate area_by_crofton;
    /// True if centroid and inertia are known: false for an empty solid, and if the lines of a half
    /// sample hit nothing.
    bool has_moments = false;
    std::array<Estimate, 3> centroid;
    /// Inertia tensor about the centroid for density 1: xx, yy, zz, xy, yz, zx (off the diagonal
    /// the negated products).
    std::array<Estimate, 6> inertia;
    /// The volume by each direction of the chosen frame, and these directions.
    std::array<Estimate, 3> volume_by_direction;
    std::array<Vec3, 3> directions;
    std::uint64_t lines = 0;
    /// Number of lines left out because their crossings could not be paired.
    std::uint64_t inconsistent_lines = 0;
    /// True if the three directions (both areas) differ by at most 2.5 times what their intervals
    /// allow, which chance exceeds about once in a thousand.
    bool directions_agree = true;
    bool areas_agree = true;
    bool reached = false;  ///< the requested error was reached
    /// False: numbers overflow or underflow because the solid is too large or too small; scale it.
    bool in_range = true;
};

/// Measures a solid. Throws Error (Usage) for unbounded solids, and for an error or a time limit
/// that is negative or NaN.
[[nodiscard]] SolidMeasures measure(const Measurable& solid, const MeasureOptions& options = {});

/// A plane dot(normal, p) = offset; the normal is non-zero, not necessarily unit.
struct SectionPlane {
    Vec3 normal{0, 0, 1};
    double offset = 0;
};
/// Two unit vectors in the plane, right and up as seen against the normal: z is up, or y for a
/// level plane.
struct PlaneFrame {
    Vec3 origin, right, up, normal;
};
[[nodiscard]] PlaneFrame frame_of(const SectionPlane& plane);

/// Area of the section of a solid by a plane, from lines in the plane. A plane through a face
/// is inside or outside by `keeps_face` (shape_numerics.h).
struct SectionArea {
    Estimate area;
    std::uint64_t lines = 0;
    std::uint64_t inconsistent_lines = 0;
    bool reached = false;
};
[[nodiscard]] SectionArea section_area(const Measurable& solid, const SectionPlane& plane,
                                       const MeasureOptions& options = {});

}  // namespace alhazen

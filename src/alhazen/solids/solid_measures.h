#pragma once
/// Volume, area, centroid and moments of a solid from lines through it, with intervals that hold
/// the truth in 95 of 100 cases.
///
/// Source: Press and Farrar, "Recursive Stratified Sampling for Multidimensional Monte Carlo
/// Integration", Computers in Physics 4, 1990 (cells where the integrand varies are cut);
/// Hammersley and Morton, "A New Monte Carlo Technique: Antithetic Variates", 1956; Lavenberg and
/// Welch, "A Perspective on the Use of Control Variables ...", Management Science 27, 1981;
/// Crofton's formula as in Santaló, "Integral Geometry and Geometric Probability", 1976, section
/// 14.3; Roth, "Ray Casting for Modeling Solids", 1982 (volumes and moments of spans).
/// Differs: (1) of six directions (the axes, and a frame aslant to all) a pilot run, whose numbers
/// are then thrown away, chooses the one along which the volume scatters least; an end face seen
/// along the axis of a cylinder would scatter most. (2) Cells are cut by lines that are thrown away
/// too: so the estimate has no bias, and nothing that was not seen yet is given up. They are seven
/// for a cell, a hexagon that reaches beyond it, and give its curvature: where that differs from
/// what was seen before the cell was cut out of a larger one, there is a rim. Where it does not, a
/// parabola is taken from the lines that count, and its integral is known. (3) Area is the sum over
/// the three directions of a frame of |cosine| per crossing, which is exact, since the squares of
/// the three cosines sum to one, and stays bounded where a line grazes. Crofton's count of
/// isotropic lines is made besides. (4) Intervals are those of sixteen balanced half samples
/// (McCarthy, "Pseudo-Replication: Half Samples", Review of the International Statistical Institute
/// 37, 1969; rows of a Hadamard matrix are shared by cells at random), by Student's distribution.
/// They hold as often as they say where many cells share the scatter; of a part smaller than a cell
/// that no line has met nobody knows. The rounding of the spans is added to them. (5) Where hardly
/// a line misses the solid within its shadow's rectangle, what the corners lack is too rare to show
/// in the scatter: three lines' share is added (Hanley and Lippman-Hand, "If Nothing Goes Wrong, Is
/// Everything All Right?", JAMA 249, 1983).
/// Conventions: world units. Moments are those of density 1. Complexity and threads: errors fall as
/// about N^-1 to N^-1.5, N the lines, as long as cells are cut, and then as N^-0.5. Over all
/// threads; the result does not depend on their number, as long as time does not end the work.

#include <array>
#include <cstdint>

#include "alhazen/base/progress.h"
#include "alhazen/sampling/confidence.h"
#include "alhazen/solids/isolated_solid.h"

namespace alhazen {

struct MeasureOptions {
    /// Work ends when half the interval is below this share of the area, and of the volume below
    /// half of it, so that a volume is nearer than this in more than 95 of 100 cases.
    double relative_error = 1e-4;
    double seconds = 2;  ///< or when more lines would take longer, a few thousand at the least
    bool area = true;    ///< also the area, by both methods
    std::uint64_t seed = 1;
    /// With so many no finer cells are made, but more lines cast: a cell takes 12 bytes for each.
    std::uint64_t most_lines_of_round = std::uint64_t{1} << 23;
    const StopFlag* stop = nullptr;
};

struct SolidMeasures {
    Box3 box;
    Estimate volume;
    Estimate area;
    Estimate area_by_crofton;
    /// Centroid and inertia are known: not of nothing, nor where some half of the lines met
    /// nothing.
    bool has_moments = false;
    std::array<Estimate, 3> centroid;
    /// About the centroid, density 1: xx, yy, zz, xy, yz, zx of the inertia tensor (off the
    /// diagonal minus the products).
    std::array<Estimate, 6> inertia;
    /// The volume by each direction of the frame that was chosen, and the directions.
    std::array<Estimate, 3> volume_by_direction;
    std::array<Vec3, 3> directions;
    std::uint64_t lines = 0;
    std::uint64_t inconsistent_lines = 0;  ///< their crossings did not come in pairs: left out
    /// The three directions, and both areas, differ by no more than 2.5 times their intervals allow
    /// (by chance about once in a thousand).
    bool directions_agree = true;
    bool areas_agree = true;
    bool reached = false;  ///< the wanted error
    /// False: numbers overflow or vanish, for the solid is too large or too small; scale it.
    bool in_range = true;
};

/// Throws Error (Usage) for a solid that is not bounded.
[[nodiscard]] SolidMeasures measure(const Measurable& solid, const MeasureOptions& options = {});

/// A plane dot(normal, p) = offset; the normal need not be unit but must not be zero.
struct SectionPlane {
    Vec3 normal{0, 0, 1};
    double offset = 0;
};
/// Two unit vectors in the plane, to the right and up for who looks against the normal: z is up,
/// or y where the plane is level.
struct PlaneFrame {
    Vec3 origin, right, up, normal;
};
[[nodiscard]] PlaneFrame frame_of(const SectionPlane& plane);

/// Area of what the plane cuts out of the solid, from lines in the plane. A plane along a face
/// counts as its outside.
struct SectionArea {
    Estimate area;
    std::uint64_t lines = 0;
    std::uint64_t inconsistent_lines = 0;
    bool reached = false;
};
[[nodiscard]] SectionArea section_area(const Measurable& solid, const SectionPlane& plane,
                                       const MeasureOptions& options = {});

}  // namespace alhazen

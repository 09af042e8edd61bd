#pragma once
/// The first crossings of eight rays with a blob, in lanes.
///
/// Source: blob.cpp and blob_pieces.h, the same formulas.
/// Differs: components outside of a beam around the eight rays are culled; nothing is sorted: each
/// ray steps from the end of a span to the next by scanning all components; a span is skipped only
/// where it is weak or the signs of its coefficients are certain. Rarer cases are left to the
/// scalar code.
/// Conventions: internal to this folder. Bit i of a set stands for lane i. Every target returns the
/// bits of the scalar code.

#include <cstdint>
#include <span>

#include "alhazen/shapes/algebraic/polynomial_lanes.h"
#include "alhazen/shapes/blobs/blob.h"

namespace alhazen {

/// Eight rays from points near a blob, as LocalRay; and a beam that contains them near the blob.
struct alignas(64) BlobRayLanes {
    double origin[3][kRayLanes], direction[3][kRayLanes];  ///< [axis][lane]
    double shift[kRayLanes], far[kRayLanes];
    double t_min[kRayLanes], t_max[kRayLanes];
    Vec3 axis_origin, axis_direction;
    double width;  ///< largest distance from the axis of points of the rays near the blob
    std::uint32_t finite;
};

/// A piece of a blob along eight rays: see Piece and Bump. For a ray without the piece it spans
/// infinity to -infinity with a peak of -1.
struct alignas(64) BlobRow {
    double in[kRayLanes], out[kRayLanes];
    double middle[kRayLanes], peak[kRayLanes], bend[kRayLanes];
    double strength, third;  ///< the strength, and a third of it
    double weight;           ///< the strength if positive, else 0
    double inverse_radius;
    double span;  ///< rod, middle region: length of the rod; else 0

    void set(const BlobComponent& c, double span_of_rod) {
        strength = c.strength;
        third = c.strength * (1.0 / 3.0);
        weight = c.strength > 0.0 ? c.strength : 0.0;
        inverse_radius = 1.0 / c.radius;
        span = span_of_rod;
    }
};

struct alignas(64) BlobHitLanes {
    double t[kRayLanes];   ///< for the lanes that hit
    std::uint32_t hit;     ///< the lanes that enter
    std::uint32_t leave;   ///< the lanes that leave
    std::uint32_t unsure;  ///< lanes left to the scalar code
};

/// The kernels of one instruction set.
struct BlobKernels {
    void (*begin)(const Blob&, const RayLanes&, BlobRayLanes&);
    /// Writes the numbers of the components that the beam may intersect, a superset of them;
    /// returns their count.
    std::size_t (*near)(const Blob&, const BlobRayLanes&, std::uint32_t* numbers);
    /// Writes a row for each of these balls that a ray intersects; returns their count.
    std::size_t (*balls)(const Blob&, const BlobRayLanes&, std::span<const std::uint32_t> numbers,
                         BlobRow* rows);
    void (*search)(const Blob&, const BlobRayLanes&, std::span<const BlobRow>, BlobHitLanes&);
};

/// For the best instruction set of this machine, or the forced one (simd/targets.h).
[[nodiscard]] const BlobKernels& blob_kernels();

}  // namespace alhazen

#pragma once
/// Statistics of a scan-line renderer.
///
/// Conventions: patches are sub-patches whose control points are in memory; polygons are those of
/// the polygon table. `most_*` is the largest number at one time.

#include <cstdint>
#include <vector>

namespace alhazen {

/// Sizes of the tables at a scan line.
struct ScanLineTables {
    std::uint32_t waiting = 0;   ///< patches in the buckets of later scan lines
    std::uint32_t active = 0;    ///< largest number of patches in the active table
    std::uint32_t polygons = 0;  ///< in the polygon table
};

struct ScanLineReport {
    std::uint64_t patches = 0;               ///< of the scene
    std::uint64_t split_u = 0, split_v = 0;  ///< patches split in a direction
    std::uint64_t quads = 0;                 ///< flat sub-patches that became polygons
    std::uint64_t facets = 0;                ///< visible polygons of the scene
    std::uint64_t most_patches = 0;          ///< in memory, waiting ones included
    std::uint64_t most_active = 0;           ///< in the active-patch table
    std::uint64_t most_polygons = 0;         ///< in memory, waiting ones included
    std::uint64_t most_held = 0;             ///< patches and polygons together
    std::uint64_t most_bytes = 0;            ///< of both
    std::uint64_t passes = 1;                ///< subdivisions of the whole scene
    double flatness = 0;                     ///< of the last pass, pixels
    std::uint64_t crack_samples = 0;         ///< samples in cracks, if `counted_cracks`
    bool counted_cracks = false;
    std::vector<ScanLineTables> lines;  ///< [scan line of the crop]
};

}  // namespace alhazen

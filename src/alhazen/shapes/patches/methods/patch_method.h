#pragma once
/// Published methods for the crossings of a line with rational Bezier patches, selected by name,
/// all over the same patches; for comparison with the production method, not for rendering.
/// Source: with each method (make_* below, one file each).
/// Differs: each finds all crossings, not only the first; a method is called only for patches whose
/// box the line meets. Rational patches are represented by their numerators in the two planes of
/// the line, which are polynomials.
/// Conventions: missed and duplicate crossings are reported as the method finds them, without
/// correction. Not thread-safe: a method may keep state of the previous ray.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "alhazen/geometry/ray.h"
#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

struct PatchCrossing {
    double t = 0, u = 0, v = 0;
    std::uint32_t patch = 0;
};

struct PatchMethodCounts {
    std::uint64_t rays = 0;
    std::uint64_t patches = 0;  ///< patches whose box the line meets
    std::uint64_t steps = 0;  ///< boxes, clips or iterations: the repeated operation of the method
    std::uint64_t subdivisions = 0;  ///< number of divided domains
};

class PatchMethod {
  public:
    PatchMethod() = default;
    PatchMethod(const PatchMethod&) = delete;
    PatchMethod& operator=(const PatchMethod&) = delete;
    virtual ~PatchMethod() = default;

    /// Appends all crossings with t in the range of the ray, in any order.
    virtual void crossings(const Ray& ray, std::vector<PatchCrossing>& out,
                           PatchMethodCounts& counts) = 0;
};

struct PatchMethodEntry {
    const char* name;
    const char* step;  ///< name of the operation counted in `steps`; null: not counted
    std::unique_ptr<PatchMethod> (*make)(std::span<const BezierNet> nets);
};

/// Sorted by year, the production method last.
[[nodiscard]] std::span<const PatchMethodEntry> patch_methods();
/// Throws Error (Usage) for an unknown name.
[[nodiscard]] const PatchMethodEntry& patch_method(const std::string& name);

}  // namespace alhazen

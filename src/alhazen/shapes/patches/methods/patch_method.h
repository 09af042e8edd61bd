#pragma once
/// The methods of the literature for the crossings of a line with rational Bezier patches, by name,
/// all over the same patches: to compare with the production one, never to render.
///
/// Source: with each method (make_* below, one file each).
/// Differs: each finds every crossing, not the first one alone; before a method is asked about a
/// patch, the line meets the patch's box. Rational patches enter by their numerators in the two
/// planes of the line, which are polynomials.
/// Conventions: what a method misses or finds twice it reports so; nothing is mended behind it.
/// Not for several threads: a method may remember the ray before.

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
    std::uint64_t patches = 0;       ///< whose box the line meets
    std::uint64_t steps = 0;         ///< boxes, clips, iterations: what the method repeats
    std::uint64_t subdivisions = 0;  ///< domains divided
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
    const char* step;  ///< what `steps` counts; null: not counted
    std::unique_ptr<PatchMethod> (*make)(std::span<const BezierNet> nets);
};

/// In the order of their years, the production one last.
[[nodiscard]] std::span<const PatchMethodEntry> patch_methods();
/// Throws Error (Usage) for a name that is none.
[[nodiscard]] const PatchMethodEntry& patch_method(const std::string& name);

}  // namespace alhazen

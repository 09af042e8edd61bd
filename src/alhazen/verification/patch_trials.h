#pragma once
/// Rays that are difficult for patches, and the comparison of a list of crossings with the exact
/// one.
///
/// Source of the rays: docs/design/patches.md, "Verification in 113 bits".
/// Conventions: crossings are compared for a whole model: a root on a border that two patches share
/// belongs to either. A line within `kNear` roundings (PatchModel::rounding) of a place where
/// crossings appear or vanish has two valid results:
///   - two crossings in opposite directions whose surface between them is that near to the line (a
///     fold, a crease) may both be missing, or both be present though the line misses;
///   - a crossing that near to a side that no other patch shares, or to its end, may be missing or
///     present.
/// All other differences count as missed or invented. A line whose number of crossings 113 bits do
/// not decide is not judged.

#include <span>
#include <string>
#include <vector>

#include "alhazen/geometry/box.h"
#include "alhazen/sampling/random.h"
#include "alhazen/shapes/patches/methods/patch_method.h"
#include "alhazen/verification/exact_patches.h"

namespace alhazen {

/// A model of patches that rays are aimed at.
struct PatchModel {
    std::string name;
    std::vector<BezierNet> nets;
    std::vector<bool> open;  ///< [4 * patch + side]: no other patch has this side
    /// [4 * patch + 2 * (u == 1) + (v == 1)]: an open side ends here.
    std::vector<bool> open_corner;
    std::vector<bool> turned;  ///< [patch] du x dv points to the other side than its neighbours'
    Box3 box;
    double reach = 0, most_weight = 0;

    PatchModel(std::string name, std::vector<BezierNet> nets);
    /// The rounding error allowed for crossings, as a distance from the line: `tiny` of
    /// docs/design/patches.md.
    [[nodiscard]] double rounding(const Ray& ray) const;

  private:
    void mark_open_corners();
    void orient();
};

inline constexpr double kNear = 16.0;

enum class PatchRayKind { Random, Tangent, Border, Corner };
inline constexpr int kPatchRayKinds = 4;
[[nodiscard]] const char* patch_ray_name(PatchRayKind kind);

/// A whole line. Tangent: at 1e-12 to 1e-1 of the model's size from a tangent of a patch.
[[nodiscard]] Ray patch_ray(const PatchModel& model, PatchRayKind kind, RandomStream& random);

struct PatchJudgement {
    int exact = 0, found = 0;      ///< crossings
    int missed = 0, invented = 0;  ///< crossings
    int pairs = 0, at_sides = 0;   ///< pairs and single crossings that rounding decides
    bool undecided = false;        ///< the line is not judged
    double worst_t = 0;            ///< largest error of a crossing found, as a length
    double worst_of_bound = 0;  ///< worst_t / (rounding * (1 + slope)) for slopes below 1e4; at a
                                ///< side divided by kNear, with the larger slope of both if
                                ///< another patch reports the crossing
};

/// `farthest`: largest distance along the line of a found crossing from the exact one it matches.
[[nodiscard]] PatchJudgement judge_crossings(const PatchModel& model, const Ray& ray,
                                             const ExactPatchRoots& exact,
                                             std::span<const PatchCrossing> found, double farthest);

/// Sums of judgements, and their largest errors.
struct PatchTally {
    long rays = 0, undecided = 0, exact = 0, missed = 0, invented = 0, pairs = 0, at_sides = 0;
    double worst_t = 0, worst_of_bound = 0;

    void add(const PatchJudgement& one);
};

}  // namespace alhazen

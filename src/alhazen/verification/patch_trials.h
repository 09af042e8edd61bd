#pragma once
/// Rays that are hard for patches, and the judgement of a list of crossings against the exact one.
///
/// Source: the rays: docs/design/patches.md, "Shown by".
/// Conventions: crossings are compared for a whole model: a root on a border that two patches share
/// belongs to either. A line within `kNear` roundings (PatchModel::rounding) of a place where
/// crossings appear or vanish has two answers, of which either is right:
///   - two crossings in opposite directions whose surface between them is that near to the line (a
///     fold, a crease) may both be missing, or both be there though the line passes by;
///   - a crossing that near to a side that no other patch shares, or to its end, may be missing, or
///     be there.
/// Anything else is missed or invented. A line whose count 113 bits do not decide is not judged.

#include <span>
#include <string>
#include <vector>

#include "alhazen/geometry/box.h"
#include "alhazen/sampling/random.h"
#include "alhazen/shapes/patches/methods/patch_method.h"
#include "alhazen/verification/exact_patches.h"

namespace alhazen {

/// Patches to aim at.
struct PatchModel {
    std::string name;
    std::vector<BezierNet> nets;
    std::vector<bool> open;  ///< [4 * patch + side]: no other patch has this side
    std::vector<bool>
        open_corner;           ///< [4 * patch + 2 * (u == 1) + (v == 1)]: an open side ends here
    std::vector<bool> turned;  ///< [patch]: du x dv points to the other side than its neighbours'
    Box3 box;
    double reach = 0, most_weight = 0;

    PatchModel(std::string name, std::vector<BezierNet> nets);
    /// The rounding error that crossings may show, as a distance from the line: `tiny` of
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

/// A whole line; Tangent: 1e-12 to 1e-1 of the model's size beside a tangent of a patch.
[[nodiscard]] Ray patch_ray(const PatchModel& model, PatchRayKind kind, RandomStream& random);

struct PatchJudgement {
    int exact = 0, found = 0;      ///< crossings
    int missed = 0, invented = 0;  ///< crossings
    int pairs = 0, at_sides = 0;   ///< pairs and single ones that rounding decides
    bool undecided = false;        ///< nothing is said
    double worst_t = 0;            ///< largest error of a crossing found, as a length
    double worst_of_bound = 0;  ///< the same over rounding * (1 + slope), where slope < 1e4; at a
                                ///< side over kNear times as much, with the larger slope of
                                ///< both where another patch reports the crossing
};

/// `farthest`: along the line, of a crossing found from the exact one that it stands for.
[[nodiscard]] PatchJudgement judge_crossings(const PatchModel& model, const Ray& ray,
                                             const ExactPatchRoots& exact,
                                             std::span<const PatchCrossing> found, double farthest);

/// Sums, and the largest of errors.
struct PatchTally {
    long rays = 0, undecided = 0, exact = 0, missed = 0, invented = 0, pairs = 0, at_sides = 0;
    double worst_t = 0, worst_of_bound = 0;

    void add(const PatchJudgement& one);
};

}  // namespace alhazen

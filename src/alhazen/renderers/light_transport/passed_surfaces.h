#pragma once
/// Light paths at parts that only some kinds of rays see (RayMask).
///
/// Conventions: eye paths decide which surface a path scatters at, and the ray that leaves it
/// towards the light decides what is in the way. So a segment of a light path may end at surfaces
/// that do not block it: one that connections pass can be lit, and one that only eye rays see can
/// be the last. Of them and the surface that blocks, one is chosen with the same probability, and
/// the light is multiplied by their number. Densities (PathVertex) leave that factor out, since
/// weights need not be of the true densities. At a surface that does not block, light does not
/// continue straight or by singular lobes: no eye path would find the light there.

#include <algorithm>
#include <vector>

#include "alhazen/primitives/surface.h"
#include "alhazen/renderers/light_transport/connecting_rays.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

/// The kinds of rays with which paths from the eye find surfaces.
inline constexpr RayMask kRaysOfPaths = kRaysOfAllKinds & ~mask_of(RayKind::Shadow);

class PassedSurfaces {
  public:
    PassedSurfaces(const Scene& scene, TraversalStats* stats) : scene_(scene), stats_(stats) {}

    /// True if there may be such parts.
    [[nodiscard]] bool exist() const { return scene_.has_partial_masks; }

    struct Choice {
        bool passed = false;  ///< the surface does not block the ray
        double weight = 1;    ///< number of surfaces chosen from
    };
    /// Chooses the end of a segment, by a number in [0, 1). `hit`: the surface that blocks, if
    /// `found`; set to the choice.
    [[nodiscard]] Choice choose(const Ray& ray, float time, double u, bool found, Hit& hit) {
        hits_.clear();
        Ray before = ray;
        if (found) before.t_max = kBeforeEnd * hit.t;
        scene_.aggregate->all_hits(before, hits_, {stats_, kRaysOfPaths, time});
        if (hits_.empty()) return {};
        const auto count = hits_.size() + 1;
        const auto chosen =
            std::min(static_cast<std::size_t>(u * static_cast<double>(count)), count - 1);
        const bool passed = chosen < hits_.size();
        if (passed) hit = hits_[chosen];
        return {passed, static_cast<double>(count)};
    }
    /// The kinds of rays that see the surface at a hit.
    [[nodiscard]] RayMask seen_by(const Hit& hit) const {
        return exist() ? mask_at(*scene_.aggregate, hit) : kAllRays;
    }

  private:
    const Scene& scene_;
    TraversalStats* stats_;
    std::vector<Hit> hits_;
};

}  // namespace alhazen

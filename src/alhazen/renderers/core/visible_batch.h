#pragma once
/// The first surface with a coverage above 0 along each of many rays: `first_visible_hit` in
/// batches.
///
/// Conventions: surfaces are reported one at a time, in any order of the rays; a reported point is
/// valid until the next. Memory is reused from batch to batch.

#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "alhazen/renderers/core/coincident_surfaces.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/core/wavefront.h"

namespace alhazen {

class VisibleBatch {
  public:
    /// `follows_light`: rays other than eye rays hit the backs of single-sided surfaces.
    VisibleBatch(const Scene& scene, TraversalStats* stats, bool follows_light = false)
        : scene_(scene),
          stats_(stats),
          follows_light_(follows_light),
          constant_(scene),
          here_(scene) {}
    /// Uses the optics for all further surfaces; media are those of `path(k).medium`.
    void use(SurfaceOptics& optics) { optics_ = &optics; }
    /// Reports surfaces of coverage 0, too, that may be openings into volumes.
    void report_openings() { reports_openings_ = true; }

    /// `path(k)` returns `kind`, `cone`, `inside` and `time` of ray k. Calls `tell(k, point, t)`
    /// once for each ray: with a null pointer if nothing is hit, else with the point and its
    /// distance from the origin of the ray. `tell` must not change rays or paths that are not yet
    /// reported.
    template <class PathOf, class Tell>
    void find(std::span<const Ray> rays, Coherence coherence, PathOf&& path, Tell&& tell) {
        find(rays, coherence, path, tell, [](std::size_t, const Hit&) { return false; });
    }
    /// As above, with `take(k, hit)` called for the first hit of each ray before its surface is
    /// found; if it returns true the ray is done.
    template <class PathOf, class Tell, class Take>
    void find(std::span<const Ray> rays, Coherence coherence, PathOf&& path, Tell&& tell,
              Take&& take) {
        go_on(closest(rays, coherence, path), rays, path, tell, take);
    }
    /// Continues from the first hits that `find` passed to `take` for the same rays.
    template <class PathOf, class Tell, class Take>
    void go_on(std::span<const Hit> first, std::span<const Ray> rays, PathOf&& path, Tell&& tell,
               Take&& take) {
        behind_.clear();
        for (std::size_t k = 0; const Hit& hit : first) {
            if (hit.found()) {
                if (!take(k, hit)) meet(k, rays[k], rays[k], 0.0, hit, path(k), tell);
            } else {
                tell(k, static_cast<const ShadingPoint*>(nullptr), 0.0);
            }
            ++k;
        }
        for (int passed = 0; passed < kMaxPassedSurfaces && !behind_.empty(); ++passed) {
            on_way_.swap(behind_);
            behind_.clear();
            rest_.clear();
            for (const Passed& p : on_way_) rest_.push_back(p.rest);
            const auto path_behind = [&](std::size_t i) -> decltype(auto) {
                return path(on_way_[i].ray);
            };
            for (std::size_t i = 0; const Hit& hit : closest(rest_, Coherence::Any, path_behind)) {
                const Passed& p = on_way_[i++];
                if (hit.found()) {
                    meet(p.ray, rays[p.ray], p.rest, p.distance, hit, path(p.ray), tell);
                } else {
                    tell(p.ray, static_cast<const ShadingPoint*>(nullptr), 0.0);
                }
            }
        }
        for (const Passed& p : behind_) tell(p.ray, static_cast<const ShadingPoint*>(nullptr), 0.0);
    }

    /// The hit of the point that is being reported; t counts from the last surface passed.
    [[nodiscard]] const Hit& reported_hit() const { return *reported_; }

    /// While a point is reported: the ray behind all surfaces at its place, along the unit
    /// direction.
    [[nodiscard]] Ray beyond(const Vec3& direction) const {
        return leaving_ray(searched_ ? first_here_ : point_.surface, direction);
    }
    /// The ray of `reported_hit`.
    [[nodiscard]] const Ray& reported_ray() const {
        return is_further_ ? here_.ray() : *reported_ray_;
    }
    /// Reports a surface at the place again.
    template <class AnyPath>
    void report(const HitAlong& at, const AnyPath& path) {
        if (is_further_) shade(at.ray, at.hit, path, path.cone.width_at(0.0));
    }
    /// The ray along which `next_here` found its point.
    [[nodiscard]] const Ray& ray_here() const { return here_.ray(); }
    /// While a point is reported that the ray passes: reports the next surface at the same place;
    /// null if there is none. `path`: of the ray, with its cone at the point.
    template <class AnyPath>
    [[nodiscard]] const ShadingPoint* next_here(const AnyPath& path) {
        if (!searched_) search_here(path);
        while (const Hit* hit = here_.next()) {
            is_further_ = true;
            shade(here_.ray(), *hit, path, path.cone.width_at(0.0));
            if (!is_reported()) continue;
            reported_ = hit;
            return &point_;
        }
        return nullptr;
    }

  private:
    /// A ray behind surfaces with no coverage.
    struct Passed {
        Ray rest;
        std::size_t ray;
        double distance;  ///< from the origin of the whole ray
    };

    /// The first hits of the rays, ray i among the parts visible to `path(i).kind`.
    template <class PathOf>
    [[nodiscard]] std::span<const Hit> closest(std::span<const Ray> rays, Coherence coherence,
                                               PathOf&& path) {
        // Hits are large: existing ones are reused.
        if (hits_.size() < rays.size()) hits_.resize(rays.size());
        if (scene_.has_motion) {
            times_.clear();
            for (std::size_t i = 0; i < rays.size(); ++i) times_.push_back(path(i).time);
        }
        if (!scene_.has_masks) {
            trace(rays, hits_, coherence, kAllRays);
            return std::span(hits_).first(rays.size());
        }
        for (std::size_t k = 0; k < kRayKindCount; ++k) {
            chosen_.clear();
            for (std::size_t i = 0; i < rays.size(); ++i) {
                if (path(i).kind == static_cast<RayKind>(k)) chosen_.push_back(i);
            }
            trace_chosen(rays, coherence, mask_of(static_cast<RayKind>(k)));
        }
        return std::span(hits_).first(rays.size());
    }
    /// Finds the closest hits, at `times_` if something moves.
    void trace(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence, RayMask mask);
    void trace_chosen(std::span<const Ray> rays, Coherence coherence, RayMask mask);

    /// Reports the hit, or queues the ray to continue behind it. `rest`: ray k behind the last
    /// surface, `distance` from the origin of `whole`.
    template <class AnyPath, class Tell>
    void meet(std::size_t k, const Ray& whole, const Ray& rest, double distance, const Hit& hit,
              const AnyPath& path, Tell&& tell) {
        const double t = distance + hit.t;
        shade(rest, hit, path, path.cone.width_at(t));
        reported_ = &hit;
        reported_ray_ = &rest;
        searched_ = is_further_ = false;
        if (is_reported()) {
            tell(k, static_cast<const ShadingPoint*>(&point_), t);
            return;
        }
        search_here(path);
        const Ray behind = leaving_ray(point_.surface, whole.direction, whole.t_max - t);
        while (const Hit* other = here_.next()) {
            shade(here_.ray(), *other, path, path.cone.width_at(t));
            if (!is_reported()) continue;
            reported_ = other;
            is_further_ = true;
            tell(k, static_cast<const ShadingPoint*>(&point_), t);
            return;
        }
        behind_.push_back({behind, k, t});
    }

    /// Sets `point_`. `width`: of the cone at the hit.
    template <class AnyPath>
    void shade(const Ray& ray, const Hit& hit, const AnyPath& path, double width) {
        const PointNeeds needs{.coordinates = CoordinateNeed::of(scene_.reads_coordinates),
                               .constant = &constant_,
                               .optics = optics_};
        const bool meets_backs = follows_light_ && path.kind != RayKind::Eye;
        Arrival arrival{path.inside, width, path.time, meets_backs};
        if constexpr (std::is_same_v<AnyPath, Path>) {
            arrival.medium = path.medium;
            arrival.mask = mask_of(path.kind);
        }
        set_shading_point(scene_, ray, hit, arrival, needs, point_);
    }
    /// True if `point_` is to be reported.
    [[nodiscard]] bool is_reported() const {
        return point_.material->coverage > 0.0 || (reports_openings_ && !point_.material->thin);
    }
    /// Finds the surfaces at the place of `point_`, the first one met there.
    template <class AnyPath>
    void search_here(const AnyPath& path) {
        first_here_ = point_.surface;
        searched_ = true;
        here_.find(point_.surface, *reported_, *reported_ray_,
                   {stats_, mask_of(path.kind), path.time});
    }

    const Scene& scene_;
    TraversalStats* stats_;
    bool follows_light_, reports_openings_ = false;
    SurfaceOptics* optics_ = nullptr;
    MaterialCache constant_;
    ShadingPoint point_;
    const Hit* reported_ = nullptr;
    const Ray* reported_ray_ = nullptr;  ///< of the first surface at the place
    CoincidentSurfaces here_;            ///< at the place of the point
    bool searched_ = false;              ///< `here_` and `first_here_` are set
    bool is_further_ = false;            ///< the point is not the first one at the place
    ShapeSurface first_here_;            ///< the first surface at the place
    std::vector<Hit> hits_;
    std::vector<float> times_;  ///< [ray]; only if something moves
    // Rays of one kind; only if parts have visibility masks.
    std::vector<std::size_t> chosen_;
    std::vector<Ray> chosen_rays_;
    std::vector<Hit> chosen_hits_;
    std::vector<float> chosen_times_;
    std::vector<Ray> rest_;
    std::vector<Passed> behind_, on_way_;
};

}  // namespace alhazen

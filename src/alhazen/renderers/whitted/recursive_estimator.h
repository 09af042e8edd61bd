#pragma once
/// The estimator of recursive ray tracing, a generation at a time; `Randomness` provides what is
/// drawn at random.
///
/// Source: Whitted 1980 (whitted.h); Cook, Porter and Carpenter 1984 (distributed.h).
/// Conventions: those of RadianceEstimator. NoRandomness draws nothing: Whitted's picture.

#include <algorithm>
#include <deque>
#include <optional>
#include <type_traits>
#include <vector>

#include "alhazen/cameras/eye_rays.h"
#include "alhazen/renderers/core/estimator.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/core/refraction.h"
#include "alhazen/renderers/core/tinted_media.h"
#include "alhazen/renderers/core/visible_batch.h"
#include "alhazen/renderers/core/wavefront.h"
#include "alhazen/renderers/direct_light/direct_light.h"
#include "alhazen/renderers/volumes/exact_optics.h"
#include "alhazen/renderers/volumes/media_finder.h"
#include "alhazen/renderers/volumes/shadow_batch.h"
#include "alhazen/renderers/volumes/touching_faces.h"
#include "alhazen/renderers/whitted/wave_split.h"
#include "alhazen/shading/optics/dispersion.h"

namespace alhazen {

/// Nothing is random: lights by `sample`, exact mirrored and refracted directions, time 0.
struct NoRandomness {
    explicit NoRandomness(const RenderJob&) {}
    [[nodiscard]] LightSample light_from(const Light& light, std::size_t /*number*/,
                                         const Vec3& point, bool clamp, const Path&,
                                         int /*depth*/) const {
        return sample(light, point, clamp);
    }
    void spread(RayKind, const ShadingPoint&, const Path&, int /*depth*/, Vec3&) const {}
    /// The time of an eye ray and of all rays that follow from it.
    [[nodiscard]] static float time(std::uint32_t /*sample*/) { return 0.0f; }
};

/// A `Randomness` that observes the tree of rays. `use` is called once, with the media of
/// Path::medium. For some rays of a generation the calls are, in order: `begin_rays`; for each
/// surface `see_light` for the lights it faces, then `meet`; `miss` for rays that hit nothing;
/// `gather`, after the next generation, with the surfaces in the order of `meet`; `give_up` if rays
/// have passed kMaxPassedSurfaces; `end_rays`, when the radiance is known.
template <class Randomness>
concept TreeWatcher = requires(Randomness& random, const GenerationPart& part,
                               const ShadingPoint& point, const Path& path, const MetSurface& met,
                               const Wavefront& front, const LightSample& light, const Rgb& left,
                               ExactOptics& optics, const TintedMedia& tinted, std::uint32_t ray,
                               double t, int depth) {
    random.use(optics);
    random.use(tinted);
    random.begin_rays(part, depth);
    random.see_light(std::size_t{}, light, t, path);
    random.meet(point, t, path, depth, met);
    random.miss(ray, left, depth);
    random.gather(front, depth);
    random.give_up(front, depth);
    random.end_rays(part, depth);
};

/// Generations of at least this depth trace fewer rays at a time, which bounds the memory of
/// waiting generations.
inline constexpr int kDeepGeneration = 16;
inline constexpr std::size_t kRaysAtOnceWhereDeep = 16;

/// Traces batches of eye rays; memory is reused from batch to batch.
template <class Randomness>
class RecursiveEstimator {
  public:
    /// `split`: wavelengths of rays that dispersing surfaces refract; null: no dispersion.
    RecursiveEstimator(const RenderJob& job, std::size_t rays_at_once, RayCounters& counters,
                       const WaveSplit* split = nullptr)
        : job_(job),
          scene_(job.scene),
          conventions_(job.scene.conventions.shading),
          counters_(counters),
          rays_at_once_(rays_at_once),
          eye_path_{.cone = job.cone},
          ambient_(ambient_terms(scene_.lights)),
          visible_(scene_, job.count_tests ? &counters.tests : nullptr),
          shadows_(scene_, counters, job.count_tests ? &counters.tests : nullptr),
          random_(job),
          split_(split),
          unhindered_(Rgb{1, 1, 1} * scene_.background) {
        if constexpr (kDrawsNothing) {
            if (DirectLight::covers(scene_)) {
                direct_.emplace(scene_, counters, job.count_tests ? &counters.tests : nullptr);
            }
        }
        for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
            if (illuminates(scene_.lights[i])) shadow_lights_.push_back(i);
        }
        if (!conventions_.optics.any()) {
            if (!scene_.all_opaque) {
                touching_.emplace(scene_, tinted_);
                visible_.use(*touching_);
            }
            shadows_.use(tinted_);
            if constexpr (TreeWatcher<Randomness>) random_.use(tinted_);
        } else {
            optics_.emplace(scene_, conventions_.optics);
            visible_.use(*optics_);
            shadows_.use(*optics_);
            if constexpr (TreeWatcher<Randomness>) random_.use(*optics_);
        }
        if (scene_.all_opaque) return;
        finder_.emplace(scene_);
        if (!finder_->has_volumes() || is_parallel()) return;
        start_at(picture_plane(job.camera).eye, 0.0f, eye_path_);
    }

    /// Adds the radiance along eye rays of unit direction.
    void trace(std::span<const Ray> rays, std::span<Rgb> radiance) {
        prepare_eye_paths(rays.size());
        const std::span<Path> paths(eye_paths_);
        const std::size_t media = optics_ ? optics_->mark() : tinted_.mark();
        if (finder_ && finder_->has_volumes() && is_parallel()) {
            for (std::size_t i = 0; i < rays.size(); ++i)
                start_at(rays[i].origin, paths[i].time, paths[i]);
        }
        for (std::size_t i = 0; i < rays.size(); i += rays_at_once_) {
            const std::size_t count = std::min(rays_at_once_, rays.size() - i);
            trace_part(
                {rays.subspan(i, count), paths.subspan(i, count), radiance.subspan(i, count)}, 0);
        }
        optics_ ? optics_->release(media) : tinted_.release(media);
    }

    [[nodiscard]] Randomness& randomness() { return random_; }

    /// Sets where `trace` stores the first hit of each eye ray; empty: nowhere.
    void keep_hits(std::span<Hit> hits) { eye_hits_ = hits; }
    /// Sets the known first hits of the eye rays; empty: they are found.
    void start_from(std::span<const Hit> hits) { known_hits_ = hits; }

  private:
    static constexpr bool kDrawsNothing = std::is_same_v<Randomness, NoRandomness>;

    [[nodiscard]] bool is_parallel() const {
        return std::holds_alternative<OrthographicCamera>(job_.camera);
    }
    /// Sets the medium of an eye ray that begins at the point.
    void start_at(const Vec3& point, float time, RayMedium& medium) {
        MediumStack volumes = finder_->around(point, time);
        volumes.keep_seen_by(mask_of(RayKind::Eye));
        medium = optics_ ? optics_->within(volumes)
                         : medium_within(scene_, volumes, tracks_media() ? &tinted_ : nullptr);
    }
    /// Sets the paths of the next eye rays, which differ in few things from the last ones.
    void prepare_eye_paths(std::size_t count) {
        for (const std::uint32_t sample : gone_on_) eye_paths_[sample].cone = eye_path_.cone;
        gone_on_.clear();
        while (eye_paths_.size() < count) {
            Path& path = eye_paths_.emplace_back(eye_path_);
            path.sample = static_cast<std::uint32_t>(eye_paths_.size() - 1);
        }
        if constexpr (!kDrawsNothing) {
            for (std::size_t i = 0; i < count; ++i)
                eye_paths_[i].time = random_.time(eye_paths_[i].sample);
        }
    }

    /// Traces all rays of a generation behind that of the eye rays.
    void trace_all(Generation& generation, int depth) {
        generation.make_ready();
        const std::size_t most =
            depth < kDeepGeneration ? rays_at_once_ : std::min(rays_at_once_, kRaysAtOnceWhereDeep);
        for (std::size_t i = 0; i < generation.size(); i += most) {
            trace_part(generation.part(i, std::min(most, generation.size() - i)), depth);
        }
    }

    /// Traces some rays of a generation. Behind a partly covering surface a ray continues straight,
    /// as the same ray.
    void trace_part(const GenerationPart& part, int depth) {
        Wavefront& front = front_at(depth);
        front.begin(part.size());
        if (depth == 0) {
            counters_[RayKind::Eye].cast += part.size();
        } else {
            for (const Path& path : part.paths) ++counters_[path.kind].cast;
        }
        if constexpr (TreeWatcher<Randomness>) random_.begin_rays(part, depth);
        for (int met = 0; met < kMaxPassedSurfaces && !front.active.empty(); ++met) {
            // One eye ray may cause millions of rays. Its pixel is dropped after a stop.
            if (job_.stop_requested()) return;
            front.begin_surfaces();
            const std::size_t media = optics_ ? optics_->mark() : tinted_.mark();
            const Coherence coherence = depth == 0 ? Coherence::Coherent : Coherence::Any;
            direct_ ? direct_->expect(coherence) : shadows_.expect(coherence);
            intersect_surfaces(part, depth, met == 0, front);
            finish_light();
            trace_all(front.next, depth + 1);
            if constexpr (TreeWatcher<Randomness>) random_.gather(front, depth);
            gather(front, part.radiance);
            optics_ ? optics_->release(media) : tinted_.release(media);
            front.go_on();
        }
        if constexpr (TreeWatcher<Randomness>) {
            if (!front.active.empty()) random_.give_up(front, depth);
            random_.end_rays(part, depth);
        }
    }

    Wavefront& front_at(int depth) {
        while (fronts_.size() <= static_cast<std::size_t>(depth)) fronts_.emplace_back();
        return fronts_[static_cast<std::size_t>(depth)];
    }

    /// Adds the light of waiting shadow rays.
    void finish_light() {
        direct_ ? direct_->finish() : shadows_.finish();
        paths_behind_.clear();
    }

    /// Finds the next surface along each active ray; `first`: none has been found yet.
    void intersect_surfaces(const GenerationPart& part, int depth, bool first, Wavefront& front) {
        const std::span<const Ray> rays = first ? part.rays : std::span<const Ray>(front.rays);
        const Coherence coherence = first && depth == 0 ? Coherence::Coherent : Coherence::Any;
        const auto path_of = [&](std::size_t k) -> const Path& {
            return part.paths[front.active[k]];
        };
        const bool keeps = first && depth == 0 && !eye_hits_.empty();
        const auto tell = [&](std::size_t k, const ShadingPoint* point, double t) {
            const std::uint32_t i = front.active[k];
            Rgb& left = front.left[i];
            Path& path = part.paths[i];
            const bool absorbs = !path.absorption.is_black();
            if (point == nullptr) {
                if (absorbs) left = left * transmittance_to_infinity(path.absorption);
                if constexpr (TreeWatcher<Randomness>) random_.miss(i, left, depth);
                part.radiance[i] += first && !absorbs ? unhindered_ : left * scene_.background;
                return;
            }
            counters_[path.kind].hit += first;
            if (absorbs) left = left * transmittance(path.absorption, t);
            bool begun = false;
            for (; point != nullptr; point = visible_.next_here(path)) {
                const double coverage = point->material->coverage;
                // `met` must not move while its light waits.
                if (front.met.size() == front.met.capacity()) finish_light();
                MetSurface& met = front.met.emplace_back();
                met.ray = i;
                met.share = coverage * left;
                // Further surfaces at the place are at distance 0.
                shade({*point, rays[k], begun ? 0.0 : t, path, depth}, met, front);
                if constexpr (TreeWatcher<Randomness>) random_.meet(*point, t, path, depth, met);
                left = (1.0 - coverage) * left;
                if (met.filtered) left = left * met.filter;
                if (!(left.max() >= kLeastTransmittance)) return;
                if (begun) continue;
                begun = true;
                path.cone = path.cone.from(t);
                if (depth == 0) gone_on_.push_back(path.sample);
            }
            front.next_active.push_back(i);
            front.next_rays.push_back(visible_.beyond(rays[k].direction));
        };
        const auto take = [&](std::size_t k, const Hit& hit) {
            if (keeps) eye_hits_[k] = hit;
            return false;
        };
        if (first && depth == 0 && !known_hits_.empty()) {
            visible_.go_on(known_hits_, rays, path_of, tell, take);
        } else {
            visible_.find(rays, coherence, path_of, tell, take);
        }
    }

    /// Adds the colours of the surfaces to the radiance of the rays.
    void gather(const Wavefront& front, std::span<Rgb> radiance) const {
        for (const MetSurface& met : front.met) {
            radiance[met.ray] += met.share * color_of(met, front);
        }
    }
    [[nodiscard]] Rgb color_of(const MetSurface& met, const Wavefront& front) const {
        if (!met.lit) return met.own;
        const auto beyond = [&](std::uint32_t ray) {
            return ray == MetSurface::kNotSent ? Rgb{} : front.next.radiance(ray);
        };
        Rgb refracted;
        if (met.split) {
            for (std::size_t i = met.refracted; const WaveSplit::Wave& wave : split_->waves()) {
                refracted += wave.weight * beyond(front.split[i++]);
            }
        } else {
            refracted = beyond(met.refracted);
        }
        const Rgb color =
            met.own + met.direct + met.kr * beyond(met.reflected) + met.kt * refracted;
        return met.filtered ? color * met.filter : color;
    }

    /// A point and the ray that hit it.
    struct Seen {
        const ShadingPoint& point;
        const Ray& ray;
        double t;
        const Path& path;
        int depth;
    };

    /// Gathers the light from the point towards the origin of the ray: at once, by queued shadow
    /// rays, or by rays of the next generation.
    void shade(const Seen& seen, MetSurface& met, Wavefront& front) {
        const ShadingPoint& point = seen.point;
        path_behind_ = nullptr;
        if (seen.depth == 0 && conventions_.inside_color && starts_inside(point, met)) {
            met.lit = false;
            met.own = *conventions_.inside_color;
            return;
        }
        met.lit = !point.material->unlit;
        if (!met.lit) {
            met.own = point.material->emission;
            return;
        }
        met.own = unshadowed_terms(conventions_, ambient_, point);
        if (direct_) {
            direct_->add(point, met.direct);
        } else {
            add_direct_light(seen, LeavingRays(point.surface), met.direct);
        }
        if (seen.depth < conventions_.max_depth) {
            if (conventions_.trace_reflections) reflect(seen, met, front.next);
            if (conventions_.trace_refractions) transmit(seen, met, front);
        }
        if (!tracks_media()) return;
        met.filter = tint_along(conventions_, point, scene_.is_closed(point.surface.part), tinted_,
                                seen.path.medium, seen.t);
        met.filtered = met.filter != Rgb{1, 1, 1};
    }

    /// True if an eye ray that has met this surface first starts inside its solid. Solids that rays
    /// may enter without a trace, by alpha, are left out.
    [[nodiscard]] bool starts_inside(const ShadingPoint& point, const MetSurface& met) const {
        return !point.entering && met.share == Rgb{1, 1, 1} &&
               scene_.is_closed(point.surface.part) &&
               !scene_.material_of(point.surface).may_be_passed();
    }
    /// True if kt acts by distance; exact optics track media by themselves.
    [[nodiscard]] bool tracks_media() const { return conventions_.tints_by_distance() && !optics_; }

    void add_direct_light(const Seen& seen, const LeavingRays& from, Rgb& sum) {
        const ShadingPoint& point = seen.point;
        for (const std::size_t here : shadow_lights_) {
            const LightSample l =
                random_.light_from(scene_.lights[here], here, point.surface.point,
                                   conventions_.clamp_attenuation, seen.path, seen.depth);
            const double cosine = dot(point.normal, l.to_light);
            if (!(cosine > 0.0)) continue;
            const Path& path = path_along(seen, l.to_light);
            if constexpr (TreeWatcher<Randomness>) random_.see_light(here, l, cosine, path);
            if (l.intensity.is_black()) continue;  // beyond the cone of a spot
            if (shadows_.casts_at_once()) {
                const Rgb through = shadows_.arriving(from, l, path);
                if (through.is_black()) continue;
                sum += through * l.intensity * reflected_fraction(conventions_, point, l, cosine);
                continue;
            }
            shadows_.add(from, l, reflected_fraction(conventions_, point, l, cosine), path, sum,
                         here);
        }
    }

    /// Changes the path of the ray that met the surface to that of a ray that the surface sends on.
    static void send_on(const Seen& seen, RayKind kind, const Rgb& contribution, Path& path) {
        path.kind = kind;
        path.contribution = contribution;
        path.cone = seen.path.cone.from(seen.t);
    }

    void reflect(const Seen& seen, MetSurface& met, Generation& next) {
        const ShadingPoint& point = seen.point;
        const Rgb& kr = point.material->reflective;
        const bool cast = !kr.is_black() || (conventions_.transmitting_surfaces_reflect &&
                                             !point.material->transmissive.is_black());
        if (!cast) return;
        const Rgb contribution = seen.path.contribution * met.share * kr;
        if (contribution.max() < conventions_.min_contribution) return;
        Vec3 direction = mirror(seen.ray.direction, point.normal);
        // Where an interpolated normal reflects the ray into the surface, the geometric one is
        // used.
        if (conventions_.correct_interpolated_normals && dot(direction, point.geometric) < 0.0) {
            direction = mirror(seen.ray.direction, point.geometric);
        }
        random_.spread(RayKind::Reflection, point, seen.path, seen.depth, direction);
        met.kr = kr;
        // Copied as a whole and then changed: a local path would be copied in pieces.
        met.reflected = next.add(onward_ray(conventions_, point.surface, direction),
                                 path_along(seen, direction));
        send_on(seen, RayKind::Reflection, contribution, next.last_path());
    }

    void transmit(const Seen& seen, MetSurface& met, Wavefront& front) {
        const ShadingPoint& point = seen.point;
        const MaterialSample& material = *point.material;
        const Rgb& kt = point.passing;
        if (kt.is_black()) return;
        const Rgb contribution = seen.path.contribution * met.share * kt;
        if (contribution.max() < conventions_.min_contribution) return;
        const bool tinted =
            optics_ || material.physical ||
            conventions_.refraction_tint == ShadingConventions::RefractionTint::PerEvent;
        if (!material.thin && seen.path.nm == 0.0f && disperses(seen)) {
            split(seen, contribution, met, front);
        } else {
            met.refracted = send_refracted(seen, contribution, seen.path.nm, front.next);
        }
        if (met.refracted != MetSurface::kNotSent) met.kt = tinted ? kt : point.sheets;
    }

    /// The path of the ray that met the surface, in the medium of a ray that leaves the surface
    /// along the direction. Valid until `finish_light`.
    [[nodiscard]] const Path& path_along(const Seen& seen, const Vec3& direction) {
        if (!goes_behind(seen.point, direction) || !bounds_media(seen.point)) return seen.path;
        if (path_behind_ == nullptr) {
            path_behind_ = &paths_behind_.emplace_back(seen.path);
            set_medium_behind(seen, *path_behind_);
        }
        return *path_behind_;
    }
    void set_medium_behind(const Seen& seen, Path& onward) {
        const ShadingPoint& point = seen.point;
        static_cast<RayMedium&>(onward) =
            medium_behind(point, scene_.is_closed(point.surface.part),
                          tracks_media() ? &tinted_ : nullptr, seen.path);
        if (optics_) onward.medium = point.behind.medium;
        if (scene_.has_masks) hide_from_shadows(seen, onward);
    }

    /// Marks the volume that a ray enters if shadow rays do not see it.
    void hide_from_shadows(const Seen& seen, Path& onward) {
        const ShadingPoint& point = seen.point;
        const bool enters = point.surface.media.known ? point.behind.inside : point.entering;
        const RayMask seen_by = mask_at(*scene_.aggregate, visible_.reported_hit());
        if (!enters || (seen_by & mask_of(RayKind::Shadow)) != 0) return;
        onward.hidden = true;
        if (onward.medium == seen.path.medium) return;
        optics_ ? optics_->hide(onward.medium, point.surface) : tinted_.hide(onward.medium);
    }

    /// Adds a refracted ray for each wavelength.
    void split(const Seen& seen, const Rgb& contribution, MetSurface& met, Wavefront& front) {
        met.split = true;
        met.refracted = static_cast<std::uint32_t>(front.split.size());
        for (const WaveSplit::Wave& wave : split_->waves()) {
            const float nm = static_cast<float>(wave.nm);
            front.split.push_back(send_refracted(seen, contribution, nm, front.next));
        }
    }

    /// Adds a refracted ray and returns its number; kNotSent for total internal reflection.
    std::uint32_t send_refracted(const Seen& seen, const Rgb& contribution, float nm,
                                 Generation& next) {
        const ShadingPoint& point = seen.point;
        Vec3 direction = seen.ray.direction;
        if (!point.material->thin && !refracted(point, seen.ray, eta_of(seen, nm), direction)) {
            ++counters_.total_internal;
            return MetSurface::kNotSent;
        }
        random_.spread(RayKind::Refraction, point, seen.path, seen.depth, direction);
        const std::uint32_t number = next.add(onward_ray(conventions_, point.surface, direction),
                                              path_along(seen, direction));
        send_on(seen, RayKind::Refraction, contribution, next.last_path());
        next.last_path().nm = nm;
        return number;
    }

    /// Refractive index on the side of the ray over that behind, at wavelength `nm`; 0: without
    /// dispersion.
    [[nodiscard]] double eta_of(const Seen& seen, double nm) const {
        const ShadingPoint& point = seen.point;
        if (nm > 0.0) {
            if (optics_) return optics_->eta_by_wave(seen.path.medium, point, nm);
            return point.behind.joined ? touching_->eta_by_wave(nm)
                                       : eta_by_wave(scene_, point, nm);
        }
        const double air = conventions_.air_index;
        if (point.behind.known) return point.behind.eta;
        return refracts_inward(conventions_, point) ? air / point.material->index
                                                    : point.material->index / air;
    }
    [[nodiscard]] bool disperses(const Seen& seen) const {
        return split_ != nullptr && eta_of(seen, kLineF) != eta_of(seen, kLineC);
    }

    [[nodiscard]] bool refracted(const ShadingPoint& point, const Ray& ray, double eta,
                                 Vec3& direction) const {
        if (!refract(ray.direction, point.normal, eta, direction)) return false;
        return !conventions_.correct_interpolated_normals ||
               !(dot(direction, point.geometric) > 0.0) ||
               refract(ray.direction, point.geometric, eta, direction);
    }

    const RenderJob& job_;
    const Scene& scene_;
    const ShadingConventions& conventions_;
    RayCounters& counters_;
    std::size_t rays_at_once_;
    Path eye_path_;  ///< of every eye ray; as a local it is kept in pieces and copied slowly
    const std::vector<Rgb> ambient_;
    std::vector<std::size_t> shadow_lights_;  ///< numbers of the lights with shadow rays
    std::span<Hit> eye_hits_;                 ///< see keep_hits
    std::span<const Hit> known_hits_;         ///< see start_from
    VisibleBatch visible_;
    ShadowBatch shadows_;
    Randomness random_;
    const WaveSplit* split_;
    const Rgb unhindered_;                   ///< the background as seen by a ray that meets nothing
    std::optional<DirectLight> direct_;      ///< in place of `shadows_` if it covers the scene
    std::optional<ExactOptics> optics_;      ///< if the scene has exact optics
    std::optional<TouchingFaces> touching_;  ///< if it has none, and not all is opaque
    TintedMedia tinted_;                     ///< if it has none
    std::optional<MediaFinder> finder_;   ///< of the volumes around the eye; if not all is opaque
    std::vector<Path> eye_paths_;         ///< [sample] of eye rays
    std::deque<Path> paths_behind_;       ///< of surfaces whose light waits
    Path* path_behind_ = nullptr;         ///< of the surface that is shaded; null: not needed
    std::vector<std::uint32_t> gone_on_;  ///< eye rays with another cone than at their start
    std::deque<Wavefront> fronts_;        ///< [depth]; references stay valid while it grows
};

}  // namespace alhazen

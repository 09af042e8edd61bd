#pragma once
/// The lights of an `Illumination`, sorted by how they are chosen and sampled.
///
/// Internal to the source files of `Illumination` and `LightDraws`.
/// Conventions: near lights are numbered in this order: the emitters of the scene, those of
/// invisible area lights (`hidden`), `points`. Far lights: `parallel`, the environment. Sources
/// of `emit`: near lights, far lights. `points` and `parallel` are indices into Scene::lights.

#include <memory>
#include <vector>

#include "alhazen/illumination/area_lanes.h"
#include "alhazen/illumination/emitter_list.h"
#include "alhazen/illumination/illumination.h"
#include "alhazen/illumination/light_chooser.h"
#include "alhazen/illumination/light_tree.h"
#include "alhazen/illumination/light_tree_lanes.h"
#include "alhazen/shading/lights/environment.h"

namespace alhazen {

/// Prefetches an emitter: those of many lights are not in the cache.
template <class AnyEmitter>
[[gnu::always_inline]] inline void fetch(const AnyEmitter& emitter) {
    constexpr std::size_t kLine = 64;
    const auto* const bytes = reinterpret_cast<const char*>(&emitter);
    for (std::size_t at = 0; at < sizeof(emitter); at += kLine) __builtin_prefetch(bytes + at);
}

struct Illumination::Data {
    Data(const Scene& scene, const IlluminationOptions& options);

    const Scene* scene;
    IlluminationOptions options;
    EmitterList emitters;
    std::vector<Emitter> hidden;
    std::vector<std::size_t> points;    ///< point and spot lights with quadratic falloff
    std::vector<std::size_t> parallel;  ///< directional lights, and points without that falloff
    std::shared_ptr<const Environment> environment;  ///< null: black
    Vec3 center;                                     ///< of a sphere around the scene
    double radius = 1;
    bool endless = false;  ///< the scene has unbounded geometry

    /// [emitter of the scene] What samples by area read; empty for few lights, which all stay in
    /// the cache.
    std::vector<FlatEmitter> flat;
    std::vector<Spectrum> flat_radiances;  ///< as colour channels

    LightChooser near;      ///< for choices Uniform and Power
    LightTree tree;         ///< for choice Tree
    LightChooser far;       ///< [of parallel, then environment]
    double near_share = 0;  ///< probability that a near light is chosen
    double rounding = 0;    ///< Illumination::rounding
    LightChooser sources;   ///< for `emit`, by power
    LightChooser picked;    ///< for `pick`, by power

    [[nodiscard]] std::size_t near_count() const {
        return emitters.size() + hidden.size() + points.size();
    }
    /// True if a ray of `emit` of a far light along `direction` reaches the point `lit`. Such rays
    /// begin on the disc in front of the sphere, or in front of all unbounded geometry.
    [[nodiscard]] bool reaches(const Vec3& direction, const Vec3& lit) const {
        const Vec3 from_center = lit - center;
        const double along = dot(from_center, direction);
        return (endless || along >= -radius) &&
               length_squared(from_center - along * direction) <= radius * radius;
    }
    /// The point or spot light of a source, near or far; null: another light.
    [[nodiscard]] const Light* light_at_point(std::size_t source) const {
        if (source < near_count()) return point_light(source);
        const std::size_t far_light = source - near_count();
        if (is_environment(far_light)) return nullptr;
        const Light& light = scene->lights[parallel[far_light]];
        return place_of(light) == LightPlace::Point ? &light : nullptr;
    }
    [[nodiscard]] bool is_environment(std::size_t far_light) const {
        return far_light == parallel.size();
    }
    /// An emitter, of the scene or hidden.
    [[nodiscard]] const Emitter& emitter(std::size_t near_light) const {
        return near_light < emitters.size() ? emitters[near_light]
                                            : hidden[near_light - emitters.size()];
    }
    /// A near point or spot light; null: an emitter.
    [[nodiscard]] const Light* point_light(std::size_t near_light) const {
        const std::size_t surfaces = emitters.size() + hidden.size();
        return near_light < surfaces ? nullptr : &scene->lights[points[near_light - surfaces]];
    }
    /// True if a near light is an emitter, of the scene or hidden.
    [[nodiscard]] bool is_emitter(std::size_t near_light) const {
        return near_light < emitters.size() + hidden.size();
    }
    /// The far light of a `choice` of `Illumination::draw`, with its whole probability.
    [[nodiscard]] ChosenLight choose_far(double choice) const {
        const ChosenLight chosen = far.choose((choice - near_share) / (1.0 - near_share));
        return {chosen.light, (1.0 - near_share) * chosen.probability};
    }
    /// `Illumination::draw` of a far light.
    [[nodiscard]] LightDraw draw_far(const ChosenLight& chosen, const LitPoint& at, const Vec2& u,
                                     const Wavelengths& waves) const;
    /// `draw_far` of the environment, sampled in `direction`.
    [[nodiscard]] LightDraw draw_sky(const ChosenLight& chosen, const LitPoint& at,
                                     const Vec3& direction, const Wavelengths& waves) const;
    /// `Illumination::draw` of a near light, chosen with `probability`.
    [[nodiscard]] LightDraw draw_near(std::size_t light, double probability, const LitPoint& at,
                                      const Vec2& u, const Wavelengths& waves) const;
    /// `Illumination::draw` of an emitter, chosen with `probability` and sampled as `s`.
    [[nodiscard]] LightDraw draw_of_emitter(std::size_t light, double probability, const Vec3& at,
                                            const EmitterSample& s, const Wavelengths& waves) const;
    /// The radiance of an emitter of the scene, if it is the same everywhere; else null.
    [[nodiscard]] const Rgb* constant_radiance(std::size_t light) const {
        return light < emitters.size() ? emitters.constant_radiance(light) : nullptr;
    }
    [[nodiscard]] ChosenLight choose_near(const LitPoint& at, double choice) const {
        return options.choice == LightChoice::Tree ? tree.choose(at, choice) : near.choose(choice);
    }
    /// `choose_near` for the first `count` points.
    void choose_near(const LitPointLanes& at, const ChoiceLanes& choices, std::size_t count,
                     ChosenLight* chosen) const {
        if (options.choice == LightChoice::Tree) {
            static_assert(sizeof(FlatEmitter) == sizeof(LightRecord));
            return choose_lights(tree, at, choices, count, chosen,
                                 reinterpret_cast<const LightRecord*>(flat.data()));
        }
        for (std::size_t i = 0; i < count; ++i) chosen[i] = near.choose(choices.of[i]);
    }
    [[nodiscard]] double probability_of_near(const LitPoint& at, std::size_t light) const {
        return options.choice == LightChoice::Tree ? tree.probability(at, light)
                                                   : near.probability(light);
    }
    [[nodiscard]] double probability_of_environment() const {
        return (1.0 - near_share) * far.probability(parallel.size());
    }

  private:
    void sort_lights();
    [[nodiscard]] TreeLight tree_light(std::size_t near_light) const;
    void set_choices();
    void set_flat();
    void set_sources();
};

}  // namespace alhazen

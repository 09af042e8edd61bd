#include "alhazen/illumination/illumination.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "alhazen/base/overloaded.h"
#include "alhazen/illumination/emitters_of_light.h"
#include "alhazen/illumination/illumination_data.h"
#include "alhazen/math/constants.h"
#include "alhazen/scene/scene_sphere.h"
#include "alhazen/shading/lights/ies_profile.h"

namespace alhazen {

namespace {

/// Smallest probability of near lights and of far lights, if the scene has both.
constexpr double kLeastShare = 0.25;

/// Near lights that stay in the cache.
constexpr std::size_t kCachedLights = 64;

double mean_channel(const Rgb& c) {
    return (c.r + c.g + c.b) / 3.0;
}

/// Largest intensity of an emitter over all directions: radiance times projected area.
double intensity_of(const Emitter& e) {
    const double radiance = mean_channel(e.radiance);
    switch (e.form) {
        case EmitterForm::Sphere:
            return radiance * e.area / 4.0;
        case EmitterForm::Tube:
            return radiance * e.area / kPi;
        case EmitterForm::Patch:
            return radiance * e.area / 2.0;
        default:
            return radiance * e.area;
    }
}

const Attenuation& attenuation_of(const Light& light) {
    const auto* point = std::get_if<PointLight>(&light);
    return point != nullptr ? point->attenuation : std::get<SpotLight>(light).attenuation;
}

const Rgb& color_of(const Light& light) {
    return std::visit(Overloaded{[](const AmbientLight& l) -> const Rgb& { return l.ambient; },
                                 [](const AreaLight& l) -> const Rgb& { return l.radiance; },
                                 [](const auto& l) -> const Rgb& { return l.color; }},
                      light);
}

}  // namespace

Illumination::Data::Data(const Scene& of, const IlluminationOptions& how)
    : scene(&of), options(how), emitters(of) {
    const BoundingSphere around = sphere_around_bounded(of);
    center = around.center;
    radius = around.radius;
    endless = reaches_infinity(of);
    environment = of.environment;
    if (!environment && of.background.max() > 0.0 && of.background.is_finite()) {
        environment = std::make_shared<const Environment>(
            EnvironmentSettings{.color = of.background}, Vec3{0, 1, 0});
    }
    if (environment && !environment->emits()) environment = nullptr;
    sort_lights();
    set_choices();
    set_sources();
    set_flat();
}

void Illumination::Data::sort_lights() {
    for (std::size_t i = 0; i < scene->lights.size(); ++i) {
        const Light& light = scene->lights[i];
        if (!illuminates(light) || !(color_of(light).max() > 0.0)) continue;
        if (const auto* area = std::get_if<AreaLight>(&light)) {
            // Visible area lights are parts of the scene, with emitters of their own.
            if (!area->is_part) append_emitters_of_light(*area, hidden);
        } else if (place_of(light) == LightPlace::Point && attenuation_of(light).quadratic > 0.0) {
            points.push_back(i);
        } else {
            parallel.push_back(i);
        }
    }
}

TreeLight Illumination::Data::tree_light(std::size_t near_light) const {
    const Light* light = point_light(near_light);
    if (light == nullptr) {
        const Emitter& e = emitter(near_light);
        if (!(e.area > 0.0)) return {};
        return {bounds_of(e), e.two_sided, intensity_of(e), 0.0};
    }
    TreeLight result;
    result.intensity = kPi * mean_channel(color_of(*light)) / attenuation_of(*light).quadratic;
    if (const auto* spot = std::get_if<SpotLight>(light)) {
        result.intensity *= largest_factor(spot->profile);
        result.bounds.box.include(spot->position);
        result.bounds.center = spot->position;
        result.bounds.axis = spot->direction;
        result.cosine_reach = std::cos(spot->outer_angle);
    } else {
        const auto& point = std::get<PointLight>(*light);
        result.intensity *= largest_factor(point.profile);
        result.bounds.box.include(point.position);
        result.bounds.center = point.position;
        result.bounds.cosine_spread = -1.0;
        result.cosine_reach = -1.0;
    }
    return result;
}

void Illumination::Data::set_choices() {
    std::vector<double> near_weights, far_weights;
    std::vector<TreeLight> tree_lights;
    double intensity = 0.0;
    for (std::size_t i = 0; i < near_count(); ++i) {
        const TreeLight light = tree_light(i);
        intensity += light.intensity;
        if (i < emitters.size() && light.intensity > 0.0) {
            rounding = std::max(rounding, emitters.rounding(i));
        }
        near_weights.push_back(options.choice != LightChoice::Uniform ? light.intensity
                               : light.intensity > 0.0                ? 1.0
                                                                      : 0.0);
        if (options.choice == LightChoice::Tree) tree_lights.push_back(light);
    }
    tree = LightTree(tree_lights);
    for (const std::size_t i : parallel) {
        far_weights.push_back(kPi * mean_channel(color_of(scene->lights[i])));
    }
    if (environment) far_weights.push_back(kPi * mean_channel(environment->mean()));
    near = LightChooser(near_weights);
    far = LightChooser(far_weights);
    if (near.total() > 0.0 && far.total() > 0.0) {
        const double irradiance = intensity / (radius * radius);
        near_share =
            std::clamp(irradiance / (irradiance + far.total()), kLeastShare, 1.0 - kLeastShare);
    } else {
        near_share = near.total() > 0.0 ? 1.0 : 0.0;
    }
}

void Illumination::Data::set_flat() {
    if (near_count() <= kCachedLights) return;
    emitters.prefer_area();
    flat.reserve(emitters.size());
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        const Rgb* const radiance = constant_radiance(i);
        if (radiance == nullptr) {
            flat.emplace_back();
            continue;
        }
        // Emitters of a material follow each other.
        const Spectrum light = kColorChannels.emission(*radiance);
        if (flat_radiances.empty() || !(flat_radiances.back() == light)) {
            flat_radiances.push_back(light);
        }
        flat.emplace_back(emitters[i], static_cast<std::uint32_t>(flat_radiances.size() - 1));
    }
}

Illumination::Illumination(const Scene& scene, const IlluminationOptions& options)
    : data_(std::make_unique<const Data>(scene, options)), rounding_(data_->rounding) {}
Illumination::~Illumination() = default;
Illumination::Illumination(Illumination&&) noexcept = default;
Illumination& Illumination::operator=(Illumination&&) noexcept = default;

bool Illumination::emits() const {
    return data_->near.total() > 0.0 || data_->far.total() > 0.0 || data_->emitters.may_shine();
}

bool Illumination::has_unsampled_emitters() const {
    return data_->emitters.has_unsampled_emitters();
}

namespace {

/// Draws a singular light that was chosen with `probability`.
LightDraw draw_singular(const Scene& scene, const Light& light, const LitPoint& at,
                        double probability, const Wavelengths& waves) {
    const LightSample s = sample(light, at.point, scene.conventions.shading.clamp_attenuation);
    LightDraw draw;
    if (s.intensity.is_black() || !s.intensity.is_finite()) return draw;
    draw.to_light = s.to_light;
    draw.distance = s.distance;
    draw.radiance = waves.emission(kPi * s.intensity);
    draw.density = probability;
    draw.singular = true;
    return draw;
}

Environment::Sight sight_for(const Environment& environment, const LitPoint& at,
                             const Vec3& direction) {
    return at.in_volume ? environment.sight(direction)
                        : environment.sight(at.normal, at.both_sides, direction);
}

/// The density of `draw_environment` for a direction, without the probability of the environment.
double density_for(const Environment& environment, const LitPoint& at, const Vec3& direction) {
    return at.in_volume ? environment.density(direction)
                        : environment.density(at.normal, at.both_sides, direction);
}

Vec3 sample_for(const Environment& environment, const LitPoint& at, const Vec2& u) {
    return at.in_volume ? environment.sample(u) : environment.sample(at.normal, at.both_sides, u);
}

/// Draws the environment, sampled in `direction`.
LightDraw draw_environment(const Environment& environment, const LitPoint& at, double probability,
                           const Vec3& direction, const Wavelengths& waves) {
    LightDraw draw;
    draw.to_light = direction;
    draw.distance = kInfinity;
    const Environment::Sight sight = sight_for(environment, at, direction);
    draw.radiance = waves.emission(sight.radiance);
    draw.density = probability * sight.density;
    return draw;
}

}  // namespace

bool Illumination::chooses() const {
    const Data& d = *data_;
    const bool one_near = d.near_share == 1.0 && d.near_count() == 1;
    return !(one_near || (d.near_share == 0.0 && d.far.size() == 1));
}

LightDraw Illumination::Data::draw_far(const ChosenLight& chosen, const LitPoint& at, const Vec2& u,
                                       const Wavelengths& waves) const {
    if (!(chosen.probability > 0.0)) return {};
    if (is_environment(chosen.light)) {
        return draw_sky(chosen, at, sample_for(*environment, at, u), waves);
    }
    LightDraw draw =
        draw_singular(*scene, scene->lights[parallel[chosen.light]], at, chosen.probability, waves);
    draw.place.source = near_count() + chosen.light;
    return draw;
}

LightDraw Illumination::Data::draw_sky(const ChosenLight& chosen, const LitPoint& at,
                                       const Vec3& direction, const Wavelengths& waves) const {
    LightDraw draw = draw_environment(*environment, at, chosen.probability, direction, waves);
    draw.place.source = near_count() + chosen.light;
    return draw;
}

LightDraw Illumination::Data::draw_near(std::size_t light, double probability, const LitPoint& at,
                                        const Vec2& u, const Wavelengths& waves) const {
    if (is_emitter(light)) {
        return draw_of_emitter(light, probability, at.point, sample(emitter(light), at.point, u),
                               waves);
    }
    LightDraw draw = draw_singular(*scene, *point_light(light), at, probability, waves);
    draw.place.source = light;
    return draw;
}

LightDraw Illumination::Data::draw_of_emitter(std::size_t light, double probability, const Vec3& at,
                                              const EmitterSample& s,
                                              const Wavelengths& waves) const {
    if (!(s.density > 0.0) || !std::isfinite(s.density)) return {};
    LightDraw draw;
    draw.place = {light, s.parameters};
    draw.to_light = s.to_light;
    draw.distance = s.distance;
    draw.density = probability * s.density;
    if (light < emitters.size()) {
        draw.facing = s.facing;
        draw.radiance =
            waves.emission(emitters.radiance(light, at, s.to_light, s.distance, s.parameters),
                           emitters[light].illuminant);
    } else {
        // Invisible area lights are sampled as singular lights, with their irradiance.
        draw.radiance = waves.emission((1.0 / s.density) * emitter(light).radiance);
        draw.density = probability;
        draw.singular = true;
    }
    return draw;
}

LightDraw Illumination::draw(const LitPoint& at, double choice, const Vec2& u,
                             const Wavelengths& waves) const {
    const Data& d = *data_;
    if (choice >= d.near_share) return d.draw_far(d.choose_far(choice), at, u, waves);
    const ChosenLight chosen = d.choose_near(at, choice / d.near_share);
    const double probability = d.near_share * chosen.probability;
    return probability > 0.0 ? d.draw_near(chosen.light, probability, at, u, waves) : LightDraw{};
}

double Illumination::density(const LitPoint& at, const Ray& ray, const Hit& hit,
                             const Surface& surface, double distance) const {
    const std::optional<std::size_t> found = data_->emitters.find(hit);
    if (!found) return 0.0;
    const Emitter& emitter = data_->emitters[*found];
    fetch(emitter);
    const double probability = data_->near_share * data_->probability_of_near(at, *found);
    if (!(probability > 0.0)) return 0.0;
    const EmitterHit there{normalize(ray.direction), distance, surface.normal, {hit.u, hit.v}};
    return probability * alhazen::density(emitter, at.point, there);
}

bool Illumination::has_environment() const {
    return data_->environment != nullptr;
}

Spectrum Illumination::environment(const Vec3& direction, const Wavelengths& waves) const {
    return data_->environment ? waves.emission(data_->environment->radiance(direction))
                              : Spectrum{};
}

double Illumination::environment_density(const LitPoint& at, const Vec3& direction) const {
    if (!data_->environment) return 0.0;
    return data_->probability_of_environment() * density_for(*data_->environment, at, direction);
}

Illumination::FarLight Illumination::far_light(const LitPoint& at, const Vec3& direction,
                                               const Wavelengths& waves) const {
    if (!data_->environment) return {};
    const Environment::Sight sight = sight_for(*data_->environment, at, direction);
    return {waves.emission(sight.radiance), data_->probability_of_environment() * sight.density};
}

bool Illumination::has_sky_picture() const {
    return data_->environment && data_->environment->has_picture();
}

void Illumination::find_far_lights(std::span<const Vec3> directions, FarLight* lights) const {
    constexpr std::size_t kAtOnce = 16;
    std::array<Environment::Sight, kAtOnce> sights;
    const double probability = data_->probability_of_environment();
    for (std::size_t done = 0; done < directions.size(); done += kAtOnce) {
        const std::size_t count = std::min(kAtOnce, directions.size() - done);
        data_->environment->find_sights(directions.subspan(done, count), sights.data());
        for (std::size_t i = 0; i < count; ++i) {
            lights[done + i] = {kColorChannels.emission(sights[i].radiance),
                                probability * sights[i].density};
        }
    }
}

}  // namespace alhazen

#include "alhazen/shading/lights/environment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/shading/lights/clear_sky.h"
#include "alhazen/shading/lights/direction_lanes.h"
#include "alhazen/shading/lights/light_extent.h"
#include "alhazen/shading/lights/studio.h"

namespace alhazen {

namespace {

Vec3 up_of(const EnvironmentSettings& settings, const Vec3& scene_up) {
    return unit_or(settings.up.value_or(scene_up), {0, 1, 0});
}

/// The frame before the rotation.
Mat3 picture_frame(const Vec3& up) {
    const Vec3 right = unit_or(Vec3{1, 0, 0} - up.x * up, perpendicular(up));
    return {right, cross(up, right), up};
}

/// Default direction of the sun: over the right shoulder of a viewer who faces the front.
Vec3 usual_sun(const Mat3& frame) {
    const double high = 40 * kRadiansPerDegree, aside = 40 * kRadiansPerDegree;
    return frame * Vec3{std::cos(high) * std::sin(aside), -std::cos(high) * std::cos(aside),
                        std::sin(high)};
}

double mean_of_sky(const Rgb& c) {
    return (c.r + c.g + c.b) / 3.0;
}

}  // namespace

Environment::Environment(const EnvironmentSettings& settings, const Vec3& scene_up)
    : factor_(settings.scale * settings.color) {
    const Vec3 up = up_of(settings, scene_up);
    const Mat3 still = picture_frame(up);
    const Mat3 turn = Affine::rotate(up, settings.rotation).linear;
    world_from_picture_ = turn * still;
    switch (settings.kind) {
        case EnvironmentKind::Constant:
            break;
        case EnvironmentKind::Picture:
            picture_.emplace(*settings.picture);
            break;
        case EnvironmentKind::Studio:
            picture_.emplace(studio_picture());
            break;
        case EnvironmentKind::Sky: {
            const Vec3 usual = usual_sun(still);
            const Vec3 to_sun = unit_or(settings.to_sun.value_or(usual), usual);
            ClearSky sky =
                clear_sky(transpose_times(still, to_sun), settings.turbidity, settings.ground);
            picture_.emplace(std::move(sky.picture));
            if (sky.sun_radiance.max() > 0.0) {
                sun_ = SunDisc{turn * to_sun, std::cos(kSunRadius), sky.sun_radiance};
                const double of_sun = sun_solid_angle() * mean_of_sky(sun_->radiance);
                const double of_sky = 4.0 * kPi * mean_of_sky(picture_->mean());
                sun_share_ = std::clamp(of_sun / (of_sun + of_sky), 0.1, 0.9);
            }
            break;
        }
    }
    if (picture_ && picture_->is_black()) {
        bad_texels_ = picture_->bad_texels();
        picture_.reset();
        sun_.reset();
        factor_ = {};
    } else if (picture_) {
        bad_texels_ = picture_->bad_texels();
    }
}

double Environment::sun_solid_angle() const {
    return 2.0 * kPi * (1.0 - sun_->cosine);
}

Rgb Environment::radiance(const Vec3& direction) const {
    if (!picture_) return factor_;
    const Rgb sky = picture_->radiance(transpose_times(world_from_picture_, direction));
    return with_sun({sky, 0.0}, direction).radiance;
}

Environment::Sight Environment::with_sun(const Sight& sky, const Vec3& direction) const {
    const bool in_sun = is_in_sun(direction);
    return {factor_ * (in_sun ? sky.radiance + sun_->radiance : sky.radiance),
            (1.0 - sun_share_) * sky.density + (in_sun ? sun_share_ / sun_solid_angle() : 0.0)};
}

Environment::Sight Environment::sight(const Vec3& direction) const {
    if (!picture_) return {factor_, density(direction)};
    return with_sun(picture_->sight(transpose_times(world_from_picture_, direction)), direction);
}

Environment::Sight Environment::sight(const Vec3& normal, bool both_sides,
                                      const Vec3& direction) const {
    if (picture_) return sight(direction);
    return {factor_, density(normal, both_sides, direction)};
}

void Environment::find_directions(std::span<const Search> searches, Vec3* directions) const {
    picture_->find_directions(searches, directions);
    for (std::size_t i = 0; i < searches.size(); ++i) {
        directions[i] = world_from_picture_ * directions[i];
    }
}

void Environment::find_sights(std::span<const Vec3> directions, Sight* sights) const {
    constexpr std::size_t kAtOnce = DirectionLanes::kMost;
    std::array<Vec3, kAtOnce> inner;
    for (std::size_t done = 0; done < directions.size(); done += kAtOnce) {
        const std::size_t count = std::min(kAtOnce, directions.size() - done);
        const std::span<const Vec3> some = directions.subspan(done, count);
        for (std::size_t i = 0; i < count; ++i) {
            inner[i] = transpose_times(world_from_picture_, some[i]);
        }
        picture_->find_sights(std::span(inner).first(count), sights + done);
        for (std::size_t i = 0; i < count; ++i) {
            sights[done + i] = with_sun(sights[done + i], some[i]);
        }
    }
}

Rgb Environment::mean() const {
    if (!picture_) return factor_;
    const Rgb sky = picture_->mean();
    if (!sun_) return factor_ * sky;
    return factor_ * (sky + sun_solid_angle() / (4.0 * kPi) * sun_->radiance);
}

Vec3 Environment::sample(const Vec3& normal, bool both_sides, const Vec2& u) const {
    if (picture_) return sample(u);
    // Cosine-weighted; for two sides the hemisphere is mirrored with probability 1/2.
    const bool behind = both_sides && u.x < 0.5;
    const double x = both_sides ? (behind ? 2.0 * u.x : 2.0 * u.x - 1.0) : u.x;
    const Vec2 p = on_unit_disc({x, u.y});
    const double z = std::sqrt(std::max(0.0, 1.0 - p.x * p.x - p.y * p.y));
    const Vec3 a = perpendicular(normal), b = cross(normal, a);
    return normalize(p.x * a + p.y * b + (behind ? -z : z) * normal);
}

double Environment::density(const Vec3& normal, bool both_sides, const Vec3& direction) const {
    if (picture_) return density(direction);
    const double cosine = dot(normal, direction);
    return both_sides ? std::abs(cosine) / (2.0 * kPi) : std::max(0.0, cosine) / kPi;
}

Vec3 Environment::sample(const Vec2& u) const {
    if (!picture_) {
        const double z = 1.0 - 2.0 * u.x, r = std::sqrt(std::max(0.0, 1.0 - z * z));
        return {r * std::cos(2.0 * kPi * u.y), r * std::sin(2.0 * kPi * u.y), z};
    }
    if (u.x < sun_share_) {
        const Vec2 p = on_unit_disc({u.x / sun_share_, u.y});
        const double height = (p.x * p.x + p.y * p.y) * (1.0 - sun_->cosine);
        const double scale = std::sqrt((1.0 - sun_->cosine) * (2.0 - height));
        const Vec3& z = sun_->direction;
        const Vec3 a = perpendicular(z), b = cross(z, a);
        return normalize((1.0 - height) * z + (scale * p.x) * a + (scale * p.y) * b);
    }
    return world_from_picture_ * picture_->sample(in_sky(u));
}

double Environment::density(const Vec3& direction) const {
    if (!picture_) return 1.0 / (4.0 * kPi);
    const double of_sky = picture_->density(transpose_times(world_from_picture_, direction));
    return with_sun({{}, of_sky}, direction).density;
}

}  // namespace alhazen

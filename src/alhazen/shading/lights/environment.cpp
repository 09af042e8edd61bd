#include "alhazen/shading/lights/environment.h"

#include <algorithm>
#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/shading/lights/light_extent.h"

namespace alhazen {

namespace {

Mat3 picture_frame(const EnvironmentSettings& settings, const Vec3& scene_up) {
    const Vec3 up = unit_or(settings.up.value_or(scene_up), {0, 1, 0});
    const Vec3 right = unit_or(Vec3{1, 0, 0} - up.x * up, perpendicular(up));
    const Mat3 still{right, cross(up, right), up};
    return Affine::rotate(up, settings.rotation).linear * still;
}

}  // namespace

Environment::Environment(const EnvironmentSettings& settings, const Vec3& up)
    : world_from_picture_(picture_frame(settings, up)),
      factor_(settings.scale * settings.color) {
    if (settings.kind == EnvironmentKind::Picture) picture_.emplace(*settings.picture);
    if (picture_ && picture_->is_black()) {
        picture_.reset();
        factor_ = {};
    }
}

double Environment::sun_solid_angle() const {
    return 2.0 * kPi * (1.0 - sun_->cosine);
}

Rgb Environment::radiance(const Vec3& direction) const {
    if (!picture_) return factor_;
    const Rgb sky = picture_->radiance(transpose_times(world_from_picture_, direction));
    const bool in_sun = sun_ && dot(direction, sun_->direction) >= sun_->cosine;
    return factor_ * (in_sun ? sky + sun_->radiance : sky);
}

Rgb Environment::mean() const {
    if (!picture_) return factor_;
    const Rgb sky = picture_->mean();
    if (!sun_) return factor_ * sky;
    return factor_ * (sky + sun_solid_angle() / (4.0 * kPi) * sun_->radiance);
}

Vec3 Environment::sample(const Vec3& normal, bool both_sides, const Vec2& u) const {
    if (picture_) return sample(u);
    // By the cosine to the normal: its own mirror image is the same from behind.
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
    const double rest = std::min((u.x - sun_share_) / (1.0 - sun_share_), 0x1.fffffffffffffp-1);
    return world_from_picture_ * picture_->sample({rest, u.y});
}

double Environment::density(const Vec3& direction) const {
    if (!picture_) return 1.0 / (4.0 * kPi);
    const double of_sky = picture_->density(transpose_times(world_from_picture_, direction));
    const bool in_sun = sun_ && dot(direction, sun_->direction) >= sun_->cosine;
    return (1.0 - sun_share_) * of_sky + (in_sun ? sun_share_ / sun_solid_angle() : 0.0);
}

}  // namespace alhazen

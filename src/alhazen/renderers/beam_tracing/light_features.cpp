#include "alhazen/renderers/beam_tracing/light_features.h"

#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

constexpr int kRaysOfCone = 12;

class LightFeatures {
  public:
    LightFeatures(const FacetPlane& plane, const BeamApex& eye, std::vector<Vec3>& points)
        : plane_(plane), eye_(eye), points_(points) {}

    void operator()(const AmbientLight&) {}
    void operator()(const DirectionalLight& light) { add_mirrored({light.to_light, 0}); }
    void operator()(const PointLight& light) {
        add_near(light.position);
        if (light.profile.profile) add_ray(light.position, light.profile.down);
    }
    void operator()(const SpotLight& light) {
        add_near(light.position);
        if (light.profile.profile) add_ray(light.position, light.profile.down);
        const Vec3 &axis = light.direction, u = normalize(perpendicular(axis)), v = cross(axis, u);
        add_ray(light.position, axis);
        const double inner = light.inner_angle, outer = light.outer_angle;
        for (const double angle : {inner, 0.5 * (inner + outer), outer}) {
            for (int k = 0; k < kRaysOfCone; ++k) {
                const double turn = 2 * kPi * k / kRaysOfCone;
                const Vec3 away = std::cos(turn) * u + std::sin(turn) * v;
                add_ray(light.position, std::cos(angle) * axis + std::sin(angle) * away);
            }
        }
    }
    void operator()(const AreaLight& light) { add_near(light.surface->center()); }

  private:
    void add_near(const Vec3& position) {
        points_.push_back(position - plane_.at(position) * plane_.normal);
        add_mirrored({position, 1});
    }
    /// Adds the point of the plane on the line from the eye to the image of the light.
    void add_mirrored(const BeamApex& light) {
        const BeamApex image = SpaceMap::mirror(plane_)(light);
        const double of_eye = eye_.side(plane_), of_image = image.side(plane_);
        const double weight = eye_.weight * of_image - image.weight * of_eye;
        if (!(of_eye * of_image < 0.0) || weight == 0.0) return;
        points_.push_back((of_image * eye_.at - of_eye * image.at) / weight);
    }
    void add_ray(const Vec3& from, const Vec3& along) {
        const double t = -plane_.at(from) / dot(plane_.normal, along);
        if (t > 0.0 && std::isfinite(t)) points_.push_back(from + t * along);
    }

    const FacetPlane& plane_;
    const BeamApex& eye_;
    std::vector<Vec3>& points_;
};

}  // namespace

void add_light_features(const Light& light, const FacetPlane& plane, const BeamApex& eye,
                        std::vector<Vec3>& points) {
    std::visit(LightFeatures(plane, eye, points), light);
}

}  // namespace alhazen

#include "alhazen/formats/brlcad/brlcad_lights.h"

#include <algorithm>

#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

constexpr std::size_t kMaxLights = 1000;
/// Ambient light of `rt`, which comes from the eye.
constexpr double kAmbient = 0.4;
/// Fraction of full light of the brightest light.
constexpr double kBrightest = 1.0 / (1.0 + 0.5 * kAmbient);

class LightFinder {
  public:
    LightFinder(SceneDescription& scene, const BrlcadMaterials& materials, BrlcadBounds& bounds)
        : scene_(scene), materials_(materials), bounds_(bounds), holds_(scene.objects.size()) {}

    struct Found {
        const BrlcadLight* light = nullptr;
        Vec3 position;
        Vec3 aim;  ///< not normalised
        Part* part = nullptr;
    };

    /// Appends the lights of an object and its descendants; stops after kMaxLights + 1.
    void find(ObjectIndex object, const Affine& world_from_object, std::vector<Found>& found) {
        for (Part& part : scene_.objects[static_cast<std::size_t>(object)].parts) {
            if (found.size() > kMaxLights) return;
            if (const BrlcadLight* light = light_of(part)) {
                const Box3 box = bounds_.of(part);
                if (!box.empty() && box.bounded()) {
                    const Vec3 position = world_from_object.point(box.center());
                    const Vec3 down =
                        (world_from_object * object_from_first(part)).vector({0, 0, -1});
                    found.push_back(
                        {light, position, light->target ? *light->target - position : down, &part});
                }
            } else if (const auto* child = std::get_if<ObjectIndex>(&part.what);
                       child != nullptr && holds(*child)) {
                find(*child, world_from_object * part.object_from_part, found);
            }
        }
    }

  private:
    /// The light of a part that is a shape or a solid of shapes; null otherwise.
    const BrlcadLight* light_of(const Part& part) {
        const auto* child = std::get_if<ObjectIndex>(&part.what);
        if (child == nullptr) return materials_.light(part.material);
        const ObjectDescription& object = scene_.objects[static_cast<std::size_t>(*child)];
        if (object.combine == Combine::Group || object.parts.empty()) return nullptr;
        return light_of(object.parts[0]);
    }

    /// The transform of the first solid of a part.
    Affine object_from_first(const Part& part) {
        Affine transform = part.object_from_part;
        const auto* child = std::get_if<ObjectIndex>(&part.what);
        while (child != nullptr) {
            const Part& first = scene_.objects[static_cast<std::size_t>(*child)].parts[0];
            transform = transform * first.object_from_part;
            child = std::get_if<ObjectIndex>(&first.what);
        }
        return transform;
    }

    bool holds(ObjectIndex index) {
        const auto i = static_cast<std::size_t>(index);
        if (!holds_[i]) {
            bool any = false;
            for (const Part& part : scene_.objects[i].parts) {
                const auto* child = std::get_if<ObjectIndex>(&part.what);
                any = any || light_of(part) != nullptr || (child != nullptr && holds(*child));
            }
            holds_[i] = any;
        }
        return *holds_[i];
    }

    SceneDescription& scene_;
    const BrlcadMaterials& materials_;
    BrlcadBounds& bounds_;
    std::vector<std::optional<bool>> holds_;
};

/// Fractions of full light: those of the file; otherwise by intensity, where the brightest light
/// has kBrightest.
class Fractions {
  public:
    explicit Fractions(const BrlcadMaterials& materials) {
        for (const auto& [id, light] : materials.lights()) {
            if (light.fraction <= 0.0) brightest_ = std::max(brightest_, light.intensity);
        }
    }
    [[nodiscard]] double of(const BrlcadLight& light) const {
        return light.fraction > 0.0 ? light.fraction : kBrightest * light.intensity / brightest_;
    }

  private:
    double brightest_ = 1e-300;
};

Light make_light(const LightFinder::Found& found, double fraction) {
    const Rgb color = fraction * found.light->color;
    if (found.light->infinite && length(found.position) > 0.0) {
        DirectionalLight light;
        light.to_light = normalize(found.position);
        light.color = color;
        return light;
    }
    if (found.light->angle_deg < 180.0 && length(found.aim) > 0.0) {
        SpotLight light;
        light.position = found.position;
        light.direction = normalize(found.aim);
        light.inner_angle = light.outer_angle = found.light->angle_deg * kRadiansPerDegree;
        light.color = color;
        return light;
    }
    PointLight light;
    light.position = found.position;
    light.color = color;
    return light;
}

/// Adds the light of `rt` for a model without lights: white, beside the eye, without shadows.
void add_implicit_light(SceneDescription& scene) {
    if (scene.cameras.empty()) return;
    const auto* camera = std::get_if<OrthographicCamera>(&scene.cameras[0].camera);
    if (camera == nullptr) return;
    const double size = length(camera->right);
    PointLight light;
    light.position =
        camera->origin - 0.5 * camera->right - (0.5 * size) * normalize(camera->direction);
    light.color = {kBrightest, kBrightest, kBrightest};
    scene.lights.push_back({"implicit light", light, scene.cameras[0].location});
    scene.conventions.shading.shadow_tint = ShadingConventions::ShadowTint::None;
}

}  // namespace

void add_brlcad_lights(SceneDescription& scene, const BrlcadMaterials& materials,
                       BrlcadBounds& bounds, Diagnostics& diagnostics) {
    std::vector<LightFinder::Found> found;
    if (!materials.lights().empty()) {
        LightFinder(scene, materials, bounds).find(scene.root, Affine{}, found);
    }
    if (found.size() > kMaxLights) {
        diagnostics.error(found.back().part->location,
                          "more than " + std::to_string(kMaxLights) + " lights");
        return;
    }
    const Fractions fractions(materials);
    for (const auto& one : found) {
        scene.lights.push_back(
            {one.part->name, make_light(one, fractions.of(*one.light)), one.part->location});
        // The source is inside its solid, which therefore casts no shadows, visible or not.
        one.part->visible_to = kRaysOfAllKinds & ~mask_of(RayKind::Shadow);
    }
    for (const auto& [id, light] : materials.lights()) {
        // Half of its brightness depends on the view direction, as the ambient light does.
        Material& material = scene.materials[static_cast<std::size_t>(id)].material;
        const Rgb brightness = fractions.of(light) * light.color;
        const bool emits =
            std::any_of(found.begin(), found.end(),
                        [seen = &light](const auto& one) { return one.light == seen; });
        if (!light.shown || !emits) continue;
        material.transmissive.color = {0, 0, 0};
        material.emission.color = 0.5 * brightness;
        material.ambient.color = (0.5 / kAmbient) * brightness;
    }
    if (found.empty()) add_implicit_light(scene);
    if (scene.lights.empty()) return;
    const Rgb ambient{kAmbient, kAmbient, kAmbient};
    scene.lights.push_back({"ambient", AmbientLight{ambient}, scene.lights.front().location});
}

}  // namespace alhazen

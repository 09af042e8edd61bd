#include "alhazen/formats/brlcad/brlcad_lights.h"

namespace alhazen {

namespace {

constexpr std::size_t kMaxLights = 1000;
/// Share of full light that the lights have together.
constexpr double kDirect = 5.0 / 6.0;
/// BRL-CAD's ambient light of 0.4 comes from the eye; this is its mean over a visible sphere.
constexpr double kAmbient = 0.4 * 0.5;

class LightFinder {
  public:
    LightFinder(const SceneDescription& scene, const BrlcadMaterials& materials,
                BrlcadBounds& bounds)
        : scene_(scene), materials_(materials), bounds_(bounds), holds_(scene.objects.size()) {}

    struct Found {
        const BrlcadLight* light = nullptr;
        Vec3 position;
        const Part* part = nullptr;
    };

    /// Appends the lights of an object and its descendants; stops after kMaxLights + 1.
    void find(ObjectIndex object, const Affine& world_from_object, std::vector<Found>& found) {
        for (const Part& part : scene_.objects[static_cast<std::size_t>(object)].parts) {
            if (found.size() > kMaxLights) return;
            if (const BrlcadLight* light = light_of(part)) {
                const Box3 box = bounds_.of(part);
                if (!box.empty() && box.bounded()) {
                    found.push_back({light, world_from_object.point(box.center()), &part});
                }
            } else if (const auto* child = std::get_if<ObjectIndex>(&part.what);
                       child != nullptr && holds(*child)) {
                find(*child, world_from_object * part.object_from_part, found);
            }
        }
    }

  private:
    /// The light of a part that is a shape or a solid of shapes; else null.
    const BrlcadLight* light_of(const Part& part) {
        const auto* child = std::get_if<ObjectIndex>(&part.what);
        if (child == nullptr) return materials_.light(part.material);
        const ObjectDescription& object = scene_.objects[static_cast<std::size_t>(*child)];
        if (object.combine == Combine::Group || object.parts.empty()) return nullptr;
        return light_of(object.parts[0]);
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

    const SceneDescription& scene_;
    const BrlcadMaterials& materials_;
    BrlcadBounds& bounds_;
    std::vector<std::optional<bool>> holds_;
};

Light make_light(const LightFinder::Found& found, double share) {
    const Rgb color = share * found.light->color;
    if (found.light->infinite && length(found.position) > 0.0) {
        DirectionalLight light;
        light.to_light = normalize(found.position);
        light.color = color;
        return light;
    }
    PointLight light;
    light.position = found.position;
    light.color = color;
    return light;
}

}  // namespace

void add_brlcad_lights(SceneDescription& scene, const BrlcadMaterials& materials,
                       BrlcadBounds& bounds, Diagnostics& diagnostics) {
    if (!materials.has_lights()) return;
    std::vector<LightFinder::Found> found;
    LightFinder(scene, materials, bounds).find(scene.root, Affine{}, found);
    if (found.size() > kMaxLights) {
        diagnostics.error(found.back().part->location,
                          "more than " + std::to_string(kMaxLights) + " lights");
        return;
    }
    double sum = 0.0;
    for (const auto& one : found) sum += one.light->intensity;
    for (const auto& one : found) {
        const double share = sum > 0.0 ? kDirect * one.light->intensity / sum : 0.0;
        scene.lights.push_back({one.part->name, make_light(one, share), one.part->location});
    }
    if (found.empty()) return;
    const Rgb ambient{kAmbient, kAmbient, kAmbient};
    scene.lights.push_back({"ambient", AmbientLight{ambient}, found.front().part->location});
}

}  // namespace alhazen

#include "alhazen/renderers/core/unlit_cache.h"

#include <algorithm>

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/shading/materials/texture_inputs.h"

namespace alhazen {

namespace {

std::optional<Rgb> unlit_color_of(const Scene& scene, const Material& material,
                                  std::span<const Rgb> ambient) {
    if (reads_textures(material)) return std::nullopt;
    ShadingPoint point;
    point.own = evaluate(material, scene.textures, SurfaceLookup{});
    const MaterialSample& sample = point.own;
    const bool lit = std::any_of(scene.lights.begin(), scene.lights.end(),
                                 [](const Light& light) { return illuminates(light); });
    const bool dull = sample.diffuse.is_black() && sample.specular.is_black();
    const bool whole = sample.coverage == 1.0 && sample.transmissive.is_black();
    if (!whole || sample.physical || is_unseen_from_behind(sample) || (lit && !dull)) {
        return std::nullopt;
    }
    ShadingConventions conventions = scene.conventions.shading;
    if (conventions.ambient_from_eye) {
        const auto emits = [](const Rgb& light) { return !light.is_black(); };
        const bool ambient_seen =
            !sample.ambient.is_black() && std::any_of(ambient.begin(), ambient.end(), emits);
        if (ambient_seen) return std::nullopt;
        conventions.ambient_from_eye = false;
    }
    return unshadowed_terms(conventions, ambient, point);
}

}  // namespace

UnlitCache::UnlitCache(const Scene& scene, std::span<const Rgb> ambient) : scene_(scene) {
    for (const Material& material : scene.materials) {
        colors_.push_back(unlit_color_of(scene, material, ambient));
    }
    const bool any = std::any_of(colors_.begin(), colors_.end(),
                                 [](const auto& color) { return color.has_value(); });
    if (!any) colors_.clear();
}

const Rgb* UnlitCache::look_up(const Hit& hit) const {
    const std::optional<MaterialId> material = plain_material(*scene_.aggregate, hit);
    if (!material) return nullptr;
    const std::optional<Rgb>& color = colors_[static_cast<std::size_t>(*material)];
    return color ? &*color : nullptr;
}

}  // namespace alhazen

#include "alhazen/renderers/core/material_cache.h"

#include "alhazen/shading/materials/texture_inputs.h"

namespace alhazen {

void MaterialCache::fill(MaterialId id, Place& place) const {
    const Material& material = scene_.materials[static_cast<std::size_t>(id)];
    place.id = id;
    place.used = true;
    place.constant = !reads_textures(material);
    if (place.constant) place.sample = evaluate(material, scene_.textures, SurfaceLookup{});
}

}  // namespace alhazen

#include "alhazen/renderers/light_transport/bsdf_cache.h"

#include "alhazen/shading/materials/texture_inputs.h"

namespace alhazen {

void BsdfCache::begin(MaterialId id, Entry& entry) const {
    entry.id = id;
    entry.used = true;
    entry.constant = !reads_textures(scene_.materials[static_cast<std::size_t>(id)]);
    for (Side& side : entry.sides) side.made = false;
}

void BsdfCache::make(MaterialId id, const BsdfPlace& place, Side& side) {
    const Material& material = scene_.materials[static_cast<std::size_t>(id)];
    side.eta = place.eta;
    if (keeps_ && side.bsdf) replaced_.push_back(std::move(side.bsdf));
    if (!side.bsdf) side.bsdf = std::make_unique<Bsdf>();
    *side.bsdf = bsdf_of(material, scene_.textures, SurfaceLookup{}, place);
    side.made = true;
}

}  // namespace alhazen

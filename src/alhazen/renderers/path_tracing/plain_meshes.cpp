#include "alhazen/renderers/path_tracing/plain_meshes.h"

#include "alhazen/renderers/light_transport/scattering_media.h"
#include "alhazen/shading/materials/texture_inputs.h"

namespace alhazen {

namespace {

/// True if a BSDF scatters on the side of the view only, and no lobe is singular.
bool only_reflects_wide(const Bsdf& bsdf) {
    return bsdf.has_density() && !bsdf.has_singular() && !bsdf.transmits() && !bsdf.lets_through();
}

/// The value of a BSDF of one diffuse reflection, if its weights of samples are finite and above 0.
std::optional<Spectrum> matt_value(const Bsdf& bsdf) {
    if (!bsdf.is_only_matt()) return std::nullopt;
    const Vec3 above{0, 0, 1};
    const Spectrum value = bsdf.value(above, above, Transport::Radiance);
    constexpr double kMost = 1e100;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        if (!(value[i] >= 0.0 && value[i] <= kMost)) return std::nullopt;
    }
    if (!(value.max() >= 1.0 / kMost) || !(bsdf.density(above, above) > 0.0)) return std::nullopt;
    return value;
}

}  // namespace

PlainMeshes::PlainMeshes(const Scene& scene)
    : scene_(scene),
      table_(scene.aggregate->primitives()),
      first_(table_.first(kTriangleKind)),
      any_(!scene.has_motion && !scene.aggregate->completes_surfaces()),
      looks_(table_.meshes.size()),
      materials_(scene.materials.size()) {
    if (any_) list_meshes();
}

void PlainMeshes::list_meshes() {
    for (const PlacedMesh& mesh : table_.meshes) {
        ends_.push_back(mesh.first_triangle +
                        static_cast<std::uint32_t>(mesh.mesh->triangles.size()));
    }
    if (ends_.empty() || ends_.back() == 0) return;
    const std::uint32_t last = ends_.back() - 1;
    const std::size_t most = std::max<std::size_t>(64, 8 * ends_.size());
    while ((last >> block_bits_) >= most) ++block_bits_;
    for (std::uint32_t block = 0, mesh = 0; block <= (last >> block_bits_); ++block) {
        while (ends_[mesh] <= (block << block_bits_)) ++mesh;
        first_meshes_.push_back(mesh);
    }
}

void PlainMeshes::look_at(const PlacedMesh& mesh, Look& look) {
    look.known = true;
    const TriangleMesh& of = *mesh.mesh;
    // Vertex colours, materials and tangents, and moving vertices, are left to ScatterPoint.
    const bool has_extras =
        !of.colors.empty() || !of.vertex_materials.empty() || !of.tangents.empty();
    if (!has_extras && !mesh.motion) look.material = material_of(mesh.material);
}

const PlainMaterial* PlainMeshes::material_of(MaterialId id) {
    const auto number = static_cast<std::size_t>(id);
    if (materials_[number]) return materials_[number].get();
    const Material& material = scene_.materials[number];
    // Boundaries of volumes may coincide with other faces. Turned grooves depend on the handedness
    // of the coordinates.
    if (reads_textures(material) || may_bound_volume(material) || has_turned_grooves(material)) {
        return nullptr;
    }
    const MaterialSample sample = evaluate(material, scene_.textures, SurfaceLookup{});
    const bool is_seen = sample.coverage >= 1.0 && !sample.single_sided;
    if (!is_seen || sample.unlit || !sample.emission.is_black()) return nullptr;
    auto plain = std::make_unique<PlainMaterial>();
    for (const bool entering : {false, true}) {
        // As ScatterPoint::etas outside of all volumes.
        const double air = scene_.conventions.shading.air_index, own = sample.index;
        const double eta = entering ? air / own : own / air;
        Bsdf& bsdf = plain->bsdfs[entering ? 1 : 0];
        bsdf = bsdf_of(material, scene_.textures, SurfaceLookup{},
                       {.eta = own > 0.0 && !sample.thin ? eta : 0.0, .from_inside = !entering});
        if (!only_reflects_wide(bsdf)) return nullptr;
        plain->rough[entering ? 1 : 0] = RoughLobe::of(bsdf);
    }
    const std::optional<Spectrum> behind = matt_value(plain->bsdfs[0]);
    const std::optional<Spectrum> front = matt_value(plain->bsdfs[1]);
    plain->is_matt = front && behind && *front == *behind;
    if (plain->is_matt) plain->matt = *front;
    return (materials_[number] = std::move(plain)).get();
}

}  // namespace alhazen

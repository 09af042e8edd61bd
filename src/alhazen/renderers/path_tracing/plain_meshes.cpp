#include "alhazen/renderers/path_tracing/plain_meshes.h"

#include <algorithm>

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
    const auto end_of = [&](std::uint32_t mesh) {
        const PlacedMesh& placed = table_.meshes[mesh];
        return std::uint64_t{placed.first_triangle} + placed.mesh->triangles.size();
    };
    const std::uint64_t meshes = table_.meshes.size();
    const std::uint64_t triangles =
        meshes == 0 ? 0 : end_of(static_cast<std::uint32_t>(meshes - 1));
    // About as many blocks as triangles in blocks of several meshes.
    while (triangles >> 2 * block_bits_ > meshes) ++block_bits_;
    const std::uint64_t size = std::uint64_t{1} << block_bits_;
    std::uint32_t mesh = 0;
    for (std::uint64_t begin = 0; begin < triangles; begin += size) {
        const std::uint64_t end = std::min(begin + size, triangles);
        while (end_of(mesh) <= begin) ++mesh;
        const auto first = static_cast<std::uint32_t>(numbers_.size());
        if (end_of(mesh) >= end) {
            blocks_.push_back({first, 0});
            numbers_.push_back(mesh);
            continue;
        }
        blocks_.push_back({first, static_cast<std::uint32_t>(size - 1)});
        for (std::uint64_t i = begin; i < end; ++i) {
            while (end_of(mesh) <= i) ++mesh;
            numbers_.push_back(mesh);
        }
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

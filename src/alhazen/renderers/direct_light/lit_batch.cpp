#include "alhazen/renderers/direct_light/lit_batch.h"

#include <algorithm>

#include "alhazen/shading/materials/texture_inputs.h"

namespace alhazen {

namespace {

LitMaterial lit_material(const Scene& scene, const Material& material,
                         std::span<const Rgb> ambient) {
    LitMaterial lit;
    if (reads_textures(material)) return lit;
    lit.sample = evaluate(material, scene.textures, SurfaceLookup{});
    const MaterialSample& sample = lit.sample;
    lit.fits = sample.coverage == 1.0 && sample.transmissive.is_black() && !sample.physical &&
               !is_unseen_from_behind(sample);
    ShadingPoint point;
    point.own = sample;
    lit.base = unshadowed_terms(scene.conventions.shading, ambient, point);
    lit.shiny = !sample.specular.is_black();
    return lit;
}

}  // namespace

LitBatch::LitBatch(const Scene& scene, std::span<const Rgb> ambient)
    : scene_(scene), ambient_(ambient), constant_(scene) {
    for (Group*& group : last_of_kind_) group = &groups_[0];
    const auto emits = [](const Rgb& light) { return !light.is_black(); };
    const bool depends_on_view = scene.conventions.shading.ambient_from_eye &&
                                 std::any_of(ambient.begin(), ambient.end(), emits);
    if (scene.has_motion || depends_on_view) return;
    for (const Material& material : scene.materials) {
        materials_.push_back(lit_material(scene, material, ambient));
        any_ = any_ || materials_.back().fits;
    }
    if (!any_) return;
    first_triangle_ = PrimitiveId{scene.aggregate->primitives().first(kTriangleKind)};
    for (const Light& light : scene.lights) {
        if (illuminates(light)) lights_.push_back(&light);
    }
    known_.resize(kKnown);
}

void LitBatch::learn(const Hit& hit, PrimitiveId around, Known& known) const {
    known = {hit.primitive, around, nullptr, surface_source(*scene_.aggregate, hit)};
    if (known.source.kind == SurfaceSource::Kind::None) return;
    const LitMaterial& material = materials_[static_cast<std::size_t>(known.source.material)];
    if (material.fits) known.material = &material;
}

LitBatch::Group& LitBatch::group_for(const SurfaceSource& source, std::span<Rgb> radiance) {
    const auto choose = [&]() -> Group& {
        for (Group& group : groups_) {
            if (!group.surfaces.empty() && group.surfaces.takes(source)) return group;
        }
        for (Group& group : groups_) {
            if (group.surfaces.empty()) return group;
        }
        Group& group = groups_[next_];
        next_ = (next_ + 1) % kGroups;
        shade(group, radiance);
        return group;
    };
    Group& group = choose();
    last_of_kind_[static_cast<std::size_t>(source.kind)] = &group;
    return group;
}

void LitBatch::shade(Group& group, std::span<Rgb> radiance) {
    const std::size_t count = group.surfaces.size();
    LitLanes& lanes = group.lanes;
    const std::uint32_t wanted = (1u << count) - 1;
    const std::uint32_t found = group.surfaces.find();
    if (found == wanted) {
        shade_lanes(scene_.conventions.shading, lights_, count, group.surfaces.in_world(),
                    group.surfaces.surfaces(), lanes);
    }
    for (std::size_t i = 0; i < count; ++i) {
        radiance[group.number[i]] +=
            found == wanted ? Rgb{lanes.radiance[0][i], lanes.radiance[1][i], lanes.radiance[2][i]}
                            : shade_alone(group, i);
    }
    group.surfaces.clear();
}

Rgb LitBatch::shade_alone(const Group& group, std::size_t lane) {
    Hit hit;
    static_cast<ShapeHit&>(hit) = group.surfaces.hit(lane);
    hit.primitive = group.primitive[lane];
    if (group.around[lane] != kNoPrimitive) hit.path.push_back(group.around[lane]);
    const PointNeeds needs{.coordinates = CoordinateNeed::of(scene_.reads_coordinates),
                           .constant = &constant_};
    set_shading_point(scene_, *group.lanes.ray[lane], hit, {}, needs, alone_);
    return unhindered_light(scene_, ambient_, alone_);
}

}  // namespace alhazen

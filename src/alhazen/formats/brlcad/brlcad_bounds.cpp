#include "alhazen/formats/brlcad/brlcad_bounds.h"

namespace alhazen {

namespace {

Box3 shared(const Box3& a, const Box3& b) {
    return {{std::max(a.lo.x, b.lo.x), std::max(a.lo.y, b.lo.y), std::max(a.lo.z, b.lo.z)},
            {std::min(a.hi.x, b.hi.x), std::min(a.hi.y, b.hi.y), std::min(a.hi.z, b.hi.z)}};
}

Box3 shape_box(const AnyShape& shape) {
    return std::visit(
        [](auto copy) {
            copy.prepare();
            return copy.box();
        },
        shape);
}

}  // namespace

BrlcadBounds::BrlcadBounds(const SceneDescription& scene)
    : scene_(scene), objects_(scene.objects.size()), meshes_(scene.meshes.size()) {}

Box3 BrlcadBounds::of(const Part& part) {
    Box3 box;
    if (const auto* shape = std::get_if<AnyShape>(&part.what)) {
        box = shape_box(*shape);
    } else if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
        const auto i = static_cast<std::size_t>(*mesh);
        if (!meshes_[i]) meshes_[i] = scene_.meshes[i].mesh->box();
        box = *meshes_[i];
    } else {
        box = of(std::get<ObjectIndex>(part.what));
    }
    return transformed(part.object_from_part, box);
}

Box3 BrlcadBounds::of(ObjectIndex index) {
    const auto i = static_cast<std::size_t>(index);
    if (objects_[i]) return *objects_[i];
    const ObjectDescription& object = scene_.objects[i];
    Box3 box;
    if (object.combine == Combine::Difference) {
        if (!object.parts.empty()) box = of(object.parts[0]);
    } else if (object.combine == Combine::Intersection) {
        for (std::size_t k = 0; k < object.parts.size(); ++k) {
            box = k == 0 ? of(object.parts[k]) : shared(box, of(object.parts[k]));
        }
    } else {
        for (const Part& part : object.parts) {
            const Box3 next = of(part);
            if (!next.empty() && next.bounded()) box.include(next);
        }
    }
    if (box.empty()) box = Box3{};
    objects_[i] = box;
    return box;
}

}  // namespace alhazen

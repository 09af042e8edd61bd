#include "alhazen/scene_model/scene_motion.h"

#include <algorithm>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

void open_shutter(SceneDescription& description, const Shutter& shutter) {
    description.shutter = shutter;
    for (ObjectDescription& object : description.objects) {
        for (Part& part : object.parts) {
            if (!part.motion || part.motion->keys.empty()) continue;
            part.object_from_part = part.motion->at(shutter.open);
        }
    }
    for (MeshDescription& mesh : description.meshes) {
        if (mesh.keys.empty() || fault_of(*mesh.mesh, mesh.keys) != nullptr) continue;
        MeshMotion(mesh.keys).pose(shutter.open, *mesh.mesh);
    }
}

bool geometry_moves(const SceneDescription& description) {
    const auto moves = [](const MeshDescription& mesh) { return !mesh.keys.empty(); };
    const auto part_moves = [](const Part& part) { return part.motion != nullptr; };
    return std::any_of(description.meshes.begin(), description.meshes.end(), moves) ||
           std::any_of(description.objects.begin(), description.objects.end(),
                       [&](const ObjectDescription& object) {
                           return std::any_of(object.parts.begin(), object.parts.end(), part_moves);
                       });
}

bool has_motion(const SceneDescription& description) {
    return geometry_moves(description) ||
           std::any_of(description.cameras.begin(), description.cameras.end(),
                       [](const CameraDescription& camera) { return !camera.keys.empty(); });
}

}  // namespace alhazen

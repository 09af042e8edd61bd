#include "alhazen/scene/compile_materials.h"

#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "alhazen/shading/lights/environment.h"

namespace alhazen {

namespace {

/// Textures of one image share its pyramid.
void compile_textures(const SceneDescription& description, Scene& scene) {
    std::map<std::pair<const StoredImage*, bool>, std::shared_ptr<const MipPyramid>> pyramids;
    for (const TextureDescription& t : description.textures) {
        Texture& texture = scene.textures.emplace_back(t.texture);
        if (texture.solid) {
            scene.has_solid_textures = true;
            continue;
        }
        if (texture.filter != TextureFilter::Mipmapped) continue;
        auto& pyramid = pyramids[{texture.image.get(), texture.decode_srgb}];
        if (!pyramid) {
            pyramid = std::make_shared<const MipPyramid>(texture.image, texture.decode_srgb);
        }
        texture.pyramid = pyramid;
        scene.has_mipmaps = true;
    }
}

}  // namespace

void compile_materials(const SceneDescription& description, Scene& scene) {
    const bool truncate = description.conventions.importing.truncate_material_colors;
    for (const MaterialDescription& of : description.materials) {
        Material m = of.material;
        if (truncate) {
            for (ColorInput* input : {&m.emission, &m.ambient, &m.diffuse, &m.specular,
                                      &m.reflective, &m.transmissive}) {
                for (int i = 0; i < 3; ++i) {
                    input->color[i] = std::floor(255.0 * input->color[i]) / 255.0;
                }
            }
        }
        scene.materials.push_back(std::move(m));
    }
    compile_textures(description, scene);
    for (const LightDescription& l : description.lights) {
        scene.lights.push_back(ready_to_sample(l.light));
    }
    for (CameraDescription camera : description.cameras) {
        camera.keys = relative_to(description.shutter, std::move(camera.keys));
        if (!camera.keys.empty()) {
            const Affine at_open = TransformMotion(camera.keys).at(0.0).outer_from_inner;
            camera.camera = transformed(at_open, camera.camera);
        }
        scene.cameras.push_back(std::move(camera));
    }
    const Conventions& conventions = description.conventions;
    scene.conventions = {conventions.shading, conventions.sampling, conventions.film};
    scene.background = description.picture.background.value_or(Rgb{});
    if (description.environment) {
        const Vec3 up = description.up_axis == UpAxis::Z ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
        scene.environment =
            std::make_shared<const Environment>(description.environment->settings, up);
    }
}

std::uint64_t texture_bytes(const std::vector<Texture>& textures) {
    std::map<const void*, std::uint64_t> bytes;
    for (const Texture& t : textures) {
        if (!t.image) continue;
        bytes[t.image.get()] = t.image->memory_bytes();
        if (t.pyramid) bytes[t.pyramid.get()] = t.pyramid->memory_bytes();
    }
    std::uint64_t sum = 0;
    for (const auto& [what, count] : bytes) sum += count;
    return sum;
}

}  // namespace alhazen

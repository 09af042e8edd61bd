#include "alhazen/scene/compile_materials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "alhazen/base/overloaded.h"
#include "alhazen/shading/lights/environment.h"
#include "alhazen/shading/materials/texture_inputs.h"

namespace alhazen {

namespace {

class TextureCompiler {
  public:
    explicit TextureCompiler(Scene& scene) : scene_(scene) {}

    void operator()(SolidTexture& /*texture*/) { scene_.has_solid_textures = true; }
    /// Textures of one image share its pyramid.
    void operator()(ImageTexture& texture) {
        if (!has_pyramid(texture.filter)) return;
        auto& pyramid = pyramids_[{texture.image.get(), texture.decode_srgb}];
        if (!pyramid) {
            pyramid = std::make_shared<const MipPyramid>(texture.image, texture.decode_srgb);
        }
        texture.pyramid = pyramid;
        scene_.has_mipmaps = true;
    }

  private:
    Scene& scene_;
    std::map<std::pair<const StoredImage*, bool>, std::shared_ptr<const MipPyramid>> pyramids_;
};

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
    if (std::any_of(scene.materials.begin(), scene.materials.end(), reads_coordinates)) {
        for (const Material& m : scene.materials) {
            scene.reads_coordinates.push_back(reads_coordinates(m) ? 1 : 0);
        }
    }
    TextureCompiler compile(scene);
    for (const TextureDescription& t : description.textures) {
        std::visit(compile, scene.textures.emplace_back(t.texture));
    }
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
    const auto count = [&](const ImageTexture& t) {
        bytes[t.image.get()] = t.image->memory_bytes();
        if (t.pyramid) bytes[t.pyramid.get()] = t.pyramid->memory_bytes();
    };
    for (const Texture& texture : textures) {
        std::visit(Overloaded{count, [](const SolidTexture&) {}}, texture);
    }
    std::uint64_t sum = 0;
    for (const auto& [what, size] : bytes) sum += size;
    return sum;
}

}  // namespace alhazen

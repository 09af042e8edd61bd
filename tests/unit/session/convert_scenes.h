/// Scenes for tests of `convert`, and the messages of its errors.

#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "alhazen/base/error.h"
#include "alhazen/session/conversion/convert.h"
#include "support/image_texture.h"
#include "support/scene_maker.h"

namespace alhazen::testing {

/// Two tetrahedra, one of them reflected, in an object that is placed twice.
inline SceneDescription two_tetrahedra() {
    SceneMaker maker;
    (void)maker.material({.name = "red paint"});
    const MeshIndex mesh = maker.mesh(tetrahedron());
    const ObjectIndex object = maker.object("pair");
    maker.add(mesh, MaterialId{0}, Affine::translate({0, 5, 0}), object);
    maker.add(object, {}, Affine::translate({10, 0, 0}));
    maker.add(object, {}, Affine::scale({-2, 2, 2}));
    return maker.description();
}

/// One textured mesh of many triangles; `grey` is the only texel of its texture.
inline SceneDescription textured(std::uint8_t grey) {
    SceneMaker maker;
    ImageTexture texture;
    texture.image =
        std::make_shared<StoredImage>(StoredImage{1, 1, 1, false, std::vector<std::uint8_t>{grey}});
    maker.description().textures.push_back({"t", texture, {}});
    Material m;
    m.name = "m";
    m.diffuse = {{1, 1, 1}, TextureId{0}};
    maker.add(maker.mesh(tetrahedron()), maker.material(m));
    return maker.description();
}

inline std::string message_of(const SceneDescription& scene, const std::filesystem::path& path,
                              ErrorKind kind, const ConvertOptions& options = {}) {
    try {
        (void)convert(scene, path, options);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), kind) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "expected an error";
    return {};
}

}  // namespace alhazen::testing

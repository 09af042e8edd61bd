#pragma once
/// Scenes of short OBJ texts.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "alhazen/imaging/codecs/image_io.h"
#include "support/image_texture.h"
#include "unit/formats/import_text.h"

namespace alhazen::testing {

inline const std::string kObjSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// The validated scene of an OBJ text whose files lie in `folder`.
inline SceneDescription obj_scene(const std::string& text, Diagnostics& found,
                                  const std::filesystem::path& folder = "nowhere") {
    SceneDescription scene = import_text(text, folder / "a.obj", found);
    if (found.error_count() == 0) {
        Diagnostics invalid;
        validate(scene, invalid);
        EXPECT_EQ(invalid.error_count(), 0u) << text_of(invalid);
    }
    return scene;
}

/// A folder with a small image and an OBJ whose material uses it as `map`.
struct WithPicture {
    TemporaryFolder folder;
    Diagnostics found;
    SceneDescription scene;
    explicit WithPicture(const std::string& mtl, const std::string& picture = "my pic.png") {
        std::filesystem::create_directories((folder.path() / picture).parent_path());
        Image image(2, 2, 3);
        image.linear = false;
        for (float& s : image.samples) s = 0.5f;
        write_image(folder.path() / picture, image, {});
        folder.write("lib/a b.mtl", "newmtl my material\n" + mtl);
        scene = obj_scene(
            "mtllib lib/a b.mtl\n" + kObjSquare + "vt 0 0\nusemtl my material  \nf 1/1 2/1 3/1\n",
            found, folder.path());
    }
    [[nodiscard]] const Material& material() const { return scene.materials.at(0).material; }
    [[nodiscard]] const ImageTexture& texture(TextureId id) const {
        return image_texture(scene.textures.at(std::size_t(id)));
    }
};

}  // namespace alhazen::testing

#pragma once
/// For tests of the writer of native scenes: a description is written, read back and compared bit
/// for bit.

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "alhazen/formats/native/read/native_importer.h"
#include "alhazen/formats/native/write/native_writer.h"
#include "support/random.h"
#include "support/same_description.h"
#include "support/scratch_folder.h"
#include "unit/formats/text_scene.h"

namespace alhazen::testing {

/// Writes the description into a folder and reads it back.
struct RoundTrip {
    ScratchFolder folder;
    std::string text;
    std::map<std::string, std::size_t> files;  ///< sizes of those beside the scene
    Imported read;

    explicit RoundTrip(const SceneDescription& description) {
        text = native_scene_text(description, "scene_files", [&](const auto& name, auto bytes) {
            EXPECT_FALSE(files.contains(name)) << "written twice: " << name;
            files[name] = bytes.size();
            folder.write(name, bytes);
            return name;
        });
        read = import_text<NativeImporter>(text, folder.path() / "scene.alhazen");
        EXPECT_EQ(read.messages(), "") << text.substr(0, 4000);
    }
};

inline void expect_round_trip(const SceneDescription& description) {
    const RoundTrip trip(description);
    expect_same(description, trip.read.scene);
    if (::testing::Test::HasFailure()) ADD_FAILURE() << trip.text.substr(0, 6000);
}

/// Numbers whose last bits a careless writer loses.
class Numbers {
  public:
    explicit Numbers(std::uint64_t seed) : random_(seed) {}
    double any() { return random_.sign() * random_.log_uniform(1e-12, 1e12); }
    double positive() { return random_.log_uniform(0.1, 10); }
    Vec2 uv() { return {any(), any()}; }
    Vec3 point() { return {any(), any(), any()}; }
    Rgb color() { return {positive(), positive(), positive()}; }
    Affine affine() {
        return Affine::rotate(random_.unit_vector(), positive()) * Affine::translate(point());
    }
    int below(int n) { return random_.below(n); }

  private:
    Random random_;
};

inline SceneDescription empty_scene(const std::string& root = "scene") {
    SceneDescription scene;
    scene.objects.push_back({root, {}, {}});
    scene.conventions.shading.ambient_inside_times_kt = false;
    scene.conventions.shading.clamp_attenuation = false;
    scene.conventions.shading.air_index = 1.0;
    scene.conventions.film.linear_output = false;
    return scene;
}

}  // namespace alhazen::testing

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "alhazen/formats/importer_list.h"
#include "golden/scene_files.h"

namespace alhazen::testing::ALHAZEN_TEST_FILE {
namespace {

using Corners = std::array<double, 9>;

/// All triangles in world space, in order, of a scene whose objects are nested once.
std::vector<Corners> triangles_of(const SceneDescription& scene) {
    std::vector<Corners> triangles;
    for (const Part& outer : scene.objects.at(0).parts) {
        const auto object = std::size_t(std::get<ObjectIndex>(outer.what));
        for (const Part& inner : scene.objects.at(object).parts) {
            const Affine world_from_part = outer.object_from_part * inner.object_from_part;
            const auto mesh = std::size_t(std::get<MeshIndex>(inner.what));
            for (const auto& triangle : scene.meshes.at(mesh).mesh->triangles) {
                Corners corners{};
                for (std::size_t k = 0; k < 3; ++k) {
                    const Vec3 p =
                        world_from_part.point(scene.meshes[mesh].mesh->positions[triangle[k]]);
                    corners[3 * k] = p.x;
                    corners[3 * k + 1] = p.y;
                    corners[3 * k + 2] = p.z;
                }
                triangles.push_back(corners);
            }
        }
    }
    return triangles;
}

/// [model] its files: one per variant (glTF, glTF-Binary, glTF-Embedded, ...).
std::map<std::string, std::vector<std::filesystem::path>> models() {
    std::map<std::string, std::vector<std::filesystem::path>> result;
    for (const char* suffix : {".gltf", ".glb"}) {
        for (const std::filesystem::path& file : files_below("gltf/dev", suffix)) {
            result[file.parent_path().parent_path().filename().string()].push_back(file);
        }
    }
    return result;
}

SceneDescription read(const std::filesystem::path& file, const ImportOptions& options = {}) {
    Diagnostics diagnostics;
    return import_scene(file, options, diagnostics);
}

/// Largest difference of two coordinates; infinite if the counts differ.
double difference(const std::vector<Corners>& a, const std::vector<Corners>& b) {
    if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t k = 0; k < 9; ++k) {
            largest = std::max(largest, std::abs(a[i][k] - b[i][k]));
        }
    }
    return largest;
}

/// Variants of a model write matrices with 16 or 17 digits, so bits may differ.
TEST(GltfModels, AllVariantsOfAModelHaveTheSameTriangles) {
    ALHAZEN_NEEDS_DATA("gltf/dev");
    std::size_t compared = 0;
    for (const auto& [model, files] : models()) {
        SCOPED_TRACE(model);
        std::vector<Corners> first;
        for (const std::filesystem::path& file : files) {
            std::vector<Corners> triangles;
            try {
                triangles = triangles_of(read(file));
            } catch (const Error& error) {
                ADD_FAILURE() << error.what();
                continue;
            }
            EXPECT_FALSE(triangles.empty()) << file;
            if (first.empty()) {
                first = std::move(triangles);
            } else {
                EXPECT_LE(difference(first, triangles), 1e-13) << file;
                ++compared;
            }
        }
    }
    EXPECT_GE(compared, 20u);
}

/// Expected counts: those of the files' accessors, times the nodes that use them.
TEST(GltfModels, CountsAreThoseOfTheirFiles) {
    ALHAZEN_NEEDS_DATA("gltf/dev");
    const std::map<std::string, std::size_t> counts{{"Box", 12},
                                                    {"Duck", 4212},
                                                    {"MeshPrimitiveModes", 6 + 4 + 6},
                                                    {"SimpleInstancing", 125 * 12},
                                                    {"SimpleMeshes", 2},
                                                    {"SimpleSkin", 8},
                                                    {"Triangle", 1},
                                                    {"TriangleWithoutIndices", 1}};
    const auto all = models();
    for (const auto& [model, count] : counts) {
        EXPECT_EQ(triangles_of(read(all.at(model).front())).size(), count) << model;
    }
}

/// The animation runs from 0 to 3.708 seconds and is constant beyond its ends.
TEST(GltfModels, AnimationsMoveTheirNodes) {
    ALHAZEN_NEEDS_DATA("gltf/dev/BoxAnimated/glTF/BoxAnimated.gltf");
    const std::filesystem::path file = test_data() / "gltf/dev/BoxAnimated/glTF/BoxAnimated.gltf";
    ImportOptions options;
    const auto at = [&](double time) {
        options.time = time;
        return triangles_of(read(file, options));
    };
    EXPECT_TRUE(at(0.0) == at(-1.0));
    EXPECT_TRUE(at(1000.0) == at(2000.0));
    // Half the side of the inner box, which is centred on the origin at rest.
    constexpr double kSide = 0.33504000306129456, kTop = 2.5199999809265137;
    const auto inner = [&](double time) {
        std::vector<Corners> triangles = at(time);
        // The outer box comes first in the scene; the 186 indices of the inner one make 62
        // triangles.
        triangles.erase(triangles.begin(), triangles.end() - 62);
        Box3 box;
        for (const Corners& c : triangles) {
            for (std::size_t k = 0; k < 9; k += 3) box.include(Vec3{c[k], c[k + 1], c[k + 2]});
        }
        return box;
    };
    const auto expect_box = [](const Box3& box, const Vec3& lo, const Vec3& hi) {
        EXPECT_LT(length(box.lo - lo) + length(box.hi - hi), 1e-6);
    };
    expect_box(inner(0.0), {-kSide, -0.5, -kSide}, {kSide, 0.5, kSide});
    // Half way up, before the turn.
    expect_box(inner(0.625), {-kSide, kTop / 2 - 0.5, -kSide}, {kSide, kTop / 2 + 0.5, kSide});
    // At the top, half of the half turn about x done: y points along z.
    expect_box(inner(1.875), {-kSide, kTop - kSide, -0.5}, {kSide, kTop + kSide, 0.5});
    // Three quarters of the way down: 2.5 + 0.75 * 1.208329916 seconds.
    expect_box(inner(3.406247437), {-kSide, kTop / 4 - 0.5, -kSide},
               {kSide, kTop / 4 + 0.5, kSide});
}

}  // namespace
}  // namespace alhazen::testing::ALHAZEN_TEST_FILE

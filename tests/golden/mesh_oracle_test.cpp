/// Meshes and glTF scenes against other libraries: equal sets of triangles on every model that both
/// accept. Known differences are listed here and in docs/reference/formats/meshes.md.

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <tiny_obj_loader.h>

#include <assimp/Importer.hpp>
#include <cctype>
#include <iostream>
#include <set>

#include "alhazen/formats/importer_list.h"
#include "scene_files.h"
#include "support/thorough.h"
#include "support/triangle_soup.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::PolygonSoup;

/// All files below `folder` with this suffix, compared in lower case.
std::vector<std::filesystem::path> files(const std::string& folder, const std::string& suffix) {
    std::string capitals = suffix;
    for (char& c : capitals) c = char(std::toupper(static_cast<unsigned char>(c)));
    auto found = testing::files_below(folder, suffix);
    const auto more = testing::files_below(folder, capitals);
    found.insert(found.end(), more.begin(), more.end());
    return found;
}

/// Reads a file with Alhazen; returns no triangles if it is rejected.
TriangleMesh read_here(const std::filesystem::path& path) {
    TriangleMesh soup;
    try {
        Diagnostics warnings;
        const SceneDescription scene = import_scene(path, {}, warnings);
        testing::add_triangles(scene, scene.objects.at(std::size_t(scene.root)), {}, soup);
    } catch (const Error&) {
        return {};
    }
    return soup;
}

void add_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent,
              PolygonSoup& soup) {
    const aiMatrix4x4 world = parent * node.mTransformation;
    const bool mirrored = world.Determinant() < 0;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices < 3) continue;
            for (unsigned i = 0; i < face.mNumIndices; ++i) {
                const unsigned k = mirrored ? face.mNumIndices - 1 - i : i;
                const aiVector3D p = world * mesh.mVertices[face.mIndices[k]];
                soup.corners.push_back({double(p.x), double(p.y), double(p.z)});
            }
            soup.ends.push_back(soup.corners.size());
        }
    }
    for (unsigned c = 0; c < node.mNumChildren; ++c)
        add_node(scene, *node.mChildren[c], world, soup);
}

PolygonSoup read_by_assimp(const std::filesystem::path& path) {
    Assimp::Importer importer;
    PolygonSoup soup;
    const aiScene* scene = importer.ReadFile(path.string(), 0);
    if (scene != nullptr && scene->mRootNode != nullptr) {
        add_node(*scene, *scene->mRootNode, {}, soup);
    }
    return soup;
}

PolygonSoup read_by_tinyobj(const std::filesystem::path& path) {
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning, error;
    PolygonSoup soup;
    if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, path.string().c_str(),
                          path.parent_path().string().c_str(), false)) {
        return soup;
    }
    for (const tinyobj::shape_t& shape : shapes) {
        std::size_t at = 0;
        for (const auto count : shape.mesh.num_face_vertices) {
            for (std::size_t k = 0; k < std::size_t(count); ++k, ++at) {
                const auto i = std::size_t(shape.mesh.indices[at].vertex_index);
                if (3 * i + 2 >= attributes.vertices.size()) return {};
                soup.corners.push_back({double(attributes.vertices[3 * i]),
                                        double(attributes.vertices[3 * i + 1]),
                                        double(attributes.vertices[3 * i + 2])});
            }
            soup.ends.push_back(soup.corners.size());
        }
    }
    return soup;
}

/// Compares all files; those in `known` (by file name) may differ. Returns the number of equal
/// ones.
template <class ReadThere>
int compare(const std::vector<std::filesystem::path>& paths, const ReadThere& read_there,
            const std::set<std::string>& known) {
    int equal = 0;
    int compared = 0;
    for (const auto& path : paths) {
        const PolygonSoup theirs = read_there(path);
        if (theirs.ends.empty()) continue;
        ++compared;
        const TriangleMesh ours = read_here(path);
        const std::string differs =
            ours.triangles.empty() ? "nothing is read here" : testing::difference(ours, theirs);
        if (differs.empty()) ++equal;
        if (differs.empty() || known.count(path.filename().string()) != 0) continue;
        ADD_FAILURE() << path.string() << ": " << differs;
    }
    std::cout << equal << " of " << compared << " models are equal\n";
    return equal;
}

/// Rejected here: 3.1+e2 is not a number.
const std::set<std::string> kNoNumbers{"number_formats.obj"};

TEST(MeshOracle, ObjFilesHaveTheTrianglesThatTinyObjLoaderReads) {
    ALHAZEN_NEEDS_DATA("meshes/alecjacobson");
    EXPECT_EQ(compare(files("meshes", ".obj"), read_by_tinyobj, {}), 7);
    EXPECT_EQ(compare(files("hostile/assimp/OBJ", ".obj"), read_by_tinyobj, kNoNumbers), 10);
    EXPECT_EQ(compare(files("hostile/tinyobj/models", ".obj"), read_by_tinyobj, {}), 17);
}

TEST(MeshOracle, ObjFilesHaveTheTrianglesThatAssimpReads) {
    ALHAZEN_NEEDS_DATA("meshes/alecjacobson");
    EXPECT_EQ(compare(files("meshes", ".obj"), read_by_assimp, {}), 7);
    EXPECT_EQ(compare(files("hostile/assimp/OBJ", ".obj"), read_by_assimp, kNoNumbers), 10);
    // assimp divides positions by the fourth number, which is a weight of curves and surfaces only.
    EXPECT_EQ(compare(files("hostile/tinyobj/models", ".obj"), read_by_assimp,
                      {"cube-vertex-w-component.obj"}),
              16);
}

TEST(MeshOracle, PlyFilesHaveTheTrianglesThatAssimpReads) {
    ALHAZEN_NEEDS_DATA("hostile/assimp/PLY");
    EXPECT_EQ(compare(files("hostile/assimp/PLY", ".ply"), read_by_assimp, {}), 5);
    EXPECT_EQ(compare(files("ray", ".ply"), read_by_assimp, {}), 8);
}

TEST(MeshOracle, StlFilesHaveTheTrianglesThatAssimpReads) {
    ALHAZEN_NEEDS_DATA("hostile/assimp/STL");
    EXPECT_EQ(compare(files("hostile/assimp/STL", ".stl"), read_by_assimp, {}), 3);
}

TEST(MeshOracle, GltfScenesHaveTheTrianglesThatAssimpReads) {
    ALHAZEN_NEEDS_DATA("gltf/dev");
    const std::set<std::string> known{
        // assimp does not apply weights of morph targets, skins and instances of
        // EXT_mesh_gpu_instancing.
        "MorphPrimitivesTest.gltf", "MorphPrimitivesTest.glb", "SimpleMorph.gltf",
        "RiggedSimple.gltf", "RiggedSimple.glb", "SimpleInstancing.gltf", "SimpleInstancing.glb",
        // A rotation quaternion of length 0.9998, which assimp does not normalize.
        "TextureEncodingTest.gltf", "TextureEncodingTest.glb"};
    const auto tried = [](const char* suffix) {
        return testing::tried_of(files("gltf/dev", suffix), 3);
    };
    EXPECT_EQ(compare(tried(".gltf"), read_by_assimp, known), testing::cases(12, 34));
    EXPECT_EQ(compare(tried(".glb"), read_by_assimp, known), testing::cases(8, 21));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE

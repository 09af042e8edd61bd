/// Area and volume of real meshes, integrated along rays, against their exact values.

#include <gtest/gtest.h>

#include <numbers>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/formats/importer_list.h"
#include "alhazen/formats/mesh_files/mesh_export.h"
#include "alhazen/formats/mesh_files/mesh_io.h"
#include "alhazen/formats/obj/obj_reader.h"
#include "alhazen/formats/ply/ply_reader.h"
#include "alhazen/formats/stl/stl_reader.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/sampling/random.h"
#include "scene_files.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

struct Measures {
    double volume, area;
    double volume_error, area_error;  ///< standard errors
};

/// Traces parallel rays on a jittered grid over the box, along each axis in turn: the signed length
/// inside gives the volume (Cavalieri); each crossing of a ray along axis k stands for an area of 1
/// / |n_k| of its cell. Independently, uniform random lines give the area by counting crossings:
/// area = 2 pi R^2 E[crossings] (Crofton).
Measures measure(const Aggregate& aggregate, int side) {
    const Box3 box = aggregate.box();
    const Vec3 size = box.size();
    RandomStream random(7);
    std::vector<Hit> hits;
    double volume[3] = {};
    for (int axis = 0; axis < 3; ++axis) {
        const int b = (axis + 1) % 3;
        const int c = (axis + 2) % 3;
        double inside = 0;
        for (int i = 0; i < side * side; ++i) {
            Vec3 origin, direction;
            origin[b] = box.lo[b] + size[b] * (i % side + random.uniform()) / side;
            origin[c] = box.lo[c] + size[c] * (i / side + random.uniform()) / side;
            origin[axis] = box.lo[axis] - size[axis];
            direction[axis] = 1;
            hits.clear();
            aggregate.all_hits({origin, direction}, hits, nullptr);
            EXPECT_EQ(hits.size() % 2, 0u);
            for (const Hit& hit : hits) {
                const double d = surface_at(aggregate, {origin, direction}, hit).normal[axis];
                inside += d > 0 ? hit.t : -hit.t;
            }
        }
        volume[axis] = inside * size[b] * size[c] / (side * side);
    }
    // Crofton: isotropic lines through a sphere around the mesh.
    const double radius = 0.5 * length(size) * 1.0001;
    const int lines = side * side * 3;
    double sum = 0, squares = 0;
    for (int i = 0; i < lines; ++i) {
        const double z = random.uniform(-1, 1);
        const double phi = random.uniform(0, 2 * std::numbers::pi);
        const double r = std::sqrt(1 - z * z);
        const Vec3 d{r * std::cos(phi), r * std::sin(phi), z};
        const Vec3 u = perpendicular(d);
        const Vec3 v = cross(d, u);
        const double rho = radius * std::sqrt(random.uniform());
        const double psi = random.uniform(0, 2 * std::numbers::pi);
        const Vec3 origin =
            box.center() + rho * (std::cos(psi) * u + std::sin(psi) * v) - 2 * radius * d;
        hits.clear();
        aggregate.all_hits({origin, d}, hits, nullptr);
        const double n = static_cast<double>(hits.size());
        sum += n;
        squares += n * n;
    }
    const double mean = sum / lines;
    const double to_area = 2 * std::numbers::pi * radius * radius;
    Measures m;
    m.volume = (volume[0] + volume[1] + volume[2]) / 3;
    m.volume_error = std::max({std::abs(volume[0] - m.volume), std::abs(volume[1] - m.volume),
                               std::abs(volume[2] - m.volume)});
    m.area = to_area * mean;
    m.area_error = to_area * std::sqrt((squares / lines - mean * mean) / lines);
    return m;
}

std::shared_ptr<const Aggregate> aggregate_of(TriangleMesh mesh) {
    PrimitiveTable table;
    mesh.normals.clear();
    mesh.uvs.clear();
    table.meshes.push_back(
        {std::make_shared<TriangleMesh>(std::move(mesh)), MaterialId{0}, 0, false});
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    return make_aggregate("wide_bvh", std::move(table));
}

/// Meshes with exact sums over their triangles.
struct KnownMesh {
    const char* file;
    double area, volume;
};
constexpr KnownMesh kKnownMeshes[] = {{"cow", 108.845364, 53.5674458},
                                      {"fandisk", 60.6691092, 20.2433749},
                                      {"spot", 5.70951879, 0.718258788},
                                      {"cheburashka", 1.21240317, 0.0543816195}};

TEST(MeshMeasures, EveryFormatGivesTheExactSums) {
    ALHAZEN_NEEDS_DATA("meshes/alecjacobson");
    for (const KnownMesh& known : kKnownMeshes) {
        SCOPED_TRACE(known.file);
        const std::string file = std::string(known.file) + ".obj";
        Diagnostics found;
        const SceneDescription scene =
            import_scene(testing::test_data() / "meshes/alecjacobson/data" / file, {}, found);
        std::vector<NamedMesh> meshes;
        for (const MeshDescription& m : scene.meshes) {
            meshes.push_back({m.name, m.mesh.get(), {}, ""});
        }
        const auto expect = [&](const TriangleMesh& mesh, double relative) {
            EXPECT_NEAR(area(mesh), known.area, relative * known.area);
            EXPECT_NEAR(signed_volume(mesh), known.volume, relative * known.volume);
        };
        expect(read_ply(ply_bytes(meshes), "a.ply", {}, found), 2e-8);
        expect(read_obj(obj_text(meshes), "a.obj", {}, found), 2e-8);
        // STL stores positions as floats.
        expect(read_stl(stl_bytes(meshes), "a.stl", {}, found).at(0).mesh, 2e-6);
        EXPECT_EQ(found.error_count(), 0u);
    }
}

TEST(MeshMeasures, AreaAndVolumeByRaysAreTheExactOnes) {
    ALHAZEN_NEEDS_DATA("meshes/alecjacobson");
    for (const KnownMesh& known : kKnownMeshes) {
        Diagnostics diagnostics;
        const TriangleMesh mesh = read_mesh(
            testing::test_data() / "meshes/alecjacobson/data" / (std::string(known.file) + ".obj"),
            {}, diagnostics);
        ASSERT_EQ(diagnostics.error_count(), 0u) << known.file;
        const Measures m = measure(*aggregate_of(mesh), 150);
        EXPECT_NEAR(m.volume, known.volume, 2e-3 * known.volume) << known.file;
        EXPECT_LT(m.volume_error, 5e-3 * known.volume) << known.file;
        EXPECT_NEAR(m.area, known.area, 4 * m.area_error) << known.file;
        EXPECT_LT(m.area_error, 1.5e-2 * known.area) << known.file;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE

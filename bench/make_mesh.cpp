// Writes a closed bumpy ball of about N triangles as PLY, STL and OBJ, to measure the loading of
// meshes.
//
// Usage: alhazen_make_mesh N OUT   ->   OUT.ply OUT.stl OUT.obj

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "alhazen/base/file.h"
#include "alhazen/formats/mesh_files/mesh_export.h"
#include "mesh_makers.h"

int main(int argc, char** argv) {
    using namespace alhazen;
    const long wanted = argc == 3 ? std::atol(argv[1]) : 0;
    if (wanted < 8 || wanted > 500'000'000) {
        std::fputs("usage: alhazen_make_mesh TRIANGLES OUT\n", stderr);
        return 2;
    }
    const auto rings = std::uint32_t(std::sqrt(double(wanted) / 4));
    TriangleMesh mesh = bench::latitude_ball(rings, 2 * rings, 0.02);
    bench::round_to_float(mesh);
    const NamedMesh named{"ball", &mesh, {}, ""};
    const std::string out = argv[2];
    try {
        write_file_atomically(out + ".ply", ply_bytes(mesh));
        write_file_atomically(out + ".stl", stl_bytes({&named, 1}));
        write_file_atomically(out + ".obj", obj_text({&named, 1}));
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    std::printf("%zu triangles, %zu vertices\n", mesh.triangles.size(), mesh.positions.size());
    return 0;
}

// Makes a closed bumpy ball of about N triangles as PLY, STL and OBJ, to measure how meshes load.
//
// Usage: alhazen_make_mesh N OUT   ->   OUT.ply OUT.stl OUT.obj

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "alhazen/base/file.h"
#include "alhazen/importers/mesh_export.h"

namespace {

using namespace alhazen;

/// Rings of latitude between two poles; radius 1 with bumps. Coordinates are floats.
TriangleMesh bumpy_ball(std::uint32_t rings, std::uint32_t sectors) {
    TriangleMesh mesh;
    const auto add = [&](double theta, double phi) {
        const double r = 1 + 0.02 * std::sin(40 * theta) * std::sin(40 * phi);
        volatile float c[3] = {float(r * std::sin(theta) * std::cos(phi)),
                               float(r * std::sin(theta) * std::sin(phi)),
                               float(r * std::cos(theta))};
        mesh.positions.push_back({double(c[0]), double(c[1]), double(c[2])});
    };
    mesh.positions.reserve(std::size_t{rings} * sectors + 2);
    mesh.triangles.reserve(std::size_t{2} * rings * sectors);
    for (std::uint32_t i = 0; i < rings; ++i) {
        for (std::uint32_t j = 0; j < sectors; ++j) {
            add(std::numbers::pi * (i + 1) / (rings + 1), 2 * std::numbers::pi * j / sectors);
        }
    }
    add(0, 0);
    add(std::numbers::pi, 0);
    const std::uint32_t top = rings * sectors;
    for (std::uint32_t j = 0; j < sectors; ++j) {
        const std::uint32_t k = (j + 1) % sectors;
        mesh.triangles.push_back({top, j, k});
        for (std::uint32_t i = 0; i + 1 < rings; ++i) {
            const std::uint32_t a = i * sectors, b = a + sectors;
            mesh.triangles.push_back({a + j, b + j, b + k});
            mesh.triangles.push_back({a + j, b + k, a + k});
        }
        const std::uint32_t last = (rings - 1) * sectors;
        mesh.triangles.push_back({top + 1, last + k, last + j});
    }
    return mesh;
}

}  // namespace

int main(int argc, char** argv) {
    const long wanted = argc == 3 ? std::atol(argv[1]) : 0;
    if (wanted < 8 || wanted > 500'000'000) {
        std::fputs("usage: alhazen_make_mesh TRIANGLES OUT\n", stderr);
        return 2;
    }
    const auto rings = std::uint32_t(std::sqrt(double(wanted) / 4));
    const TriangleMesh mesh = bumpy_ball(rings, 2 * rings);
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

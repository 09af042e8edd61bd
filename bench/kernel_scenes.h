#pragma once
/// Triangle scenes for the kernel benchmark.

#include <filesystem>
#include <string>
#include <vector>

#include "alhazen/shapes/triangle_mesh.h"

namespace alhazen::bench {

struct KernelScene {
    std::string name;
    TriangleMesh mesh;
    Vec3 eye, look_at;
};

/// A mesh file seen from the front.
[[nodiscard]] KernelScene mesh_scene(const std::string& name, const std::filesystem::path& file);

/// Haines' sphereflake of 1 + 9 + ... + 9^depth spheres, each an icosahedron split `splits` times,
/// and its floor. Source: Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11),
/// 1987. Differs: the children's directions are our own; what matters here is the clustering.
[[nodiscard]] KernelScene tessellated_balls(int depth, int splits);

}  // namespace alhazen::bench

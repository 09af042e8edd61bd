#pragma once
/// Scenes of the kernel benchmarks: triangles, spheres and cylinders with all numbers rounded to
/// float, so that a kernel in float has the same primitives.

#include <filesystem>
#include <string>
#include <vector>

#include "alhazen/shapes/meshes/triangle_mesh.h"
#include "alhazen/shapes/quadrics/cylinder.h"
#include "alhazen/shapes/quadrics/sphere.h"

namespace alhazen::bench {

struct KernelScene {
    std::string name;
    TriangleMesh mesh;
    std::vector<Sphere> spheres;
    std::vector<Cylinder> cylinders;  ///< with caps
    Vec3 eye, look_at, light;
    double ray_start = 0;  ///< distance from the surface at which secondary rays start

    [[nodiscard]] Box3 box() const;
    [[nodiscard]] std::size_t size() const {
        return mesh.triangles.size() + spheres.size() + cylinders.size();
    }
    /// A text such as "69 451 triangles, 820 spheres".
    [[nodiscard]] std::string contents() const;
};

/// Makes the scene of a name:
///   FILE                a mesh file seen from the front
///   FILE@N              the same, every triangle split into four N times
///   interior:FILE       seen from inside, along its longest side, with the light inside
///   balls:DEPTH:SPLITS  spheres around spheres (below) tessellated, 20 4^SPLITS triangles each
///   spheres:DEPTH       the same as exact spheres (and the floor, two triangles)
///   mixed:DEPTH         triangles, exact spheres and cylinders: every other ball is tessellated,
///                       balls are apart and cylinders join them
/// Throws Error (Usage, File).
[[nodiscard]] KernelScene make_scene(const std::string& spec);

inline constexpr const char* kSceneSpecs =
    "FILE, FILE@N, interior:FILE, balls:DEPTH:SPLITS, spheres:DEPTH, mixed:DEPTH";

/// A mesh file seen from the front.
[[nodiscard]] KernelScene mesh_scene(const std::string& name, const std::filesystem::path& file);

/// 820 spheres around spheres of about triangles / 820 triangles each: the same shape at any
/// tessellation.
[[nodiscard]] KernelScene growing_balls(std::size_t triangles);

}  // namespace alhazen::bench

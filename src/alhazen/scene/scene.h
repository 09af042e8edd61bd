#pragma once
/// The compiled scene. Immutable while rendering.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "alhazen/accel/wide_bvh/build/build_options.h"
#include "alhazen/primitives/aggregate.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// Sizes and counts of a scene.
struct SceneCensus {
    std::uint64_t analytic_shapes = 0;       ///< stored, each object once
    std::uint64_t triangles = 0;             ///< stored, each object once
    std::uint64_t instances = 0;             ///< stored
    std::uint64_t effective_primitives = 0;  ///< instances expanded; saturates
    int instance_depth = 0;                  ///< deepest nesting of instances
    std::uint64_t solids = 0;                ///< CSG objects, each stored once
    std::uint64_t solid_leaves = 0;          ///< their operands that are not operators
    std::uint64_t scene_bytes = 0;           ///< shapes, meshes, textures
    std::uint64_t texture_bytes = 0;         ///< of these, the textures
    std::uint64_t accelerator_bytes = 0;
};

struct Scene {
    std::shared_ptr<const Aggregate> aggregate;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Light> lights;
    std::vector<CameraDescription> cameras;
    ShadingConventions conventions;
    Rgb background;
    bool all_opaque = false;   ///< no material lets light through
    bool has_masks = false;    ///< some part has a visibility mask
    bool has_mipmaps = false;  ///< some texture is filtered by the footprint of the ray's cone
    std::string accelerator;
    SceneCensus census;
};

struct CompileOptions {
    std::string accelerator = "wide_bvh";
    std::string csg = "event_heap";  ///< the CSG evaluator
    BuildOptions build{};
    /// Objects that name an accelerator get it; false: the accelerator above traces everything.
    bool own_accelerators = true;
};

/// Builds the scene. The description must have passed `validate`. Throws Error: Usage for an
/// unknown accelerator or CSG evaluator, Resource for too many primitives or too deep nesting.
[[nodiscard]] Scene compile(const SceneDescription& description,
                            const CompileOptions& options = {});

/// The same for callers that no longer need the meshes of `description`: meshes that are placed
/// once, by a transform, are moved instead of copied and are null afterwards.
[[nodiscard]] Scene compile_taking_meshes(SceneDescription& description,
                                          const CompileOptions& options = {});

/// The camera called `name`, or the one at that position when `name` is a number, or the first for
/// an empty name. Throws Error (Usage) listing the cameras.
[[nodiscard]] const CameraDescription& find_camera(const Scene& scene, const std::string& name);

}  // namespace alhazen

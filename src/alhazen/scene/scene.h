#pragma once
/// The compiled scene: an aggregate for ray tracing, and materials, textures, lights and cameras.
/// Immutable while rendering.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "alhazen/accel/wide_bvh/build/build_options.h"
#include "alhazen/primitives/aggregate.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

class Environment;
class NearbyParts;

/// Counts of a scene. Those of primitives are 0 without an aggregate.
struct SceneCensus {
    std::uint64_t analytic_shapes = 0;       ///< stored, each object once
    std::uint64_t triangles = 0;             ///< stored, each object once
    std::uint64_t instances = 0;             ///< stored
    std::uint64_t effective_primitives = 0;  ///< instances expanded; saturates
    int instance_depth = 0;                  ///< deepest nesting of instances
    std::uint64_t solids = 0;                ///< CSG solids, each stored once
    std::uint64_t solid_leaves = 0;          ///< their operands that are no operators
    std::uint64_t moving_things = 0;         ///< moving instances and triangles
    std::uint64_t scene_bytes = 0;           ///< shapes, meshes, textures
    std::uint64_t texture_bytes = 0;         ///< the textures' share of scene_bytes
    std::uint64_t accelerator_bytes = 0;
};

/// Conventions of the scene file that renderers, samplers and picture writers read.
struct RenderConventions {
    ShadingConventions shading;
    SamplingConventions sampling;
    FilmConventions film;
};

/// The material of walls that parts of `surface` cut into volumes of `volume`.
struct WallMaterial {
    MaterialId surface{}, volume{};
    Material material;
};

struct Scene {
    std::shared_ptr<const Aggregate> aggregate;  ///< null until it is built
    std::vector<Material> materials;
    /// [material] 1: some part below the root has it, seen or not; empty: unknown.
    std::vector<std::uint8_t> used_materials;
    std::vector<WallMaterial> walls;  ///< those with a Surface::volume
    std::vector<Texture> textures;
    std::vector<Light> lights;
    std::vector<CameraDescription> cameras;  ///< as the shutter opens; keys have relative times
    RenderConventions conventions;
    Rgb background;
    bool all_opaque = false;      ///< no material lets light through
    bool may_be_passed = false;   ///< rays may pass points of some material's surfaces
    bool has_scattering = false;  ///< some material scatters light inside volumes
    bool has_masks = false;       ///< some part is not visible to all rays
    /// Some part is visible to some kinds of rays of light transport (kConnectingRays included),
    /// but not to all.
    bool has_partial_masks = false;
    /// Some part is visible to some of reflected, refracted and connecting rays (kConnectingRays),
    /// but not to all of them.
    bool hides_lights_from_some = false;
    bool has_mipmaps = false;  ///< some texture is filtered by the cone of the ray
    bool has_solid_textures = false;
    /// [material] 1: its appearance depends on texture coordinates; empty: none does.
    std::vector<std::uint8_t> reads_coordinates;
    /// closed_parts_of; empty unless kt acts by distance, or insides have a colour
    /// (ShadingConventions).
    std::vector<std::uint8_t> closed_parts;
    bool has_motion = false;  ///< some part or mesh moves while the shutter is open
    /// Null: no material lets light into volumes, or nothing is known.
    std::shared_ptr<const NearbyParts> nearby_parts;
    std::string accelerator;  ///< name of the accelerator; empty without an aggregate
    SceneCensus census;
    /// Null: `background` lights the scene for physically based renderers.
    std::shared_ptr<const Environment> environment;

    /// The i-th material of a surface, with the volume that the surface bounds.
    [[nodiscard]] const Material& material_of(const Surface& surface, std::size_t i = 0) const {
        const MaterialId own = surface.materials[i];
        if (surface.volume) {
            for (const WallMaterial& wall : walls) {
                if (wall.surface == own && wall.volume == *surface.volume) return wall.material;
            }
        }
        return materials[static_cast<std::size_t>(own)];
    }
    [[nodiscard]] bool is_used(std::size_t material) const {
        return used_materials.empty() || used_materials[material] != 0;
    }
    /// The number of used materials for which `has` is true.
    template <class Property>
    [[nodiscard]] std::size_t count_used(const Property& has) const {
        std::size_t count = 0;
        for (std::size_t i = 0; i < materials.size(); ++i) {
            if (is_used(i) && has(materials[i])) ++count;
        }
        return count;
    }
    /// True if a shadow ray that meets any surface is blocked.
    [[nodiscard]] bool all_block_light() const {
        return all_opaque ||
               (conventions.shading.shadow_tint == ShadingConventions::ShadowTint::Opaque &&
                !may_be_passed);
    }
    /// See `closed_parts`.
    [[nodiscard]] bool is_closed(std::uint32_t part) const {
        return part < closed_parts.size() && closed_parts[part] != 0;
    }
};

/// [part] 1: part of a solid of constructive geometry, or a surface that lets light through and
/// encloses a volume, facing outward (`opaque_too`: also an opaque one). Parts are numbered as by
/// PartNumbers.
[[nodiscard]] std::vector<std::uint8_t> closed_parts_of(const SceneDescription& description,
                                                        const std::vector<Material>& materials,
                                                        bool opaque_too = false);

struct CompileOptions {
    std::string accelerator = "wide_bvh";
    std::string csg = "event_heap";  ///< evaluator of CSG solids
    BuildOptions build{};
    /// True: objects that name an accelerator get it. False: `accelerator` is used for all objects.
    bool own_accelerators = true;
};

/// The scene with its aggregate: `compile_without_geometry`, then `build_aggregate`. The
/// description must have passed `validate`.
[[nodiscard]] Scene compile(const SceneDescription& description,
                            const CompileOptions& options = {});

/// Compiles materials, textures, lights, cameras and conventions without an aggregate, for
/// renderers that need none.
[[nodiscard]] Scene compile_without_geometry(const SceneDescription& description);

/// Builds the aggregate of a scene that was compiled from `description` without geometry. Throws
/// Error: Usage for an unknown accelerator or CSG evaluator, Resource for too many primitives or
/// too deep nesting.
void build_aggregate(const SceneDescription& description, const CompileOptions& options,
                     Scene& scene);

/// As `build_aggregate`, for callers that no longer need the meshes of `description`: meshes that
/// are placed once, by a transform, are moved instead of copied and are null afterwards.
void build_aggregate_taking_meshes(SceneDescription& description, const CompileOptions& options,
                                   Scene& scene);

/// The camera called `name`; the one at that position if `name` is a number; the first if it is
/// empty. Throws Error (Usage) with a list of the cameras.
[[nodiscard]] const CameraDescription& find_camera(const Scene& scene, const std::string& name);

}  // namespace alhazen

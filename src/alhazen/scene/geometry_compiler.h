#pragma once
/// Turns the objects of a description into aggregates.
///
/// Internal to `compile`.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/csg/csg_aggregate.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/scene/scene.h"
#include "alhazen/scene_model/part_traversal.h"

namespace alhazen {

/// Sides of a surface of this material that end shadow rays.
[[nodiscard]] Opacity opacity_of(const Material& material);

/// Compiles one description once. Objects with one user are flattened into it, the others are
/// built once and instanced. Validation bounds the nesting, which bounds the recursion here.
class GeometryCompiler {
  public:
    /// `spare_meshes`: meshes of the description that may be moved into the scene; null: none.
    GeometryCompiler(const SceneDescription& description, const CompileOptions& options,
                     std::vector<MeshDescription>* spare_meshes);

    /// Sets the aggregate and everything derived from the geometry.
    void build(Scene& scene);

  private:
    /// An aggregate and its counts, as in SceneCensus.
    struct Built {
        std::shared_ptr<const Aggregate> aggregate;
        std::uint64_t effective_primitives = 0;
        int instance_depth = 0;
    };
    struct Draft {
        PrimitiveTable table;
        std::vector<Instance> moving;  ///< instances that move or contain motion
        Built built;
    };
    struct SolidDraft : Draft {
        CsgExpression expression;
        /// [leaf] kind of its primitive and index within the kind; ids are known once the table is
        /// finished.
        std::vector<std::pair<std::uint32_t, std::uint32_t>> leaves;
        bool any_cut = false;  ///< some leaf's cut surface shows the minuend
    };
    struct PlacedPart {
        const Part& part;
        Affine outer_from_part;
        std::uint32_t number;
        RayMask visible_to = kAllRays;
    };
    /// Properties shared by all operands of an object.
    struct Operands {
        Affine outer_from_object;
        RayMask visible_to = kAllRays;
        bool cuts = false;  ///< subtracted, with surfaces that show the material of the minuend
    };
    enum class Moves : std::uint8_t { Unknown, No, Yes };

    void count_mesh_uses();

    const Built& build_object(std::size_t index);
    /// Builds the aggregate of a draft. `accelerator`: the object's own, or empty.
    Built seal(Draft draft, const std::string& accelerator = {});
    /// Seals the table and counts its contents.
    Built finish(Draft& draft);

    void add_parts(std::size_t object, const Affine& outer_from_object, RayMask visible_to,
                   Draft& draft);
    /// The part with its place, its number and its mask inside an object of mask `visible_to`.
    PlacedPart place(const Part& part, const Affine& outer_from_object, std::uint32_t number,
                     RayMask visible_to);
    static void add_shape(const AnyShape& shape, const PlacedPart& placed, PrimitiveTable& table);
    void add_mesh(MeshIndex index, const PlacedPart& placed, Draft& draft);
    void add_shared_mesh(MeshIndex index, const PlacedPart& placed, Draft& draft);
    static void add_instance(const Built& child, const PlacedPart& placed, Draft& draft);
    /// A mesh to transform: the description's own if it may be taken, which saves the memory of a
    /// copy.
    [[nodiscard]] std::shared_ptr<TriangleMesh> own_copy(std::size_t mesh) const;

    // ---- Constructive solids: compile_solids.cpp.
    /// Builds the object as one solid; for a group, the union.
    const Built& build_solid(std::size_t index);
    /// Appends the object as a node of the expression.
    void add_operands(std::size_t object, const Operands& all, SolidDraft& draft);

    // ---- Motion: compile_motion.cpp.
    /// Collects the static primitives in one instance, beside the moving instances.
    Built seal_moving(Draft draft, const std::string& accelerator);
    Built seal_motion(Draft all, std::optional<std::size_t> resting);
    /// True if anything inside the object moves relative to it.
    bool moves_inside(std::size_t object);
    /// Adds a moving part, which always becomes an instance.
    void add_moving_part(const PlacedPart& placed, const Affine& outer_from_object, Draft& draft);
    /// `path`: null if only the contents move.
    static void add_moving(const Built& child, const PlacedPart& placed,
                           const TransformMotion* path, Draft& draft);
    /// Builds a mesh whose vertices may all move, in its own frame.
    Built deforming_mesh(std::size_t i, MaterialId material);

    const SceneDescription& d_;
    const CompileOptions& options_;
    std::vector<MeshDescription>* spare_meshes_;
    std::vector<Opacity> opacity_;      ///< [material]
    std::vector<bool> clear_;           ///< [material] is_clear
    std::vector<Built> built_objects_;  ///< [object] as part of a group; null: not yet built
    std::vector<Built> built_solids_;   ///< [object] as a solid; null: not yet built
    std::map<std::pair<std::size_t, MaterialId>, Built> built_meshes_;
    PartNumbers numbers_;
    std::set<std::pair<MaterialId, MaterialId>> walls_;  ///< as in WallMaterial
    std::vector<std::uint32_t> mesh_uses_;               ///< [mesh]
    std::vector<Moves> moves_;                           ///< [object] moves_inside
    bool has_masks_ = false, has_partial_masks_ = false, hides_lights_from_some_ = false;
    SceneCensus census_;
};

}  // namespace alhazen

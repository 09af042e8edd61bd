#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/motion/motion_aggregate.h"
#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"
#include "alhazen/csg/csg_aggregate.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/scene/compile_materials.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

namespace {

/// Larger meshes, in triangles, that are used more than once are instanced, not copied.
constexpr std::size_t kInstancedMeshTriangles = 64;

std::uint64_t saturating_add(std::uint64_t a, std::uint64_t b) {
    return a > std::numeric_limits<std::uint64_t>::max() - b
               ? std::numeric_limits<std::uint64_t>::max()
               : a + b;
}

Opacity opacity_of(const Material& material) {
    if (!material.is_opaque()) return Opacity::Transparent;
    return material.double_sided ? Opacity::Opaque : Opacity::OpaqueFromFront;
}

/// The positions and directions of lights, as end points of shadow rays.
std::vector<RayEnd> ray_ends_at(const std::vector<LightDescription>& lights) {
    std::vector<RayEnd> ends;
    for (const LightDescription& light : lights) {
        std::visit(
            [&]<class L>(const L& l) {
                if constexpr (requires { l.position; }) ends.push_back({l.position, false});
                if constexpr (requires { l.to_light; }) ends.push_back({l.to_light, true});
            },
            light.light);
    }
    return ends;
}

/// An aggregate and its counts, as in SceneCensus.
struct Built {
    std::shared_ptr<const Aggregate> aggregate;
    std::uint64_t effective_primitives = 0;
    int instance_depth = 0;
};

class Compiler {
  public:
    /// `spare_meshes`: meshes of the description that may be moved into the scene; null: none.
    Compiler(const SceneDescription& description, const CompileOptions& options,
             std::vector<MeshDescription>* spare_meshes)
        : d_(description),
          options_(options),
          spare_meshes_(spare_meshes),
          built_objects_(description.objects.size()),
          built_solids_(description.objects.size()),
          object_uses_(description.objects.size(), 0),
          mesh_uses_(description.meshes.size(), 0),
          moves_(description.objects.size(), Moves::Unknown) {}

    /// Sets the aggregate and everything derived from the geometry.
    void build(Scene& scene) {
        (void)find_csg_evaluator(options_.csg);  // throws for an unknown one in any scene
        for (const Material& m : scene.materials) opacity_.push_back(opacity_of(m));
        census_ = scene.census;
        count_uses();
        number_parts();
        const Built root = build_object(static_cast<std::size_t>(d_.root));
        census_.effective_primitives = root.effective_primitives;
        census_.instance_depth = root.instance_depth;
        scene.aggregate = root.aggregate;
        scene.has_masks = has_masks_;
        scene.has_motion = census_.moving_things > 0;
        scene.census = census_;
        scene.accelerator = options_.accelerator;
    }

  private:
    /// Counts the users of each object and mesh: one user is flattened, several share an instance.
    void count_uses() {
        for (const ObjectDescription& object : d_.objects) {
            for (const Part& part : object.parts) {
                if (const auto* child = std::get_if<ObjectIndex>(&part.what)) {
                    ++object_uses_[static_cast<std::size_t>(*child)];
                } else if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
                    ++mesh_uses_[static_cast<std::size_t>(*mesh)];
                }
            }
        }
    }

    /// Numbers the parts through all objects: a number identifies one part of the description.
    void number_parts() {
        std::uint32_t next = 0;
        for (const ObjectDescription& object : d_.objects) {
            first_part_.push_back(next);
            next += static_cast<std::uint32_t>(object.parts.size());
        }
    }

    struct Draft {
        PrimitiveTable table;
        std::vector<Instance> moving;  ///< instances that move or contain motion
        Built built;
    };

    /// Validation bounds the nesting: recursion is safe here.
    const Built& build_object(std::size_t index) {
        if (d_.objects[index].combine != Combine::Group) return build_solid(index);
        if (!built_objects_[index].aggregate) {
            Draft draft;
            add_parts(index, Affine{}, kAllRays, draft);
            if (index == static_cast<std::size_t>(d_.root)) {
                draft.table.known_ray_ends = ray_ends_at(d_.lights);
            }
            const std::string& own = d_.objects[index].accelerator;
            built_objects_[index] = seal(std::move(draft), options_.own_accelerators ? own : "");
        }
        return built_objects_[index];
    }

    /// Builds the aggregate of a draft. `accelerator`: the object's own, or empty.
    Built seal(Draft draft, const std::string& accelerator = {}) {
        if (!draft.moving.empty()) return seal_moving(std::move(draft), accelerator);
        Built built = finish(draft);
        built.aggregate = make_aggregate(accelerator.empty() ? options_.accelerator : accelerator,
                                         std::move(draft.table), options_.build);
        census_.accelerator_bytes += built.aggregate->memory_bytes();
        return built;
    }

    /// Collects the static primitives in one instance, beside the moving instances.
    Built seal_moving(Draft draft, const std::string& accelerator) {
        Draft all;
        all.built = draft.built;
        std::optional<std::size_t> resting;
        std::vector<Instance> moving = std::move(draft.moving);
        draft.moving.clear();
        draft.table.finish();  // sets its size
        if (draft.table.size() > 0) {
            const bool alone = draft.table.size() == 1 && draft.table.first(kTriangleKind) == 1;
            const Built rest = seal(std::move(draft), accelerator);
            all.built = rest;
            ++all.built.instance_depth;
            all.table.instances.push_back(
                {.aggregate = rest.aggregate, .holds_one_shape = alone, .holds_rest = true});
            resting = 0;
        }
        for (Instance& instance : moving) all.table.instances.push_back(std::move(instance));
        return seal_motion(std::move(all), resting);
    }

    Built seal_motion(Draft all, std::optional<std::size_t> resting) {
        Built built = finish(all);
        if (resting) --census_.instances;
        if (built.instance_depth >= static_cast<int>(kMaxInstanceDepth)) {
            throw Error(ErrorKind::Resource,
                        fmt::format("objects that move are nested too deep: with what moves in "
                                    "them {} levels, at most {} are supported",
                                    built.instance_depth, kMaxInstanceDepth - 1));
        }
        census_.moving_things += all.table.size() - (resting ? 1 : 0);
        built.aggregate = std::make_shared<const MotionAggregate>(std::move(all.table), resting);
        census_.accelerator_bytes += built.aggregate->memory_bytes();
        return built;
    }

    /// Seals the table and counts its contents.
    Built finish(Draft& draft) {
        draft.table.material_opacity = opacity_;
        draft.table.finish();
        const std::uint32_t triangles =
            draft.table.first(kTriangleKind + 1) - draft.table.first(kTriangleKind);
        census_.analytic_shapes += draft.table.first(kTriangleKind);
        census_.triangles += triangles;
        census_.instances += draft.table.instances.size();
        census_.scene_bytes += draft.table.memory_bytes();
        Built built = std::move(draft.built);
        built.effective_primitives =
            saturating_add(built.effective_primitives, draft.table.first(kInstanceKind));
        return built;
    }

    struct PlacedPart {
        const Part& part;
        Affine outer_from_part;
        std::uint32_t number;
        RayMask visible_to = kAllRays;
    };

    /// Masks with the bits of all kinds of rays become kAllRays, because queries of renderers have
    /// the bit of one kind.
    static RayMask without_unused_bits(RayMask mask) {
        return (mask & kRaysOfAllKinds) == kRaysOfAllKinds ? kAllRays : mask;
    }

    struct SolidDraft : Draft {
        CsgExpression expression;
        /// [leaf] kind of its primitive and index within the kind; ids are known once the table is
        /// finished.
        std::vector<std::pair<std::uint32_t, std::uint32_t>> leaves;
        bool any_cut = false;  ///< some leaf's cut surface shows the minuend
    };

    /// Builds the object as one solid; for a group, the union.
    const Built& build_solid(std::size_t index) {
        if (!built_solids_[index].aggregate) {
            SolidDraft draft;
            add_operands(index, {}, draft);
            Built built = finish(draft);
            for (const auto& [kind, place] : draft.leaves) {
                draft.expression.leaves.push_back(PrimitiveId{draft.table.first(kind) + place});
            }
            if (!draft.any_cut) draft.expression.shows_minuend.clear();
            built.aggregate = std::make_shared<const CsgAggregate>(
                std::move(draft.table), std::move(draft.expression), options_.csg);
            census_.accelerator_bytes += built.aggregate->memory_bytes();
            ++census_.solids;
            census_.solid_leaves += draft.leaves.size();
            built_solids_[index] = std::move(built);
        }
        return built_solids_[index];
    }

    /// Properties shared by all operands of an object.
    struct Operands {
        Affine outer_from_object;
        RayMask visible_to = kAllRays;
        bool cuts = false;  ///< subtracted, with surfaces that show the material of the minuend
    };

    /// Appends the object as a node of the expression.
    void add_operands(std::size_t object, const Operands& all, SolidDraft& draft) {
        const std::size_t node = draft.expression.nodes.size();
        const Combine combine = d_.objects[object].combine;
        draft.expression.nodes.push_back(
            {combine == Combine::Group ? Combine::Union : combine, {}});
        bool cuts = all.cuts;
        const auto add_leaf = [&](std::size_t kind, std::size_t count) {
            draft.expression.nodes[node].operands.push_back(
                CsgOperand::leaf(static_cast<std::uint32_t>(draft.leaves.size())));
            draft.leaves.emplace_back(kind, count - 1);
            draft.expression.shows_minuend.push_back(cuts);
            draft.any_cut |= cuts;
        };
        const bool of_minuend = combine == Combine::Difference &&
                                d_.objects[object].cut_material == CutMaterial::Minuend;
        std::uint32_t number = first_part_[object];
        for (const Part& part : d_.objects[object].parts) {
            interruption_point();
            const PlacedPart placed{part, all.outer_from_object * part.object_from_part, number++,
                                    all.visible_to & without_unused_bits(part.visible_to)};
            has_masks_ = has_masks_ || placed.visible_to != kAllRays;
            cuts = all.cuts || (of_minuend && !draft.expression.nodes[node].operands.empty());
            if (const auto* shape = std::get_if<AnyShape>(&part.what)) {
                add_shape(*shape, placed, draft.table);
                add_leaf(shape->index(), shapes_in(draft.table, shape->index()));
            } else if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
                add_shared_mesh(*mesh, placed, draft);
                add_leaf(kInstanceKind, draft.table.instances.size());
            } else {
                const auto child = static_cast<std::size_t>(std::get<ObjectIndex>(part.what));
                if (object_uses_[child] == 1) {
                    draft.expression.nodes[node].operands.push_back(CsgOperand::node(
                        static_cast<std::uint32_t>(draft.expression.nodes.size())));
                    add_operands(child, {placed.outer_from_part, placed.visible_to, cuts}, draft);
                } else {
                    add_instance(build_solid(child), placed, draft);
                    add_leaf(kInstanceKind, draft.table.instances.size());
                }
            }
        }
    }

    static std::size_t shapes_in(const PrimitiveTable& table, std::size_t kind) {
        return std::apply(
            [&](const auto&... column) {
                const std::size_t sizes[] = {column.shapes.size()...};
                return sizes[kind];
            },
            table.columns);
    }

    void add_parts(std::size_t object, const Affine& outer_from_object, RayMask visible_to,
                   Draft& draft) {
        std::uint32_t number = first_part_[object];
        for (const Part& part : d_.objects[object].parts) {
            interruption_point();
            const PlacedPart placed{part, outer_from_object * part.object_from_part, number++,
                                    visible_to & without_unused_bits(part.visible_to)};
            has_masks_ = has_masks_ || placed.visible_to != kAllRays;
            if (part.motion) {
                add_moving_part(placed, outer_from_object, draft);
            } else if (const auto* shape = std::get_if<AnyShape>(&part.what)) {
                add_shape(*shape, placed, draft.table);
            } else if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
                add_mesh(*mesh, placed, draft);
            } else {
                const std::size_t child =
                    static_cast<std::size_t>(std::get<ObjectIndex>(part.what));
                if (is_dissolved(child)) {
                    add_parts(child, placed.outer_from_part, placed.visible_to, draft);
                } else if (moves_inside(child)) {
                    add_moving(build_object(child), placed, nullptr, draft);
                } else {
                    add_instance(build_object(child), placed, draft);
                }
            }
        }
    }

    /// True if anything inside the object moves relative to it.
    bool moves_inside(std::size_t object) {
        Moves& known = moves_[object];
        if (known != Moves::Unknown) return known == Moves::Yes;
        bool moves = false;
        for (const Part& part : d_.objects[object].parts) {
            moves = moves || part.motion;
            if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
                moves = moves || !d_.meshes[static_cast<std::size_t>(*mesh)].keys.empty();
            } else if (const auto* child = std::get_if<ObjectIndex>(&part.what)) {
                moves = moves || moves_inside(static_cast<std::size_t>(*child));
            }
        }
        known = moves ? Moves::Yes : Moves::No;
        return moves;
    }

    /// Adds a moving part, which always becomes an instance.
    void add_moving_part(const PlacedPart& placed, const Affine& outer_from_object, Draft& draft) {
        const PartMotion& motion = *placed.part.motion;
        const TransformMotion path =
            TransformMotion(relative_to(d_.shutter, motion.keys))
                .inside(outer_from_object == Affine{} ? motion.outer
                                                      : outer_from_object * motion.outer);
        const PlacedPart inside{placed.part, motion.inner, placed.number, kAllRays};
        Draft alone;
        if (const auto* shape = std::get_if<AnyShape>(&placed.part.what)) {
            add_shape(*shape, inside, alone.table);
        } else if (const auto* mesh = std::get_if<MeshIndex>(&placed.part.what)) {
            add_mesh(*mesh, inside, alone);
        } else {
            const auto child = static_cast<std::size_t>(std::get<ObjectIndex>(placed.part.what));
            if (motion.inner == Affine{}) {
                return add_moving(build_object(child), placed, &path, draft);
            }
            if (moves_inside(child)) {
                add_moving(build_object(child), inside, nullptr, alone);
            } else {
                add_instance(build_object(child), inside, alone);
            }
        }
        add_moving(seal(std::move(alone)), placed, &path, draft);
        draft.moving.back().holds_one_shape = std::holds_alternative<AnyShape>(placed.part.what);
    }

    /// `path`: null if only the contents move.
    static void add_moving(const Built& child, const PlacedPart& placed,
                           const TransformMotion* path, Draft& draft) {
        Draft one;
        one.built = std::move(draft.built);
        add_instance(child, placed, one);
        Instance& instance = one.table.instances.back();
        if (path != nullptr) {
            instance.motion = std::make_shared<const TransformMotion>(*path);
            instance.placement = path->at(0.0);
        }
        draft.built = std::move(one.built);
        draft.moving.push_back(std::move(instance));
    }

    /// True if the parts of a child become parts of the enclosing object.
    [[nodiscard]] bool is_dissolved(std::size_t child) const {
        const ObjectDescription& object = d_.objects[child];
        return object_uses_[child] == 1 && object.combine == Combine::Group &&
               object.accelerator.empty();
    }

    static void add_shape(const AnyShape& shape, const PlacedPart& placed, PrimitiveTable& table) {
        std::uint32_t placement = kNoPlacement;
        if (placed.outer_from_part != Affine{}) {
            placement = static_cast<std::uint32_t>(table.placements.size());
            table.placements.push_back({placed.outer_from_part, inverse(placed.outer_from_part)});
        }
        std::visit(
            [&]<class S>(const S& s) {
                auto& column = std::get<ShapeColumn<S>>(table.columns);
                column.shapes.push_back(s);
                column.placements.push_back(placement);
                column.materials.push_back(placed.part.material);
                column.parts.push_back(placed.number);
                column.set_last_visible_to(placed.visible_to);
            },
            shape);
    }

    void add_mesh(MeshIndex index, const PlacedPart& placed, Draft& draft) {
        const std::size_t i = static_cast<std::size_t>(index);
        const std::shared_ptr<TriangleMesh>& mesh = d_.meshes[i].mesh;
        const MaterialId material = placed.part.material;
        if (mesh->triangles.empty()) return;
        if (!d_.meshes[i].keys.empty()) {
            add_moving(deforming_mesh(i, material), placed, nullptr, draft);
            draft.moving.back().of_shared_mesh = true;
            return;
        }
        if (mesh_uses_[i] > 1 && mesh->triangles.size() > kInstancedMeshTriangles) {
            add_shared_mesh(index, placed, draft);
            return;
        }
        if (placed.outer_from_part == Affine{}) {
            draft.table.meshes.push_back(
                {mesh, material, 0, false, placed.number, placed.visible_to});
            return;
        }
        const std::shared_ptr<TriangleMesh> moved = own_copy(i);
        moved->transform(placed.outer_from_part);
        const bool mirrored = determinant(placed.outer_from_part.linear) < 0.0;
        draft.table.meshes.push_back(
            {moved, material, 0, mirrored, placed.number, placed.visible_to});
    }

    /// Builds a mesh whose vertices may all move, in its own frame.
    Built deforming_mesh(std::size_t i, MaterialId material) {
        const auto [found, fresh] = built_meshes_.try_emplace({i, material});
        if (fresh) {
            Draft alone;
            PlacedMesh& mesh =
                alone.table.meshes.emplace_back(PlacedMesh{d_.meshes[i].mesh, material});
            mesh.motion =
                std::make_shared<const MeshMotion>(relative_to(d_.shutter, d_.meshes[i].keys));
            found->second = seal_motion(std::move(alone), std::nullopt);
        }
        return found->second;
    }

    void add_shared_mesh(MeshIndex index, const PlacedPart& placed, Draft& draft) {
        const std::size_t i = static_cast<std::size_t>(index);
        const MaterialId material = placed.part.material;
        auto found = built_meshes_.find({i, material});
        if (found == built_meshes_.end()) {
            Draft shared;
            shared.table.meshes.push_back({d_.meshes[i].mesh, material, 0, false});
            found = built_meshes_.emplace(std::pair{i, material}, seal(std::move(shared))).first;
        }
        add_instance(found->second, placed, draft);
        draft.table.instances.back().of_shared_mesh = true;
    }

    /// A mesh to transform: the description's own if it may be taken, which saves the memory of a
    /// copy.
    [[nodiscard]] std::shared_ptr<TriangleMesh> own_copy(std::size_t mesh) const {
        if (spare_meshes_ != nullptr && mesh_uses_[mesh] == 1 &&
            (*spare_meshes_)[mesh].mesh.use_count() == 1) {
            return std::move((*spare_meshes_)[mesh].mesh);
        }
        return std::make_shared<TriangleMesh>(*d_.meshes[mesh].mesh);
    }

    static void add_instance(const Built& child, const PlacedPart& placed, Draft& draft) {
        const Affine& outer_from_inner = placed.outer_from_part;
        draft.table.instances.push_back({.aggregate = child.aggregate,
                                         .placement = {outer_from_inner, inverse(outer_from_inner)},
                                         .part = placed.number,
                                         .visible_to = placed.visible_to});
        draft.built.effective_primitives =
            saturating_add(draft.built.effective_primitives, child.effective_primitives);
        draft.built.instance_depth = std::max(draft.built.instance_depth, child.instance_depth + 1);
    }

    const SceneDescription& d_;
    const CompileOptions& options_;
    std::vector<MeshDescription>* spare_meshes_;
    std::vector<Opacity> opacity_;
    std::vector<std::uint32_t> first_part_;  ///< [object]
    std::vector<Built> built_objects_;
    std::vector<Built> built_solids_;
    std::map<std::pair<std::size_t, MaterialId>, Built> built_meshes_;
    std::vector<std::uint32_t> object_uses_;
    std::vector<std::uint32_t> mesh_uses_;
    enum class Moves : std::uint8_t { Unknown, No, Yes };
    std::vector<Moves> moves_;  ///< [object] moves_inside
    bool has_masks_ = false;
    SceneCensus census_;
};

}  // namespace

Scene compile_without_geometry(const SceneDescription& description) {
    Scene scene;
    compile_materials(description, scene);
    scene.all_opaque =
        std::all_of(scene.materials.begin(), scene.materials.end(),
                    [](const Material& m) { return opacity_of(m) == Opacity::Opaque; });
    scene.has_scattering =
        std::any_of(scene.materials.begin(), scene.materials.end(),
                    [](const Material& m) { return !m.scattering.coefficient.is_black(); });
    scene.census.texture_bytes = texture_bytes(scene.textures);
    scene.census.scene_bytes = scene.census.texture_bytes;
    return scene;
}

void build_aggregate(const SceneDescription& description, const CompileOptions& options,
                     Scene& scene) {
    Compiler(description, options, nullptr).build(scene);
}

void build_aggregate_taking_meshes(SceneDescription& description, const CompileOptions& options,
                                   Scene& scene) {
    Compiler(description, options, &description.meshes).build(scene);
}

Scene compile(const SceneDescription& description, const CompileOptions& options) {
    Scene scene = compile_without_geometry(description);
    build_aggregate(description, options, scene);
    return scene;
}

Scene compile_taking_meshes(SceneDescription& description, const CompileOptions& options) {
    Scene scene = compile_without_geometry(description);
    build_aggregate_taking_meshes(description, options, scene);
    return scene;
}

}  // namespace alhazen

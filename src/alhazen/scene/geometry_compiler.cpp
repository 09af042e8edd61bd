#include "alhazen/scene/geometry_compiler.h"

#include <algorithm>
#include <limits>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/interruption.h"
#include "alhazen/scene/nearby_parts.h"
#include "alhazen/shading/materials/wall_material.h"

namespace alhazen {

namespace {

/// Larger meshes, in triangles, that are used more than once are instanced, not copied.
constexpr std::size_t kInstancedMeshTriangles = 64;

std::uint64_t saturating_add(std::uint64_t a, std::uint64_t b) {
    return a > std::numeric_limits<std::uint64_t>::max() - b
               ? std::numeric_limits<std::uint64_t>::max()
               : a + b;
}

/// Masks with the bits of all kinds of rays become kAllRays, because queries of renderers have the
/// bit of one kind. What casts shadows blocks connections.
RayMask complete(RayMask mask) {
    if ((mask & kRaysOfAllKinds) == kRaysOfAllKinds) return kAllRays;
    return (mask & mask_of(RayKind::Shadow)) != 0 ? mask | kConnectingRays : mask;
}

/// Rays from a point that scatters to a light: those that connect, and those that may hit it.
constexpr RayMask kRaysToLights =
    kConnectingRays | mask_of(RayKind::Reflection) | mask_of(RayKind::Refraction);

/// True if some of `rays` see the part, but not all.
bool is_seen_by_some(RayMask mask, RayMask rays) {
    return (mask & rays) != 0 && (mask & rays) != rays;
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

}  // namespace

Opacity opacity_of(const Material& material) {
    if (!material.is_opaque()) return Opacity::Transparent;
    return material.double_sided ? Opacity::Opaque : Opacity::OpaqueFromFront;
}

GeometryCompiler::GeometryCompiler(const SceneDescription& description,
                                   const CompileOptions& options,
                                   std::vector<MeshDescription>* spare_meshes)
    : d_(description),
      options_(options),
      spare_meshes_(spare_meshes),
      built_objects_(description.objects.size()),
      built_solids_(description.objects.size()),
      numbers_(description),
      mesh_uses_(description.meshes.size(), 0),
      moves_(description.objects.size(), Moves::Unknown) {}

void GeometryCompiler::build(Scene& scene) {
    (void)find_csg_evaluator(options_.csg);  // throws for an unknown one in any scene
    for (const Material& m : scene.materials) {
        opacity_.push_back(opacity_of(m));
        clear_.push_back(is_clear(m));
    }
    census_ = scene.census;
    count_mesh_uses();
    const Built root = build_object(static_cast<std::size_t>(d_.root));
    census_.effective_primitives = root.effective_primitives;
    census_.instance_depth = root.instance_depth;
    scene.aggregate = root.aggregate;
    for (const auto& [surface, volume] : walls_) {
        const auto material = [&](MaterialId id) -> const Material& {
            return scene.materials[static_cast<std::size_t>(id)];
        };
        scene.walls.push_back(
            {surface, volume, wall_material(material(surface), material(volume))});
    }
    scene.has_masks = has_masks_;
    scene.has_partial_masks = has_partial_masks_;
    scene.hides_lights_from_some = hides_lights_from_some_;
    scene.has_motion = census_.moving_things > 0;
    const bool any_volumes = std::any_of(scene.materials.begin(), scene.materials.end(),
                                         [](const Material& m) { return has_inside(m); });
    scene.nearby_parts = any_volumes ? std::make_shared<const NearbyParts>(
                                           *scene.aggregate, scene.materials, scene.has_motion)
                                     : nullptr;
    scene.census = census_;
    scene.accelerator = options_.accelerator;
}

void GeometryCompiler::count_mesh_uses() {
    for (const ObjectDescription& object : d_.objects) {
        for (const Part& part : object.parts) {
            if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
                ++mesh_uses_[static_cast<std::size_t>(*mesh)];
            }
        }
    }
}

const GeometryCompiler::Built& GeometryCompiler::build_object(std::size_t index) {
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

GeometryCompiler::Built GeometryCompiler::seal(Draft draft, const std::string& accelerator) {
    if (!draft.moving.empty()) return seal_moving(std::move(draft), accelerator);
    Built built = finish(draft);
    built.aggregate = make_aggregate(accelerator.empty() ? options_.accelerator : accelerator,
                                     std::move(draft.table), options_.build);
    census_.accelerator_bytes += built.aggregate->memory_bytes();
    return built;
}

GeometryCompiler::Built GeometryCompiler::finish(Draft& draft) {
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

GeometryCompiler::PlacedPart GeometryCompiler::place(const Part& part,
                                                     const Affine& outer_from_object,
                                                     std::uint32_t number, RayMask visible_to) {
    const PlacedPart placed{part, outer_from_object * part.object_from_part, number,
                            visible_to & complete(part.visible_to)};
    has_masks_ = has_masks_ || placed.visible_to != kAllRays;
    has_partial_masks_ =
        has_partial_masks_ || is_seen_by_some(placed.visible_to, kLightSurfaceMask);
    hides_lights_from_some_ =
        hides_lights_from_some_ || is_seen_by_some(placed.visible_to, kRaysToLights);
    return placed;
}

void GeometryCompiler::add_parts(std::size_t object, const Affine& outer_from_object,
                                 RayMask visible_to, Draft& draft) {
    std::uint32_t number = numbers_.first_of(object);
    for (const Part& part : d_.objects[object].parts) {
        interruption_point();
        const PlacedPart placed = place(part, outer_from_object, number++, visible_to);
        if (part.motion) {
            add_moving_part(placed, outer_from_object, draft);
        } else if (const auto* shape = std::get_if<AnyShape>(&part.what)) {
            add_shape(*shape, placed, draft.table);
        } else if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
            add_mesh(*mesh, placed, draft);
        } else {
            const std::size_t child = static_cast<std::size_t>(std::get<ObjectIndex>(part.what));
            if (numbers_.is_dissolved(child)) {
                add_parts(child, placed.outer_from_part, placed.visible_to, draft);
            } else if (moves_inside(child)) {
                add_moving(build_object(child), placed, nullptr, draft);
            } else {
                add_instance(build_object(child), placed, draft);
            }
        }
    }
}

void GeometryCompiler::add_shape(const AnyShape& shape, const PlacedPart& placed,
                                 PrimitiveTable& table) {
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

void GeometryCompiler::add_mesh(MeshIndex index, const PlacedPart& placed, Draft& draft) {
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
        draft.table.meshes.push_back({mesh, material, 0, false, placed.number, placed.visible_to});
        return;
    }
    const std::shared_ptr<TriangleMesh> moved = own_copy(i);
    moved->transform(placed.outer_from_part);
    const bool mirrored = determinant(placed.outer_from_part.linear) < 0.0;
    draft.table.meshes.push_back({moved, material, 0, mirrored, placed.number, placed.visible_to});
}

void GeometryCompiler::add_shared_mesh(MeshIndex index, const PlacedPart& placed, Draft& draft) {
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

std::shared_ptr<TriangleMesh> GeometryCompiler::own_copy(std::size_t mesh) const {
    if (spare_meshes_ != nullptr && mesh_uses_[mesh] == 1 &&
        (*spare_meshes_)[mesh].mesh.use_count() == 1) {
        return std::move((*spare_meshes_)[mesh].mesh);
    }
    return std::make_shared<TriangleMesh>(*d_.meshes[mesh].mesh);
}

void GeometryCompiler::add_instance(const Built& child, const PlacedPart& placed, Draft& draft) {
    const Affine& outer_from_inner = placed.outer_from_part;
    draft.table.instances.push_back({.aggregate = child.aggregate,
                                     .placement = {outer_from_inner, inverse(outer_from_inner)},
                                     .part = placed.number,
                                     .visible_to = placed.visible_to});
    draft.built.effective_primitives =
        saturating_add(draft.built.effective_primitives, child.effective_primitives);
    draft.built.instance_depth = std::max(draft.built.instance_depth, child.instance_depth + 1);
}

}  // namespace alhazen

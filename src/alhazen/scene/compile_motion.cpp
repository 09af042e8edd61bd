#include <fmt/format.h>

#include "alhazen/aggregates/motion/motion_aggregate.h"
#include "alhazen/base/error.h"
#include "alhazen/scene/geometry_compiler.h"

namespace alhazen {

GeometryCompiler::Built GeometryCompiler::seal_moving(Draft draft, const std::string& accelerator) {
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

GeometryCompiler::Built GeometryCompiler::seal_motion(Draft all,
                                                      std::optional<std::size_t> resting) {
    Built built = finish(all);
    if (resting) --census_.instances;
    if (built.instance_depth >= static_cast<int>(kMaxInstanceDepth)) {
        throw Error(ErrorKind::Scene,
                    fmt::format("objects that move are nested too deep: with what moves in "
                                "them {} levels, at most {} are supported",
                                built.instance_depth, kMaxInstanceDepth - 1));
    }
    census_.moving_things += all.table.size() - (resting ? 1 : 0);
    built.aggregate = std::make_shared<const MotionAggregate>(std::move(all.table), resting);
    census_.accelerator_bytes += built.aggregate->memory_bytes();
    return built;
}

bool GeometryCompiler::moves_inside(std::size_t object) {
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

void GeometryCompiler::add_moving_part(const PlacedPart& placed, const Affine& outer_from_object,
                                       Draft& draft) {
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

void GeometryCompiler::add_moving(const Built& child, const PlacedPart& placed,
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

GeometryCompiler::Built GeometryCompiler::deforming_mesh(std::size_t i, MaterialId material) {
    const auto [found, fresh] = built_meshes_.try_emplace({i, material});
    if (fresh) {
        Draft alone;
        PlacedMesh& mesh = alone.table.meshes.emplace_back(PlacedMesh{d_.meshes[i].mesh, material});
        mesh.motion =
            std::make_shared<const MeshMotion>(relative_to(d_.shutter, d_.meshes[i].keys));
        found->second = seal_motion(std::move(alone), std::nullopt);
    }
    return found->second;
}

}  // namespace alhazen

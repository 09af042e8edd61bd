#include "alhazen/base/interruption.h"
#include "alhazen/scene/geometry_compiler.h"

namespace alhazen {

namespace {

std::size_t shapes_in(const PrimitiveTable& table, std::size_t kind) {
    return std::apply(
        [&](const auto&... column) {
            const std::size_t sizes[] = {column.shapes.size()...};
            return sizes[kind];
        },
        table.columns);
}

}  // namespace

const GeometryCompiler::Built& GeometryCompiler::build_solid(std::size_t index) {
    if (!built_solids_[index].aggregate) {
        SolidDraft draft;
        add_operands(index, {}, draft);
        Built built = finish(draft);
        for (const auto& [kind, place] : draft.leaves) {
            draft.expression.leaves.push_back(PrimitiveId{draft.table.first(kind) + place});
        }
        if (!draft.any_cut) draft.expression.shows_minuend.clear();
        draft.expression.clear = clear_;
        const auto solid = std::make_shared<const CsgAggregate>(
            std::move(draft.table), std::move(draft.expression), options_.csg);
        for (const MaterialId surface : solid->solid().wall_materials()) {
            walls_.emplace(surface, MaterialId{solid->solid().only_medium()});
        }
        built.aggregate = solid;
        census_.accelerator_bytes += built.aggregate->memory_bytes();
        ++census_.solids;
        census_.solid_leaves += draft.leaves.size();
        built_solids_[index] = std::move(built);
    }
    return built_solids_[index];
}

void GeometryCompiler::add_operands(std::size_t object, const Operands& all, SolidDraft& draft) {
    const std::size_t node = draft.expression.nodes.size();
    const Combine combine = d_.objects[object].combine;
    draft.expression.nodes.push_back({combine == Combine::Group ? Combine::Union : combine, {}});
    bool cuts = all.cuts;
    const auto add_leaf = [&](std::size_t kind, std::size_t count) {
        draft.expression.nodes[node].operands.push_back(
            CsgOperand::leaf(static_cast<std::uint32_t>(draft.leaves.size())));
        draft.leaves.emplace_back(kind, count - 1);
        draft.expression.shows_minuend.push_back(cuts);
        draft.any_cut |= cuts;
    };
    const bool of_minuend =
        combine == Combine::Difference && d_.objects[object].cut_material == CutMaterial::Minuend;
    std::uint32_t number = numbers_.first_of(object);
    for (const Part& part : d_.objects[object].parts) {
        interruption_point();
        const PlacedPart placed = place(part, all.outer_from_object, number++, all.visible_to);
        cuts = all.cuts || (of_minuend && !draft.expression.nodes[node].operands.empty());
        if (const auto* shape = std::get_if<AnyShape>(&part.what)) {
            add_shape(*shape, placed, draft.table);
            add_leaf(shape->index(), shapes_in(draft.table, shape->index()));
        } else if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
            add_shared_mesh(*mesh, placed, draft);
            add_leaf(kInstanceKind, draft.table.instances.size());
        } else {
            const auto child = static_cast<std::size_t>(std::get<ObjectIndex>(part.what));
            if (numbers_.uses_of(child) == 1) {
                draft.expression.nodes[node].operands.push_back(
                    CsgOperand::node(static_cast<std::uint32_t>(draft.expression.nodes.size())));
                add_operands(child, {placed.outer_from_part, placed.visible_to, cuts}, draft);
            } else {
                add_instance(build_solid(child), placed, draft);
                add_leaf(kInstanceKind, draft.table.instances.size());
            }
        }
    }
}

}  // namespace alhazen

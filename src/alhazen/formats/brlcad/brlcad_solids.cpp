// Contents of regions: solids and combinations of solids, of one material.

#include "alhazen/formats/brlcad/brlcad_builder.h"
#include "alhazen/shapes/meshes/mesh_edges.h"

namespace alhazen {

BrlcadBuilder::Nesting::Nesting(BrlcadBuilder& builder, const BrlcadPlace& place)
    : builder_(builder) {
    if (++builder_.depth_ > builder_.options_.max_nesting) {
        throw Error(
            ErrorKind::Resource,
            "operators nested more than " + std::to_string(builder_.options_.max_nesting) + " deep",
            builder_.database_.at(place));
    }
}

BrlcadBuilder::Operand BrlcadBuilder::object(const BrlcadObject& object, MaterialId material) {
    const auto key = std::make_pair(&object, material);
    const auto known = objects_.find(key);
    if (known != objects_.end()) {
        if (known->second.outcome == Outcome::Unread) unread_ = unread_of_[&object];
        return known->second;
    }
    Operand made;
    if (const auto* comb = std::get_if<BrlcadCombination>(&object.what)) {
        if (!enter(object)) return {Outcome::Unread, {}};
        if (comb->tree.root() != BrlcadTree::kEmpty) {
            made = operand(comb->tree, comb->tree.root(), material);
        }
        leave(object);
        if (const auto* index = std::get_if<ObjectIndex>(&made.part.what);
            index != nullptr && made.outcome == Outcome::Present) {
            ObjectDescription& whole = scene_.objects[static_cast<std::size_t>(*index)];
            if (whole.name.empty()) whole.name = object.name;
        }
    } else {
        made = solid(object, material);
    }
    if (made.outcome == Outcome::Unread) unread_of_[&object] = unread_;
    return objects_[key] = made;
}

BrlcadBuilder::Operand BrlcadBuilder::operand(const BrlcadTree& tree, std::uint32_t index,
                                              MaterialId material) {
    const BrlcadNode& node = tree.node(index);
    if (node.op == BrlcadOperator::Leaf) return member(node, material);
    const Nesting nesting(*this, node.place);
    std::vector<Part> parts;
    for (std::size_t i = 0; i < node.operands.size(); ++i) {
        Operand made = operand(tree, node.operands[i], material);
        if (made.outcome == Outcome::Unread) return made;
        if (made.outcome == Outcome::Present) {
            parts.push_back(std::move(made.part));
        } else if (node.op == BrlcadOperator::Intersection ||
                   (node.op == BrlcadOperator::Difference && i == 0)) {
            return made;
        }
    }
    switch (node.op) {
        case BrlcadOperator::Intersection:
            return combined(Combine::Intersection, std::move(parts), node.place);
        case BrlcadOperator::Difference:
            return combined(Combine::Difference, std::move(parts), node.place);
        case BrlcadOperator::ExclusiveOr:
            if (parts.size() == 2) return exclusive_or(parts[0], parts[1], node.place);
            break;
        case BrlcadOperator::Union:
        case BrlcadOperator::Leaf:
            break;
    }
    return combined(Combine::Union, std::move(parts), node.place);
}

BrlcadBuilder::Operand BrlcadBuilder::exclusive_or(const Part& a, const Part& b,
                                                   const BrlcadPlace& place) {
    Operand only_a = combined(Combine::Difference, {a, b}, place);
    if (only_a.outcome != Outcome::Present) return only_a;
    Operand only_b = combined(Combine::Difference, {b, a}, place);
    if (only_b.outcome != Outcome::Present) return only_b;
    return combined(Combine::Union, {std::move(only_a.part), std::move(only_b.part)}, place);
}

BrlcadBuilder::Operand BrlcadBuilder::member(const BrlcadNode& leaf, MaterialId material) {
    const BrlcadObject* found = look_up(leaf);
    if (found == nullptr) return {};
    if (leaf.last_row == LastRow::Perspective) {
        unread_ = "its member '" + leaf.member + "' has no place";
        return {Outcome::Unread, {}};
    }
    Operand made = object(*found, material);
    if (made.outcome == Outcome::Present) made.part = placed(std::move(made.part), leaf);
    return made;
}

BrlcadBuilder::Operand BrlcadBuilder::combined(Combine combine, std::vector<Part> parts,
                                               const BrlcadPlace& place) {
    if (parts.empty()) return {};
    check_room(parts.size(), place);
    if (parts.size() == 1) return {Outcome::Present, std::move(parts[0])};
    ObjectDescription object;
    object.combine = combine;
    object.location = database_.at(place);
    for (const Part& part : parts) {
        if (!is_surface(part)) continue;
        // Surfaces support only union: they bound no volume that could be cut.
        if (combine != Combine::Union) {
            unread_ = "'" + part.name + "' is a surface and bounds no volume";
            return {Outcome::Unread, {}};
        }
        object.combine = Combine::Group;
    }
    object.parts = std::move(parts);
    const bool surface = object.combine == Combine::Group;
    Operand made{Outcome::Present, {}};
    const ObjectIndex index = add_object(std::move(object));
    if (surface) surface_objects_.insert(index);
    made.part.what = index;
    return made;
}

bool BrlcadBuilder::is_surface(const Part& part) const {
    if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
        return surface_meshes_.contains(*mesh);
    }
    const auto* object = std::get_if<ObjectIndex>(&part.what);
    return object != nullptr && surface_objects_.contains(*object);
}

Part BrlcadBuilder::part_of(const BrlcadObject& object, const BrlcadPiece& piece,
                            MaterialId material) {
    Part part;
    if (const auto* shape = std::get_if<AnyShape>(&piece.what)) {
        part.what = *shape;
    } else {
        const auto& mesh = std::get<std::shared_ptr<TriangleMesh>>(piece.what);
        const auto [known, fresh] =
            meshes_.try_emplace(&object, static_cast<MeshIndex>(scene_.meshes.size()));
        if (fresh) scene_.meshes.push_back({object.name, mesh, database_.at(object.place)});
        part.what = known->second;
        if (!pieces_.at(&object).closed) surface_meshes_.insert(known->second);
    }
    part.object_from_part = piece.solid_from_piece;
    part.material = material;
    part.name = object.name;
    part.location = database_.at(object.place);
    return part;
}

BrlcadBuilder::Operand BrlcadBuilder::solid(const BrlcadObject& object, MaterialId material) {
    const auto& given = std::get<BrlcadSolid>(object.what);
    const auto [entry, fresh] = pieces_.try_emplace(&object);
    if (fresh) {
        entry->second = brlcad_pieces(given);
        if (const auto* mesh = std::get_if<BrlcadMesh>(&given.form)) {
            tell_about_mesh(object, *mesh, entry->second);
        }
        if (!entry->second.doubt.empty() && entry->second.refused.empty()) {
            diagnostics_.warning(
                database_.at(object.place),
                "solid '" + object.name + "' (" + given.type + "): " + entry->second.doubt);
        }
    }
    const BrlcadPieces& pieces = entry->second;
    if (!pieces.refused.empty()) {
        unread_ = given.type == "comb"
                      ? "combination '" + object.name + "' " + pieces.refused
                      : "solid '" + object.name + "' (" + given.type + ") " + pieces.refused;
        return {Outcome::Unread, {}};
    }
    std::vector<Part> parts;
    for (const BrlcadPiece& piece : pieces.pieces) {
        parts.push_back(part_of(object, piece, material));
    }
    return combined(Combine::Union, std::move(parts), object.place);
}

void BrlcadBuilder::tell_about_mesh(const BrlcadObject& object, const BrlcadMesh& mesh,
                                    const BrlcadPieces& pieces) {
    if (mesh.plate) {
        diagnostics_.warning(database_.at(object.place),
                             "the plates of '" + object.name + "' are shown without thickness");
    } else if (mesh.solid && !pieces.closed) {
        diagnostics_.warning(database_.at(object.place),
                             "'" + object.name + "' is not closed; it is shown as a surface: " +
                                 mesh_edges(*mesh.mesh).description());
    }
}

}  // namespace alhazen

#include "alhazen/formats/brlcad/brlcad_builder.h"

#include <algorithm>
#include <unordered_set>

namespace alhazen {

BrlcadBuilder::BrlcadBuilder(const BrlcadDatabase& database, const ImportSource& source,
                             SceneDescription& scene, BrlcadMaterials& materials,
                             Diagnostics& diagnostics)
    : database_(database),
      options_(source.options),
      scene_(scene),
      materials_(materials),
      diagnostics_(diagnostics) {
    const std::uint64_t bytes = options_.max_made_bytes.value_or(
        (std::uint64_t{64} << 20) + 64 * std::uint64_t{source.bytes.size()});
    max_parts_ = bytes / sizeof(Part);
}

std::vector<std::string> BrlcadBuilder::top_level() const {
    std::unordered_set<std::string> used;
    for (const BrlcadObject& object : database_.objects) {
        const auto* comb = std::get_if<BrlcadCombination>(&object.what);
        if (comb == nullptr) continue;
        for (const BrlcadNode& node : comb->tree.nodes()) {
            if (node.op == BrlcadOperator::Leaf) used.insert(node.member);
        }
    }
    std::vector<std::string> names;
    std::unordered_set<const BrlcadObject*> reached;
    const auto reach = [&](const BrlcadObject& root) {
        std::vector<const BrlcadObject*> open{&root};
        while (!open.empty()) {
            const BrlcadObject* const object = open.back();
            open.pop_back();
            if (object == nullptr || !reached.insert(object).second) continue;
            const auto* comb = std::get_if<BrlcadCombination>(&object->what);
            if (comb == nullptr) continue;
            for (const BrlcadNode& node : comb->tree.nodes()) {
                if (node.op == BrlcadOperator::Leaf) open.push_back(database_.find(node.member));
            }
        }
    };
    for (const BrlcadObject& object : database_.objects) {
        if (used.contains(object.name)) continue;
        names.push_back(object.name);
        reach(object);
    }
    if (names.empty()) return names;
    // Combinations that contain each other, or themselves: `enter` reports them.
    for (const BrlcadObject& object : database_.objects) {
        if (reached.contains(&object)) continue;
        names.push_back(object.name);
        reach(object);
    }
    return names;
}

void BrlcadBuilder::build(std::span<const std::string> names) {
    std::vector<std::string> roots(names.begin(), names.end());
    if (roots.empty()) {
        roots = top_level();
        if (roots.empty() && !database_.objects.empty()) {
            diagnostics_.error({database_.file, 0, 0},
                               "every object is part of another; name the objects to show");
        }
    }
    ObjectDescription root;
    root.name = "scene";
    root.location = {database_.file, 0, 0};
    for (const std::string& name : roots) {
        if (database_.find(name) == nullptr) {
            diagnostics_.error({database_.file, 0, 0}, "there is no object '" + name + "'");
            continue;
        }
        BrlcadTree tree;
        tree.add_leaf(name, Affine{}, database_.find(name)->place);
        add_group_parts(tree, 0, BrlcadState{}, root.parts);
    }
    const bool empty = root.parts.empty();
    scene_.root = add_object(std::move(root));
    tell_left_out();
    if (empty && database_.faults + cyclic_.size() + left_out_ > 0) refuse();
}

void BrlcadBuilder::leave_out(const std::string& name, const FileLocation& where) {
    ++left_out_;
    diagnostics_.warning(where, "'" + name + "' is left out: " + unread_);
}

void BrlcadBuilder::refuse() {
    const std::vector<Diagnostic> found = diagnostics_.all();
    for (const Diagnostic& one : found) {
        if (one.severity == Severity::Warning) diagnostics_.error(one.location, one.message);
    }
    diagnostics_.error({database_.file, 0, 0}, "no part can be shown");
}

void BrlcadBuilder::tell_left_out() {
    if (air_regions_ == 0) return;
    diagnostics_.warning({database_.file, 0, 0},
                         air_regions_ == 1
                             ? "1 region of air is not drawn"
                             : std::to_string(air_regions_) + " regions of air are not drawn");
}

ObjectIndex BrlcadBuilder::add_object(ObjectDescription object) {
    scene_.objects.push_back(std::move(object));
    return static_cast<ObjectIndex>(scene_.objects.size() - 1);
}

void BrlcadBuilder::check_room(std::size_t parts, const BrlcadPlace& place) {
    parts_ += parts;
    if (parts_ <= max_parts_) return;
    throw Error(ErrorKind::Resource,
                "the combinations make more than " + std::to_string(max_parts_) +
                    " parts, which exceeds the memory limit",
                database_.at(place));
}

Part BrlcadBuilder::placed(Part part, const BrlcadNode& leaf) const {
    part.object_from_part = leaf.comb_from_member * part.object_from_part;
    part.name = leaf.member;
    part.location = database_.at(leaf.place);
    return part;
}

const BrlcadObject* BrlcadBuilder::look_up(const BrlcadNode& leaf) {
    const BrlcadObject* found = database_.find(leaf.member);
    if (found == nullptr && missing_.insert(leaf.member).second) {
        diagnostics_.warning(database_.at(leaf.place),
                             "there is no object '" + leaf.member + "'; it is left out");
    }
    return found;
}

bool BrlcadBuilder::enter(const BrlcadObject& object) {
    if (!open_.insert(&object).second) {
        unread_ = "combination '" + object.name + "' contains itself";
        if (cyclic_.insert(&object).second) {
            diagnostics_.warning(database_.at(object.place), unread_ + "; it is left out there");
        }
        return false;
    }
    if (open_.size() > static_cast<std::size_t>(options_.max_nesting)) {
        throw Error(
            ErrorKind::Resource,
            "combinations nested more than " + std::to_string(options_.max_nesting) + " deep",
            database_.at(object.place));
    }
    return true;
}

void BrlcadBuilder::leave(const BrlcadObject& object) {
    open_.erase(&object);
}

bool BrlcadBuilder::is_drawn(const BrlcadCombination& comb) {
    if (comb.air == 0) return true;
    ++air_regions_;
    return false;
}

void BrlcadBuilder::add_group_parts(const BrlcadTree& tree, std::uint32_t index,
                                    const BrlcadState& state, std::vector<Part>& parts) {
    if (index == BrlcadTree::kEmpty) return;
    const BrlcadNode& node = tree.node(index);
    if (node.op == BrlcadOperator::Union) {
        for (const std::uint32_t child : node.operands) add_group_parts(tree, child, state, parts);
        return;
    }
    check_room(1, node.place);
    if (node.last_row == LastRow::Perspective) return;
    if (node.op != BrlcadOperator::Leaf) {
        Regions regions;
        add_regions(tree, index, state, regions);
        for (PlacedRegion& region : regions) parts.push_back(std::move(region.part));
        return;
    }
    const BrlcadObject* found = look_up(node);
    if (found == nullptr) return;
    const auto* comb = std::get_if<BrlcadCombination>(&found->what);
    if (comb != nullptr && !comb->region) {
        const Operand made = group(*found, state);
        if (made.outcome == Outcome::Present) parts.push_back(placed(made.part, node));
    } else if (const auto made = region(*found, state)) {
        parts.push_back(placed(made->part, node));
    }
}

BrlcadBuilder::Operand BrlcadBuilder::group(const BrlcadObject& object, const BrlcadState& state) {
    const auto key = std::make_pair(&object, state.key());
    const auto known = groups_.find(key);
    if (known != groups_.end()) return known->second;
    Operand made;
    if (!enter(object)) return made;
    const auto& comb = std::get<BrlcadCombination>(object.what);
    ObjectDescription group;
    group.name = object.name;
    group.location = database_.at(object.place);
    add_group_parts(comb.tree, comb.tree.root(), state.below(comb), group.parts);
    if (!group.parts.empty()) {
        made.outcome = Outcome::Present;
        made.part.what = add_object(std::move(group));
    }
    leave(object);
    return groups_[key] = made;
}

std::optional<BrlcadBuilder::PlacedRegion> BrlcadBuilder::region(const BrlcadObject& object,
                                                                 const BrlcadState& state) {
    const auto key = std::make_pair(&object, state.key());
    const auto known = regions_.find(key);
    if (known != regions_.end()) return known->second;
    const auto* comb = std::get_if<BrlcadCombination>(&object.what);
    std::optional<PlacedRegion> made;
    const BrlcadState own = comb == nullptr ? state : state.below(*comb);
    const int region_id = comb == nullptr ? 0 : comb->region_id;
    if ((comb == nullptr || is_drawn(*comb)) &&
        !materials_.takes_environment(own, region_id, object.place)) {
        const MaterialId material =
            materials_.of(own, region_id, pattern_unit(object), object.place);
        const Operand whole = this->object(object, material);
        if (whole.outcome == Outcome::Present) made = PlacedRegion{whole.part, material};
        if (whole.outcome == Outcome::Unread) leave_out(object.name, database_.at(object.place));
    }
    return regions_[key] = made;
}

Vec2 BrlcadBuilder::pattern_unit(const BrlcadObject& object) const {
    const BrlcadObject* at = &object;
    for (int depth = 0; depth < options_.max_nesting; ++depth) {
        const auto* comb = std::get_if<BrlcadCombination>(&at->what);
        if (comb == nullptr) return brlcad_pattern_unit(std::get<BrlcadSolid>(at->what));
        std::uint32_t node = comb->tree.root();
        if (node == BrlcadTree::kEmpty) break;
        while (comb->tree.node(node).op != BrlcadOperator::Leaf) {
            node = comb->tree.node(node).operands[0];
        }
        at = database_.find(comb->tree.node(node).member);
        if (at == nullptr) break;
    }
    return {1, 1};
}

void BrlcadBuilder::add_member_regions(const BrlcadNode& leaf, const BrlcadState& state,
                                       Regions& regions) {
    const BrlcadObject* found = look_up(leaf);
    if (found == nullptr || leaf.last_row == LastRow::Perspective) return;
    const std::size_t first = regions.size();
    const auto* comb = std::get_if<BrlcadCombination>(&found->what);
    if (comb != nullptr && !comb->region) {
        if (!enter(*found)) return;
        add_regions(comb->tree, comb->tree.root(), state.below(*comb), regions);
        leave(*found);
    } else if (auto made = region(*found, state)) {
        made->part.name = leaf.member;
        regions.push_back(std::move(*made));
    }
    check_room(regions.size() - first, leaf.place);
    for (std::size_t i = first; i < regions.size(); ++i) {
        const std::string name = regions[i].part.name;
        regions[i].part = placed(std::move(regions[i].part), leaf);
        regions[i].part.name = name;
    }
}

void BrlcadBuilder::add_regions(const BrlcadTree& tree, std::uint32_t index,
                                const BrlcadState& state, Regions& regions) {
    if (index == BrlcadTree::kEmpty) return;
    const BrlcadNode& node = tree.node(index);
    if (node.op == BrlcadOperator::Leaf) return add_member_regions(node, state, regions);
    const std::span<const std::uint32_t> operands = node.operands;
    if (node.op == BrlcadOperator::Union) {
        for (const std::uint32_t child : operands) add_regions(tree, child, state, regions);
        return;
    }
    const Nesting nesting(*this, node.place);
    const std::size_t first = regions.size();
    add_regions(tree, operands[0], state, regions);
    const Combine combine =
        node.op == BrlcadOperator::Intersection ? Combine::Intersection : Combine::Difference;
    cut_regions(tree, operands.subspan(1), combine, first, regions);
    if (node.op != BrlcadOperator::ExclusiveOr) return;
    // Exclusive or: adds the second operand without the first.
    const std::size_t second = regions.size();
    add_regions(tree, operands[1], state, regions);
    cut_regions(tree, operands.first(1), combine, second, regions);
}

void BrlcadBuilder::cut_regions(const BrlcadTree& tree, std::span<const std::uint32_t> others,
                                Combine combine, std::size_t first, Regions& regions) {
    std::size_t kept = first;
    for (std::size_t i = first; i < regions.size(); ++i) {
        PlacedRegion region = std::move(regions[i]);
        const std::string name = region.part.name;
        const FileLocation where = region.part.location;
        Operand result{Outcome::Present, {}};
        std::vector<Part> parts{std::move(region.part)};
        for (const std::uint32_t other : others) {
            Operand cut = operand(tree, other, region.material);
            if (cut.outcome == Outcome::Unread ||
                (cut.outcome == Outcome::Empty && combine == Combine::Intersection)) {
                result.outcome = cut.outcome;
                break;
            }
            if (cut.outcome == Outcome::Present) parts.push_back(std::move(cut.part));
        }
        if (result.outcome == Outcome::Present) {
            result = combined(combine, std::move(parts), {where.line, where.column});
        }
        if (result.outcome == Outcome::Unread) leave_out(name, where);
        if (result.outcome != Outcome::Present) continue;
        result.part.name = name;
        result.part.location = where;
        regions[kept++] = {std::move(result.part), region.material};
    }
    regions.resize(kept);
}

}  // namespace alhazen

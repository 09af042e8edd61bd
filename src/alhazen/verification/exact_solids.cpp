#include "alhazen/verification/exact_solids.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/solids/solid_scene.h"

namespace alhazen {

namespace {

/// Every line tests every leaf; CSG objects with more leaves are compared with `roth` only.
constexpr std::uint32_t kMostLeaves = 4096;
/// Limits of the unchecked solids that are named, and of the solids of the scene that are searched
/// for them.
constexpr std::size_t kMostNamedSolids = 20;
constexpr std::uint64_t kMostLookedThrough = 1'000'000;

/// The reason why crossings of a primitive have no formula; empty if they have one.
std::string why_unchecked(const PrimitiveTable& table, PrimitiveId id) {
    const std::uint32_t kind = table.kind(id);
    if (kind == kInstanceKind) return "what is placed several times has no formula as an operand";
    if (kind == kTriangleKind) return "a mesh has no formula";
    if (has_exact_crossings(table, id)) return {};
    const char* name = "shape";
    std::uint32_t k = 0;
    std::apply(
        [&](const auto&... column) {
            ((k++ == kind
                  ? void(name = std::remove_cvref_t<decltype(column.shapes)>::value_type::kName)
                  : void()),
             ...);
        },
        table.columns);
    return fmt::format("a {} has no formula", name);
}
std::string why_unchecked(const CsgSolid& solid) {
    if (solid.leaf_count() > kMostLeaves) {
        return fmt::format("it has {} operands, more than {}", solid.leaf_count(), kMostLeaves);
    }
    for (const PrimitiveId leaf : solid.expression().leaves) {
        std::string reason = why_unchecked(solid.table(), leaf);
        if (!reason.empty()) return reason;
    }
    return {};
}

/// Collects the solids that an aggregate stores, instances included.
class Collector {
  public:
    void add(const std::shared_ptr<const Aggregate>& aggregate) {
        if (!seen_.insert(aggregate.get()).second) return;
        if (const auto* csg = dynamic_cast<const CsgAggregate*>(aggregate.get())) {
            solids.push_back({aggregate, &csg->solid(), why_unchecked(csg->solid()),
                              aggregate.get(), kNoPrimitive,
                              std::make_shared<const SolidList>(aggregate)});
            return;
        }
        add_inside(*aggregate);
    }
    std::vector<ExactSolid> solids;

  private:
    void add_inside(const Aggregate& aggregate) {
        const PrimitiveTable& table = aggregate.primitives();
        std::uint32_t kind = 0;
        const auto visit = [&](const auto& column) {
            const std::uint32_t first = table.first(kind++);
            for (std::uint32_t i = 0; i < column.shapes.size(); ++i) {
                if (!column.shapes[i].closed()) continue;
                add_shape(aggregate, column, i, PrimitiveId{first + i});
            }
        };
        std::apply([&](const auto&... column) { (visit(column), ...); }, table.columns);
        for (const Instance& instance : table.instances) add(instance.aggregate);
    }

    template <class Column>
    void add_shape(const Aggregate& holder, const Column& column, std::uint32_t i, PrimitiveId id) {
        const PrimitiveTable& table = holder.primitives();
        PrimitiveTable alone;
        alone.material_opacity = {Opacity::Opaque};
        auto& own = std::get<Column>(alone.columns);
        own.shapes.push_back(column.shapes[i]);
        own.materials.push_back(MaterialId{0});
        own.placements.push_back(kNoPlacement);
        if (column.placements[i] != kNoPlacement) {
            own.placements.back() = 0;
            alone.placements.push_back(table.placements[column.placements[i]]);
        }
        alone.finish();
        const auto aggregate = make_aggregate("list", std::move(alone), {});
        solids.push_back({aggregate, nullptr, why_unchecked(table, id), &holder, id,
                          std::make_shared<const SolidList>(aggregate)});
    }

    std::set<const Aggregate*> seen_;
};

}  // namespace

bool ExactSolid::begins_inside(const Ray& ray) const {
    std::vector<SolidId> inside;
    solids->inside_at_minus_infinity(ray, inside);
    return !inside.empty();
}

ExactCrossings ExactSolid::crossings(const ExactLine& line, Real128 least) const {
    ExactCrossings found = csg != nullptr
                               ? exact_crossings(*csg, line, least)
                               : exact_crossings(aggregate->primitives(), PrimitiveId{0}, line);
    drop_thin(found, least);
    return found;
}

Real128 ExactSolid::nearest(const ExactLine& line, bool of_any_leaf) const {
    Real128 nearest = std::numeric_limits<double>::infinity();
    const auto take = [&](const ExactCrossings& crossings) {
        for (const Real128 t : crossings.t) {
            const Real128 distance = t < 0 ? -t : t;
            if (distance < nearest) nearest = distance;
        }
    };
    if (csg == nullptr || !of_any_leaf) {
        // Includes slivers of any thickness.
        take(crossings(line, 0));
        return nearest;
    }
    for (const PrimitiveId leaf : csg->expression().leaves) {
        take(exact_crossings(csg->table(), leaf, line));
    }
    return nearest;
}

std::vector<ExactSolid> exact_solids(const std::shared_ptr<const Aggregate>& aggregate) {
    Collector collector;
    collector.add(aggregate);
    return std::move(collector.solids);
}

std::vector<UncheckedSolid> unchecked_solids(const std::vector<ExactSolid>& all,
                                             const SceneDescription& description,
                                             const Scene& scene) {
    std::map<std::pair<const Aggregate*, PrimitiveId>, std::size_t> wanted;
    std::vector<UncheckedSolid> named;
    for (const ExactSolid& solid : all) {
        if (solid.reason.empty() || named.size() == kMostNamedSolids) continue;
        wanted.emplace(std::pair{solid.stored_in, solid.shape}, named.size());
        named.push_back({"a solid", solid.reason});
    }
    if (named.empty()) return named;
    const SolidScene solids(description, scene);
    const std::uint64_t count = std::min(solids.solids().count(), kMostLookedThrough);
    for (std::uint64_t i = 0; i < count && !wanted.empty(); ++i) {
        const SolidPlace place = solids.solids().place(SolidId{i});
        const auto found = wanted.find({place.aggregate.get(), place.shape});
        if (found == wanted.end() || place.kind == SolidPlace::Kind::Mesh) continue;
        named[found->second].name = fmt::format("{} {}", i, solids.name(SolidId{i}));
        wanted.erase(found);
    }
    return named;
}

}  // namespace alhazen

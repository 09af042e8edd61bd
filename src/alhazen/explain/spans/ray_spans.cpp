#include "alhazen/explain/spans/ray_spans.h"

#include <algorithm>
#include <map>

#include "alhazen/csg/csg_aggregate.h"
#include "alhazen/explain/spans/part_of_primitive.h"
#include "alhazen/session/aov_pictures.h"
#include "alhazen/solids/solid_scene.h"

namespace alhazen {

namespace {

std::optional<CsgSpanNode> combination_of(const LoadedScene& loaded, const SolidPlace& place,
                                          const Ray& ray) {
    const auto* aggregate = dynamic_cast<const CsgAggregate*>(place.aggregate.get());
    if (place.kind != SolidPlace::Kind::Csg || aggregate == nullptr) return std::nullopt;
    const CsgSolid& solid = aggregate->solid();
    return csg_spans(solid, transformed(place.world.inner_from_outer, ray), [&](PrimitiveId id) {
        return part_name(loaded.description, part_of_primitive(solid.table(), id));
    });
}

}  // namespace

std::vector<SolidSpans> solid_spans(const LoadedScene& loaded, const Ray& ray) {
    const SolidScene scene(loaded.description, loaded.scene);
    SpanList list;
    scene.queries().spans(ray, list);
    std::map<SolidId, std::size_t> place_in_result;
    std::vector<SolidSpans> result;
    for (const SolidSpan& span : list.spans) {
        const auto [found, is_new] = place_in_result.emplace(span.solid, result.size());
        if (is_new) {
            SolidSpans& solid = result.emplace_back();
            solid.name = scene.name(span.solid);
            solid.combination = combination_of(loaded, scene.solids().place(span.solid), ray);
        }
        result[found->second].spans.push_back({span.entry.t, span.exit.t});
    }
    return result;
}

}  // namespace alhazen

#include "alhazen/explain/page/method_json.h"

namespace alhazen {

namespace {

using json = nlohmann::ordered_json;

json cone_json(const ConeNode& node, const std::vector<std::string>& lights);

json cone_part_json(const ConePart& part, const std::vector<std::string>& lights) {
    json cones = json::array();
    for (const ConeNode& cone : part.cones) cones.push_back(cone_json(cone, lights));
    return {{"object", part.object},
            {"t", part.t},
            {"point", vector_json(part.point)},
            {"at", {rounded(part.at.x), rounded(part.at.y)}},
            {"share", part.share},
            {"weight", part.weight},
            {"radius", part.radius},
            {"color", color_json(part.color)},
            {"cones", std::move(cones)}};
}

json cone_json(const ConeNode& node, const std::vector<std::string>& lights) {
    json out{{"kind", kRayKindNames[static_cast<std::size_t>(node.kind)]},
             {"depth", node.depth},
             {"origin", vector_json(node.cone.origin)},
             {"axis", vector_json(node.cone.axis)},
             {"radius", node.cone.radius},
             {"spread", node.cone.spread},
             {"narrowed", node.narrowed},
             {"length", node.length}};
    if (node.kind == RayKind::Shadow) {
        out["through"] = color_json(node.radiance);
        out["light"] = node.to.light < lights.size() ? lights[node.to.light] : std::string();
        out["part"] = node.to.part + 1;
        out["part_count"] = node.to.parts;
        out["weight"] = node.to.weight;
        return out;
    }
    out["radiance"] = color_json(node.radiance);
    out["left"] = node.left;
    out["parts"] = json::array();
    for (const ConePart& part : node.parts) {
        out["parts"].push_back(cone_part_json(part, lights));
    }
    return out;
}

json outline_json(const PixelOutline& outline) {
    json loops = json::array();
    for (const std::vector<Vec2>& loop : outline) {
        json points = json::array();
        for (const Vec2& p : loop) points.push_back({rounded(p.x), rounded(p.y)});
        loops.push_back(std::move(points));
    }
    return loops;
}

json beam_part_json(const BeamPart& part, const std::vector<std::string>& lights) {
    json lit = json::array();
    for (const BeamLitPart& l : part.lit) {
        json out{{"light", l.light < lights.size() ? lights[l.light] : std::string()},
                 {"through", l.through},
                 {"here", l.holds_sample}};
        if (l.holds_sample) out["color"] = color_json(l.color);
        if (part.share > 0.0) out["outline"] = outline_json(l.outline);
        lit.push_back(std::move(out));
    }
    json out{{"id", part.id},
             {"from", part.from},
             {"kind", kRayKindNames[static_cast<std::size_t>(part.kind)]},
             {"depth", part.depth},
             {"object", part.object},
             {"background", part.background},
             {"share", part.share},
             {"here", part.holds_sample}};
    if (part.holds_sample) out["own"] = color_json(part.own);
    out["outline"] = outline_json(part.outline);
    out["lights"] = std::move(lit);
    return out;
}

}  // namespace

json cones_json(const ConeExplanation& cones, const std::vector<std::string>& lights) {
    if (!cones.unavailable.empty()) return {{"unavailable", cones.unavailable}};
    return {{"cut", cones.cut}, {"tree", cone_json(cones.tree, lights)}};
}

json patches_json(const std::vector<PatchSubdivision>& patches) {
    json list = json::array();
    for (const PatchSubdivision& p : patches) {
        json parts = json::array(), crossings = json::array();
        for (const PatchPart& part : p.parts) {
            parts.push_back(
                {{"level", part.level}, {"u", part.u}, {"v", part.v}, {"met", part.met}});
        }
        for (const auto& c : p.crossings) {
            crossings.push_back({{"t", c.t}, {"u", c.u}, {"v", c.v}});
        }
        list.push_back({{"shape", p.shape},
                        {"object", p.part},
                        {"piece", p.piece},
                        {"degree", {p.degree_u, p.degree_v}},
                        {"cut", p.cut},
                        {"parts", std::move(parts)},
                        {"crossings", std::move(crossings)}});
    }
    return list;
}

json beams_json(const BeamExplanation& beams, const std::vector<std::string>& lights) {
    if (!beams.unavailable.empty()) return {{"unavailable", beams.unavailable}};
    json parts = json::array();
    for (const BeamPart& part : beams.parts) parts.push_back(beam_part_json(part, lights));
    return {{"polygons", beams.polygons},
            {"beams", beams.beams},
            {"from", {beams.from.x, beams.from.y}},
            {"to", {beams.to.x, beams.to.y}},
            {"color", color_json(beams.color)},
            {"left_out", beams.left_out},
            {"pieces", std::move(parts)}};
}

json path_json(const PathRecord& path, const std::vector<std::string>& part_names,
               const std::vector<std::string>& material_names) {
    json vertices = json::array();
    for (const RecordedVertex& v : path.vertices) {
        json out{{"kind", kRayKindNames[static_cast<std::size_t>(v.kind)]},
                 {"origin", vector_json(v.ray.origin)},
                 {"direction", vector_json(v.ray.direction)},
                 {"t", v.t},
                 {"throughput", color_json(v.throughput)},
                 {"found", color_json(v.found)},
                 {"step", kPathStepNames[static_cast<std::size_t>(v.step)]}};
        if (std::isfinite(v.t)) out["in_volume"] = v.in_volume;
        if (v.has_surface) {
            out["object"] = part_names[v.part];
            out["material"] = material_names[v.material];
            out["normal"] = vector_json(v.normal);
        }
        if (v.asked_light) {
            out["light"] = {{"origin", vector_json(v.shadow.origin)},
                            {"direction", vector_json(v.shadow.direction)},
                            {"t", v.shadow.t_max},
                            {"offered", color_json(v.offered)},
                            {"arrived", color_json(v.arrived)}};
        }
        vertices.push_back(std::move(out));
    }
    return {{"radiance", color_json(path.radiance)}, {"vertices", std::move(vertices)}};
}

}  // namespace alhazen

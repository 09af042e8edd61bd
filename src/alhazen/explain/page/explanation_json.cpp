#include "alhazen/explain/page/explanation_json.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "alhazen/explain/page/method_json.h"

namespace alhazen {

namespace {

using json = nlohmann::ordered_json;

const std::string& name_in(const std::vector<std::string>& names, std::size_t i) {
    static const std::string kNone;
    return i < names.size() ? names[i] : kNone;
}

/// Writes the tree and numbers its rays.
class TreeWriter {
  public:
    explicit TreeWriter(const Explanation& e) : e_(e) {}

    json ray(const RayNode& ray, const Rgb& weight) {
        json out{{"id", ++count_},
                 {"kind", kRayKindNames[static_cast<std::size_t>(ray.kind)]},
                 {"depth", ray.depth},
                 {"origin", vector_json(ray.ray.origin)},
                 {"direction", vector_json(ray.ray.direction)},
                 {"inside", ray.inside},
                 {"radiance", color_json(ray.radiance)},
                 {"weight", color_json(weight)},
                 {"in_pixel", color_json(weight * ray.radiance)},
                 {"escaped", ray.escaped}};
        if (ray.given_up) out["given_up"] = true;
        if (ray.escaped || ray.given_up) out["left"] = color_json(ray.left);
        out["surfaces"] = json::array();
        for (const SurfaceNode& s : ray.surfaces) out["surfaces"].push_back(surface(s, weight));
        return out;
    }

  private:
    json surface(const SurfaceNode& s, const Rgb& weight) {
        json out{{"t", s.t},
                 {"point", vector_json(s.point)},
                 {"normal", vector_json(s.normal)},
                 {"object", name_in(e_.part_names, s.part)},
                 {"material", name_in(e_.material_names, s.material)},
                 {"entering", s.entering},
                 {"unlit", !s.lit},
                 {"share", color_json(s.share)},
                 {"kd", color_json(s.kd)},
                 {"ks", color_json(s.ks)},
                 {"kr", color_json(s.kr)},
                 {"kt", color_json(s.kt)},
                 {"shininess", s.shininess},
                 {"index", s.index},
                 {"emission", color_json(s.emission)}};
        if (s.lit) add_terms(s, weight, out);
        out["color"] = color_json(color_of(s));
        return out;
    }

    void add_terms(const SurfaceNode& s, const Rgb& weight, json& out) {
        out["ambient_factor"] = color_json(s.ambient_factor);
        out["ambient"] = json::array();
        for (std::size_t i = 0; i < s.ambient.size(); ++i) {
            if (s.ambient[i].is_black()) continue;
            out["ambient"].push_back({{"light", name_in(e_.light_names, i)},
                                      {"intensity", color_json(s.ambient[i])},
                                      {"value", color_json(s.ambient_factor * s.ambient[i])}});
        }
        out["lights"] = json::array();
        for (const LightTerm& term : s.lights) out["lights"].push_back(light(term));
        out["direct"] = color_json(s.direct);
        const Rgb onward = weight * s.share * s.filter;
        add_ray("reflected", s.reflected, s.reflected_factor, s.no_reflected, onward, out);
        add_ray("refracted", s.refracted, s.refracted_factor, s.no_refracted, onward, out);
        if (s.filtered) out["filter"] = color_json(s.filter);
    }

    void add_ray(const char* key, const std::vector<RayNode>& child, const Rgb& factor,
                 NotSent reason, const Rgb& onward, json& out) {
        json term{{"reason", kNotSentNames[static_cast<std::size_t>(reason)]}};
        if (!child.empty()) {
            term["factor"] = color_json(factor);
            term["value"] = color_json(factor * child.front().radiance);
            term["ray"] = ray(child.front(), onward * factor);
        }
        out[key] = std::move(term);
    }

    json light(const LightTerm& term) const {
        json crossings = json::array();
        for (const LightTerm::Crossing& c : term.crossings) {
            crossings.push_back({{"t", c.t}, {"object", name_in(e_.part_names, c.part)}});
        }
        return {
            {"light", name_in(e_.light_names, term.light)},
            {"cosine", term.cosine},
            {"intensity", color_json(term.intensity)},
            {"diffuse", color_json(term.diffuse)},
            {"highlight", color_json(term.highlight)},
            {"through", color_json(term.through)},
            {"value", color_json(term.through * term.intensity * (term.diffuse + term.highlight))},
            {"cast", term.cast},
            {"origin", vector_json(term.shadow.origin)},
            {"direction", vector_json(term.shadow.direction)},
            {"t", term.shadow.t_max},
            {"crossings", std::move(crossings)}};
    }

    const Explanation& e_;
    int count_ = 0;
};

json spans_json(const std::vector<TSpan>& spans) {
    json list = json::array();
    for (const TSpan& s : spans) list.push_back({s.from, s.to});
    return list;
}

json combination_json(const CsgSpanNode& node) {
    constexpr const char* kNames[] = {"union", "union", "intersection", "difference"};
    if (node.is_leaf) return {{"name", node.name}, {"spans", spans_json(node.spans)}};
    json operands = json::array();
    for (const CsgSpanNode& o : node.operands) operands.push_back(combination_json(o));
    return {{"operator", kNames[static_cast<std::size_t>(node.combine)]},
            {"spans", spans_json(node.spans)},
            {"operands", std::move(operands)}};
}

json solids_json(const std::vector<SolidSpans>& solids) {
    json list = json::array();
    for (const SolidSpans& solid : solids) {
        json out{{"name", solid.name}, {"spans", spans_json(solid.spans)}};
        if (solid.combination) out["combination"] = combination_json(*solid.combination);
        list.push_back(std::move(out));
    }
    return list;
}

json polynomials_json(const std::vector<PolynomialOnRay>& polynomials) {
    json list = json::array();
    for (const PolynomialOnRay& p : polynomials) {
        list.push_back({{"shape", p.shape},
                        {"object", p.part},
                        {"expression", p.expression},
                        {"degree", p.degree},
                        {"from", p.from},
                        {"to", p.to},
                        {"bernstein", p.bernstein},
                        {"roots", p.roots}});
    }
    return list;
}

json traversal_json(const Explanation& e) {
    constexpr const char* kKinds[] = {"cell", "bound", "beam", "primitive"};
    json steps = json::array();
    for (std::size_t i = 0; i < e.traversal.steps.size(); ++i) {
        const TraversalStep& step = e.traversal.steps[i];
        json corners = json::array();
        for (const Vec3& c : step.corners) {
            corners.push_back({rounded(c.x), rounded(c.y), rounded(c.z)});
        }
        steps.push_back({{"kind", kKinds[static_cast<std::size_t>(step.kind)]},
                         {"number", step.number},
                         {"met", step.met},
                         {"object", e.candidates[i]},
                         {"corners", std::move(corners)}});
    }
    json work = json::array();
    for (const AcceleratorWork& w : e.work) {
        json line{{"accelerator", w.accelerator}};
        if (!w.unavailable.empty()) {
            line["unavailable"] = w.unavailable;
        } else {
            line["node_visits"] = w.stats.node_visits;
            line["empty_cells"] = w.stats.empty_cells;
            line["box_tests"] = w.stats.box_tests;
            line["primitive_tests"] = w.stats.primitive_tests;
            line["mailbox_saved"] = w.stats.mailbox_saved;
            line["t"] = w.t;
        }
        work.push_back(std::move(line));
    }
    return {{"accelerator", e.traversal.accelerator},
            {"steps", std::move(steps)},
            {"left_out", e.steps_left_out},
            {"work", std::move(work)}};
}

json points_json(const std::vector<ScenePoint>& points) {
    json list = json::array();
    for (const ScenePoint& p : points) {
        const auto code = [](double c) { return encode_channel(c, Encoding::Srgb, 8); };
        list.push_back({rounded(p.point.x), rounded(p.point.y), rounded(p.point.z), code(p.color.r),
                        code(p.color.g), code(p.color.b)});
    }
    return list;
}

}  // namespace

std::string explanation_json(const Explanation& e, int indent) {
    const RayCensus census = census_of(e.tree);
    json out{{"format", "alhazen explanation 1"},
             {"scene", e.scene},
             {"camera", e.camera},
             {"renderer", e.renderer},
             {"draws_at_random", e.draws_at_random},
             {"width", e.width},
             {"height", e.height},
             {"x", e.x},
             {"y", e.y},
             {"sample", e.sample},
             {"max_depth", e.max_depth},
             {"cut", e.max_depth < e.wished_depth ? json(e.max_depth) : json(false)},
             {"min_contribution", e.min_contribution},
             {"background", color_json(e.background)},
             {"pixel", color_json(e.pixel)},
             {"rays",
              {{"eye", census.eye},
               {"shadow", census.shadow},
               {"reflection", census.reflection},
               {"refraction", census.refraction}}}};
    out["samples"] = json::array();
    for (const PixelSample& s : e.samples) {
        out["samples"].push_back(
            {{"place", {s.place.x, s.place.y}}, {"radiance", color_json(s.radiance)}});
    }
    out["picture"] = json::array();
    for (const Vec3& corner : e.picture) out["picture"].push_back(vector_json(corner));
    out["parallel"] = e.parallel;
    out["tree"] = TreeWriter(e).ray(e.tree, {1, 1, 1});
    out["solids"] = solids_json(e.spans);
    out["polynomials"] = polynomials_json(e.polynomials);
    out["patches"] = patches_json(e.patches);
    if (e.cones) out["cones"] = cones_json(*e.cones, e.light_names);
    if (e.beams) out["beams"] = beams_json(*e.beams, e.light_names);
    if (e.path) out["path"] = path_json(*e.path, e.part_names, e.material_names);
    if (!e.traversal.accelerator.empty()) out["traversal"] = traversal_json(e);
    out["points"] = points_json(e.points);
    return out.dump(indent, ' ', true, json::error_handler_t::replace);
}

}  // namespace alhazen

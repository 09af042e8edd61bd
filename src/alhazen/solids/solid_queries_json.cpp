#include "alhazen/solids/solid_queries_json.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "alhazen/base/error.h"
#include "alhazen/base/unicode_marks.h"
#include "alhazen/geometry/ray_scale.h"
#include "alhazen/solids/vector_json.h"

namespace alhazen {

namespace {

using json = nlohmann::ordered_json;

json ray_json(const Ray& ray) {
    json out{{"origin", vector_json(ray.origin)}, {"direction", vector_json(ray.direction)}};
    if (ray.t_min != 0.0 || std::isfinite(ray.t_max)) {
        out["t_min"] = number_json(ray.t_min);
        out["t_max"] = number_json(ray.t_max);
    }
    return out;
}

json end_json(const SolidScene& scene, const SpanEnd& end, const SpanSurface& surface) {
    json out{{"t", number_json(end.t)}};
    if (end.is_crossing || std::isfinite(end.t)) out["point"] = vector_json(surface.point);
    if (end.is_crossing) {
        out["normal"] = vector_json(surface.normal);
        out["material"] = scene.material_name(surface.material);
    } else {
        out["inside"] = true;
    }
    return out;
}

}  // namespace

json spans_json(const SolidScene& scene, const Ray& ray, std::span<const SolidSpan> spans) {
    json out = ray_json(ray);
    json list = json::array();
    const SolidQueries& queries = scene.queries();
    // Lengths are those of the rescaled ray, whose t do not leave the range of double.
    const int exponent = unusual_exponent(ray.direction);
    const Ray usual = rescaled(ray, exponent);
    SpanList rescaled_list;
    if (exponent != 0) queries.spans(usual, rescaled_list);
    const std::span<const SolidSpan> measured = exponent != 0 ? rescaled_list.spans : spans;
    const double scale = length(usual.direction);
    for (std::size_t i = 0; i < spans.size(); ++i) {
        const SolidSpan& span = spans[i];
        list.push_back({{"solid", static_cast<std::uint64_t>(span.solid)},
                        {"name", scene.name(span.solid)},
                        {"length", number_json(scale * (measured[i].exit.t - measured[i].entry.t))},
                        {"entry", end_json(scene, span.entry, queries.entry_surface(ray, span))},
                        {"exit", end_json(scene, span.exit, queries.exit_surface(ray, span))}});
    }
    out["spans"] = std::move(list);
    return out;
}

json thickness_json(const SolidScene& scene, const Ray& ray, const Thickness& thickness) {
    json out = ray_json(ray);
    out["thickness"] = number_json(thickness.inside_any);
    json list = json::array();
    for (const Thickness::OfSolid& one : thickness.of_solid) {
        list.push_back({{"solid", static_cast<std::uint64_t>(one.solid)},
                        {"name", scene.name(one.solid)},
                        {"thickness", number_json(one.length)}});
    }
    out["solids"] = std::move(list);
    return out;
}

json inside_json(const SolidScene& scene, const Vec3& point, std::span<const Containment> solids) {
    json list = json::array();
    for (const Containment& one : solids) {
        list.push_back({{"solid", static_cast<std::uint64_t>(one.solid)},
                        {"name", scene.name(one.solid)},
                        {"on_surface", one.on_surface}});
    }
    return {{"point", vector_json(point)}, {"inside", std::move(list)}};
}

std::vector<double> parse_numbers(const std::string& text,
                                  std::initializer_list<std::size_t> counts,
                                  const std::string& what, const FileLocation& where) {
    std::vector<double> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    const auto is_gap = [](char c) { return c == ',' || c == ' ' || c == '\t' || c == '\r'; };
    bool good = true;
    for (;;) {
        while (at != end && is_gap(*at)) ++at;
        if (at == end || !good) break;
        if (*at == '+') ++at;
        double x = 0;
        const auto [next, status] = std::from_chars(at, end, x);
        good = status == std::errc{} && (next == end || is_gap(*next));
        numbers.push_back(x);
        at = next;
    }
    if (good) {
        for (const std::size_t count : counts) {
            if (numbers.size() == count) return numbers;
        }
    }
    throw Error(ErrorKind::Usage, "'" + text.substr(0, 200) + "': expected " + what, where);
}

Ray parse_ray(const std::string& text, const FileLocation& where) {
    const std::vector<double> n =
        parse_numbers(text, {6, 8}, "a ray: ox,oy,oz,dx,dy,dz or with t_min,t_max behind", where);
    Ray ray{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
    if (n.size() == 8) {
        ray.t_min = n[6];
        ray.t_max = n[7];
    }
    if (!is_valid(ray)) {
        throw Error(ErrorKind::Usage,
                    "'" + text.substr(0, 200) +
                        "': expected a finite ray with a direction that is not zero and t_min <= "
                        "t_max",
                    where);
    }
    return ray;
}

Vec3 parse_point(const std::string& text, const FileLocation& where) {
    const std::vector<double> n = parse_numbers(text, {3}, "a point: x,y,z", where);
    const Vec3 point{n[0], n[1], n[2]};
    if (!is_finite(point)) {
        throw Error(ErrorKind::Usage, "'" + text + "': expected three finite numbers", where);
    }
    return point;
}

std::vector<LineReader::Line> LineReader::next(std::size_t count) {
    std::vector<Line> lines;
    std::string text;
    while (lines.size() < count && std::getline(in_, text)) {
        if (++line_ == 1) {
            refuse_wide_text(text, name_);
            text.erase(0, text.size() - without_byte_order_mark(text).size());
        }
        if (const std::size_t comment = text.find('#'); comment != std::string::npos) {
            text.resize(comment);
        }
        if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
        lines.push_back({text, {name_, line_, 0}});
    }
    if (in_.bad()) throw Error(ErrorKind::File, "could not be read", {name_, line_, 0});
    return lines;
}

}  // namespace alhazen

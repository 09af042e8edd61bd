// The text layout of `alhazen info`.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "alhazen/base/control_characters.h"
#include "alhazen/session/scene_info/info.h"

namespace alhazen {

namespace {

using json = nlohmann::ordered_json;

/// Largest number of list entries shown by default.
constexpr std::size_t kShown = 12;
constexpr std::uint64_t kManyTriangles = 100'000;

std::string bytes_text(double bytes) {
    static constexpr const char* kUnits[] = {"bytes", "kB", "MB", "GB", "TB"};
    std::size_t unit = 0;
    while (bytes >= 1000.0 && unit + 1 < std::size(kUnits)) {
        bytes /= 1000.0;
        ++unit;
    }
    return unit == 0 ? fmt::format("{:.0f} {}", bytes, kUnits[unit])
                     : fmt::format("{:.3g} {}", bytes, kUnits[unit]);
}

/// Digits in groups of three.
std::string count_text(const json& value) {
    std::string digits = fmt::format("{}", value.get<std::uint64_t>());
    for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, 1, ' ');
    return digits;
}

std::string of(std::uint64_t count, const char* one, const char* many) {
    return fmt::format("{} {}", count_text(count), count == 1 ? one : many);
}

std::string number(const json& value) {
    return value.is_null() ? "unknown" : fmt::format("{:.6g}", value.get<double>());
}

std::string point(const json& v) {
    return fmt::format("({}, {}, {})", number(v[0]), number(v[1]), number(v[2]));
}

std::string name_of(const json& entry) {
    const std::string name = entry["name"].get<std::string>();
    return name.empty() ? "(no name)" : escape_controls(name);
}

class Report {
  public:
    explicit Report(bool all) : all_(all) {}

    void line(const char* key, const std::string& value) {
        text_ += fmt::format("{:<14}{}\n", key, value);
    }
    /// One indented line per entry: the name, a colon and the result of `describe`.
    template <class F>
    void list(const char* key, const json& entries, F&& describe) {
        if (entries.empty()) return line(key, "none");
        line(key, count_text(entries.size()));
        const std::size_t shown = all_ ? entries.size() : std::min(entries.size(), kShown);
        for (std::size_t i = 0; i < shown; ++i) {
            text_ += fmt::format("  {}: {}\n", name_of(entries[i]), describe(entries[i]));
        }
        if (shown < entries.size()) {
            text_ += fmt::format("  ... and {} more (--all)\n", count_text(entries.size() - shown));
        }
    }
    [[nodiscard]] std::string take() { return std::move(text_); }

  private:
    bool all_;
    std::string text_;
};

std::string bounds_text(const json& box) {
    return fmt::format("{} to {}, size {} x {} x {}", point(box["min"]), point(box["max"]),
                       number(box["size"][0]), number(box["size"][1]), number(box["size"][2]));
}

std::string closed_text(const json& closed) {
    return closed.is_null()     ? "closed: not looked at (--all)"
           : closed.get<bool>() ? "closed"
                                : "open";
}

void add_geometry(Report& report, const json& info) {
    if (!info["bounds"].is_null()) {
        report.line("bounds", bounds_text(info["bounds"]));
    } else if (info.contains("bounded_part") && !info["bounded_part"].is_null()) {
        report.line("bounds",
                    "unbounded; all but its endless shapes: " + bounds_text(info["bounded_part"]));
    } else {
        report.line("bounds", info["bounded"].get<bool>() ? "empty" : "unbounded");
    }
    const std::uint64_t meshes = info["meshes"].size();
    if (meshes > 0) {
        const std::uint64_t unused = info["unused_vertices"].get<std::uint64_t>();
        report.line("triangles",
                    fmt::format("{} in {}, {}{}", count_text(info["triangles"]),
                                of(meshes, "mesh", "meshes"),
                                of(info["vertices"].get<std::uint64_t>(), "vertex", "vertices"),
                                unused > 0 ? fmt::format(", {} of them unused", count_text(unused))
                                           : std::string()));
        report.line("surface",
                    fmt::format("area {}, volume {}, {}", number(info["mesh_area"]),
                                number(info["mesh_volume"]), closed_text(info["meshes_closed"])));
    }
    std::string parts;
    for (const auto& [kind, count] : info["parts"].items()) {
        parts += fmt::format("{}{} x {}", parts.empty() ? "" : ", ", count_text(count), kind);
    }
    report.line("parts", parts.empty() ? "none" : parts);
    if (const auto masked = info["masked_parts"].get<std::uint64_t>(); masked > 0) {
        report.line("masks", fmt::format("{} not seen by all rays", of(masked, "part", "parts")));
    }
    if (info["solids"].get<std::uint64_t>() > 0) {
        report.line("solids",
                    fmt::format("{} made of {}", count_text(info["solids"]),
                                of(info["solid_leaves"].get<std::uint64_t>(), "other", "others")));
    }
    if (info["instances"].get<std::uint64_t>() > 0) {
        report.line("instances",
                    fmt::format("{}, nested {} deep; rays see {}", count_text(info["instances"]),
                                info["instance_depth"].get<int>(),
                                of(info["effective_primitives"].get<std::uint64_t>(), "primitive",
                                   "primitives")));
    }
    report.list("meshes", info["meshes"], [](const json& m) {
        return fmt::format(
            "{}, area {}, volume {}, {}",
            of(m["triangles"].get<std::uint64_t>(), "triangle", "triangles"), number(m["area"]),
            number(m["volume"]),
            m.contains("amiss") ? m["amiss"].get<std::string>() : closed_text(m["closed"]));
    });
    if (info["patches"].empty()) return;
    report.list("patches", info["patches"], [](const json& p) {
        const bool open = !p["closed"].is_null() && !p["closed"].get<bool>();
        std::string text = fmt::format(
            "{} with {}, area {}, volume {}, {}",
            of(p["patches"].get<std::uint64_t>(), "patch", "patches"),
            of(p["control_points"].get<std::uint64_t>(), "control point", "control points"),
            number(p["area"]), number(p["volume"]), closed_text(p["closed"]));
        if (!open) return text;
        text += fmt::format(": {} of one patch only", of(p["open_curves"].get<std::uint64_t>(),
                                                         "boundary curve", "boundary curves"));
        const json& first = p["first_open"];
        const std::size_t shown = std::min<std::size_t>(first.size(), 3);
        for (std::size_t k = 0; k < shown; ++k) {
            text += fmt::format("{} {} to {}", k == 0 ? "," : ";", point(first[k][0]),
                                point(first[k][1]));
        }
        return text + (shown < first.size() ? "; ..." : "");
    });
}

void add_looks(Report& report, const json& info) {
    report.list("materials", info["materials"], [](const json& m) {
        return m["kind"].get<std::string>() +
               (m["alpha"] == "opaque" ? "" : ", alpha " + m["alpha"].get<std::string>()) +
               (m["alpha"] == "opaque" && m["transparent"].get<bool>() ? ", transparent" : "") +
               (m["double_sided"].get<bool>() ? "" : ", single-sided");
    });
    report.list("textures", info["textures"], [](const json& t) {
        if (t.contains("solid")) return "solid, " + t["solid"].get<std::string>();
        return fmt::format("{} x {}, {} x {} bit, {}, {}", t["width"].get<int>(),
                           t["height"].get<int>(), t["channels"].get<int>(), t["bits"].get<int>(),
                           t["filter"].get<std::string>(), bytes_text(t["bytes"].get<double>()));
    });
    report.list("cameras", info["cameras"], [](const json& c) {
        const std::string extent =
            c.contains("fov_x_deg")
                ? fmt::format("{:.4g} x {:.4g} degrees", c["fov_x_deg"].get<double>(),
                              c["fov_y_deg"].get<double>())
                : fmt::format("{} x {}", number(c["width"]), number(c["height"]));
        return fmt::format("{}, {}, from {}", c["kind"].get<std::string>(), extent,
                           point(c["eye"]));
    });
    report.list("lights", info["lights"],
                [](const json& l) { return l["kind"].get<std::string>(); });
    if (info.contains("environment")) {
        report.line("environment", info["environment"]["kind"].get<std::string>());
    }
    report.list("animations", info["animations"], [](const json& a) {
        return fmt::format("{:.4g} s to {:.4g} s", a["begin"].get<double>(),
                           a["end"].get<double>());
    });
}

void add_memory(Report& report, const json& info) {
    const json& memory = info["memory"];
    const auto bytes = [&](const char* key) { return bytes_text(memory[key].get<double>()); };
    report.line("memory",
                fmt::format("geometry {}, textures {}, {} {}", bytes("geometry_bytes"),
                            bytes("texture_bytes"), info["accelerator"].get<std::string>(),
                            bytes("accelerator_bytes")));
    report.line("", fmt::format("peak {} after reading, {} after building",
                                bytes("peak_after_load_bytes"), bytes("peak_after_build_bytes")));
    if (info["instances"].get<std::uint64_t>() > 0) {
        report.line(
            "", fmt::format("{} for {} as rays see them: {:.3g} bytes each", bytes("unique_bytes"),
                            of(info["effective_primitives"].get<std::uint64_t>(), "primitive",
                               "primitives"),
                            memory["bytes_per_effective_primitive"].get<double>()));
    }
    if (!memory.contains("per_triangle")) return;
    const json& each = memory["per_triangle"];
    std::string peaks;
    // For small meshes the memory of the process itself would dominate.
    if (info["triangles"].get<std::uint64_t>() >= kManyTriangles) {
        peaks = fmt::format(", peak {:.0f} after reading, {:.0f} after building",
                            each["peak_after_load"].get<double>(),
                            each["peak_after_build"].get<double>());
    }
    report.line(
        "", fmt::format("bytes per triangle: geometry {:.0f}, accelerator {:.0f}{}",
                        each["geometry"].get<double>(), each["accelerator"].get<double>(), peaks));
}

void add_time(Report& report, const json& info) {
    report.line("time",
                fmt::format("read {:.3f} s, built {:.3f} s", info["seconds"]["load"].get<double>(),
                            info["seconds"]["build"].get<double>()));
}

}  // namespace

std::string info_text(const json& info, bool all) {
    Report report(all);
    report.line("scene", escape_controls(info["scene"].get<std::string>()));
    report.line("format", info["format"].get<std::string>() +
                              (info["file_bytes"].is_null()
                                   ? std::string()
                                   : ", " + bytes_text(info["file_bytes"].get<double>())));
    add_geometry(report, info);
    add_looks(report, info);
    if (info.contains("picture")) {
        const json& picture = info["picture"];
        const auto side = [&](const char* key) {
            return picture.contains(key) ? fmt::format("{}", picture[key].get<int>()) : "?";
        };
        report.line("picture", side("width") + " x " + side("height"));
    }
    add_memory(report, info);
    add_time(report, info);
    std::string text = report.take();
    if (info["warnings"].empty()) return text + fmt::format("{:<14}none\n", "warnings");
    text += fmt::format("{:<14}{}\n", "warnings", info["warnings"].size());
    for (const json& warning : info["warnings"]) text += "  " + warning.get<std::string>() + "\n";
    return text;
}

}  // namespace alhazen

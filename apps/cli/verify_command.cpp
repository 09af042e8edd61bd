#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/control_characters.h"
#include "alhazen/base/file.h"
#include "alhazen/formats/importer_list.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/session/scene_files.h"
#include "alhazen/verification/verify.h"
#include "alhazen/verification/verify_exact.h"
#include "commands.h"
#include "messages.h"
#include "options.h"
#include "progress_display.h"

namespace alhazen::cli {

namespace {

using json = nlohmann::ordered_json;

json to_json(const std::vector<Disagreement>& reported) {
    json disagreements = json::array();
    for (const Disagreement& d : reported) {
        const Ray& r = d.ray;
        json& one = disagreements.emplace_back();
        one = {{"kind", d.kind},
               {"query", d.query},
               {"origin", {r.origin.x, r.origin.y, r.origin.z}},
               {"direction", {r.direction.x, r.direction.y, r.direction.z}},
               {"found", d.found},
               {"expected", d.expected}};
        if (std::isfinite(r.t_max)) one["t_max"] = r.t_max;
        if (!d.query_path.empty()) one["query_path"] = d.query_path;
    }
    return disagreements;
}

json to_json(const std::array<QueryPathCounts, kQueryPathCount>& query_paths) {
    json by_name;
    for (std::size_t i = 0; i < kQueryPathCount; ++i) {
        by_name[kQueryPathNames[i]] = {{"rays", query_paths[i].rays},
                                       {"disagreements", query_paths[i].disagreements}};
    }
    return by_name;
}

json to_json(const VerifyReport& report) {
    return {{"accelerator", report.accelerator},
            {"rays", report.rays},
            {"rays_left_out", report.rays_left_out},
            {"believed_boxes", report.believed_boxes},
            {"hits", report.hits},
            {"disagreements", report.disagreements},
            {"query_paths", to_json(report.query_paths)},
            {"closed_surfaces", report.closed_surfaces},
            {"open_meshes", report.open_meshes},
            {"shapes_left_out", report.shapes_left_out},
            {"parity_lines", report.parity_lines},
            {"odd_crossings", report.odd_crossings},
            {"holds", report.holds()},
            {"reported", to_json(report.reported)}};
}

json to_json(const ExactReport& report) {
    json unchecked = json::array();
    for (const UncheckedSolid& one : report.unchecked_solids) {
        unchecked.push_back({{"solid", one.name}, {"reason", one.reason}});
    }
    return {{"exact", true},
            {"solids", report.solids},
            {"unchecked", report.unchecked},
            {"left_out", report.left_out},
            {"triangles_without_formula", report.triangles},
            {"unchecked_solids", std::move(unchecked)},
            {"rays", report.rays},
            {"crossings", report.crossings},
            {"grazing", report.grazing},
            {"disagreements", report.disagreements},
            {"worst_crossing", report.worst_crossing},
            {"worst_point", report.worst_point},
            {"holds", report.holds()},
            {"reported", to_json(report.reported)}};
}

void print_disagreements(const std::vector<Disagreement>& reported) {
    for (const Disagreement& d : reported) {
        const Vec3& o = d.ray.origin;
        const Vec3& v = d.ray.direction;
        const std::string path = d.query_path.empty() ? "" : fmt::format(" ({})", d.query_path);
        const std::string end =
            std::isfinite(d.ray.t_max) ? fmt::format(" t_max {:.17g}", d.ray.t_max) : "";
        print("  {} {}{}: origin {:.17g} {:.17g} {:.17g} direction {:.17g} {:.17g} {:.17g}{}\n",
              d.kind, d.query, path, o.x, o.y, o.z, v.x, v.y, v.z, end);
        print("    found {}\n    expected {}\n", d.found, d.expected);
    }
}

/// "single 20000, stream 20000, coherent 4992", with the number of disagreements if not 0.
std::string text_of(const std::array<QueryPathCounts, kQueryPathCount>& query_paths) {
    std::string text;
    for (std::size_t i = 0; i < kQueryPathCount; ++i) {
        text += fmt::format("{}{} {}", i == 0 ? "" : ", ", kQueryPathNames[i], query_paths[i].rays);
        if (query_paths[i].disagreements > 0)
            text += fmt::format(" ({} differ)", query_paths[i].disagreements);
    }
    return text;
}

/// Prints what was not checked, one line each.
void print_left_out(const VerifyReport& report) {
    if (report.rays_left_out > 0) {
        print("  not checked: {} of {} rays: the list tests every primitive\n",
              report.rays_left_out, report.rays + report.rays_left_out);
    }
    if (report.believed_boxes > 0) {
        print("  not checked: the boxes of {} shapes and solids: too many to test without\n",
              report.believed_boxes);
    }
    if (report.open_meshes > 0) {
        print("  not checked: crossings of {} {}: nothing to count\n", report.open_meshes,
              report.open_meshes == 1 ? "open mesh" : "open meshes");
    }
    if (report.shapes_left_out > 0) {
        print("  not checked: crossings of {} {}: not closed, endless, or beyond the first 64\n",
              report.shapes_left_out, report.shapes_left_out == 1 ? "shape" : "shapes");
    }
}

void print_report(const VerifyReport& report) {
    print(
        "{}: {} rays ({}), {} hits, {} disagreements with brute force; {} closed surfaces, {} "
        "lines, {} "
        "with an odd number of crossings\n",
        report.accelerator, report.rays, text_of(report.query_paths), report.hits,
        report.disagreements, report.closed_surfaces, report.parity_lines, report.odd_crossings);
    print_left_out(report);
    print_disagreements(report.reported);
}

void print_report(const ExactReport& report) {
    print(
        "exact: {} solids, {} rays, {} crossings in 113 bits: {} disagreements, {} rays graze; "
        "crossings and points within {:.3g} and {:.3g} of their bounds{}\n",
        report.solids, report.rays, report.crossings, report.disagreements, report.grazing,
        report.worst_crossing, report.worst_point,
        report.unchecked > 0 ? fmt::format("; {} {} not checked", report.unchecked,
                                           report.unchecked == 1 ? "solid" : "solids")
                             : "");
    for (const UncheckedSolid& one : report.unchecked_solids) {
        print("  not checked: {}: {}\n", escape_controls(one.name), one.reason);
    }
    const std::size_t without = report.unchecked - report.left_out;
    if (without > report.unchecked_solids.size()) {
        print("  not checked: {} more without a formula\n",
              without - report.unchecked_solids.size());
    }
    if (report.left_out > 0) {
        print("  not checked: {} more, beyond the {} that share the rays\n", report.left_out,
              report.solids);
    }
    if (report.triangles > 0) {
        print("  not checked: {} triangles: exact in the comparison above\n", report.triangles);
    }
    print_disagreements(report.reported);
}

}  // namespace

void add_verify(CLI::App& app, int& exit_status) {
    struct Arguments {
        SceneArguments scene;
        VerifyOptions verify;
        std::string json;
        bool exact = true, quiet = false;
    };
    CLI::App* command = app.add_subcommand(
        "verify",
        "Compare an accelerator with brute force, ray by ray; exit 0 only when they agree");
    const auto args = std::make_shared<Arguments>();
    args->scene.add_to(*command, "all");
    command->add_option("--rays", args->verify.rays, "Rays to trace")
        ->type_name("N")
        ->capture_default_str()
        ->check(number_in(1.0, 1e15));
    command->add_option("--seed", args->verify.seed, "Seed of the rays")
        ->type_name("N")
        ->capture_default_str()
        ->check(unsigned_number());
    command->add_option("--camera", args->verify.camera, "Camera of the eye rays")
        ->type_name("NAME|INDEX");
    command->add_flag("--exact,!--no-exact", args->exact,
                      "Trace the exact solids again in numbers of 113 bits (the default)");
    command->add_option("--json", args->json, "Write the report as JSON; - for stdout")
        ->type_name("FILE");
    add_quiet(*command, args->quiet);
    command->callback([args, &exit_status] {
        Diagnostics diagnostics;
        if (!args->json.empty() && args->json != "-") check_writable(args->json);
        const SceneDescription description =
            load_description(args->scene.scene, args->scene.load_options(), diagnostics);
        if (!args->json.empty() && args->json != "-") {
            const std::filesystem::path output = args->json;
            check_spares_scene(description, std::span(&output, 1));
        }
        if (!args->quiet) print_warnings(diagnostics);
        if (args->scene.accelerator != "all") {
            const std::string idle = idle_build_options(description, args->scene.compile_options());
            if (!idle.empty()) tell_idle_options(idle, args->scene.strict, args->quiet);
        }
        ProgressDisplay progress(args->quiet);
        json reports = json::array();
        bool holds = true;
        const auto check = [&](const std::string& accelerator) {
            VerifyOptions options = args->verify;
            options.accelerator = accelerator;
            options.build = args->scene.build_options();
            options.csg = args->scene.csg;
            options.progress = &progress;
            VerifyReport report;
            ThreadLimit(args->scene.threads).run([&] { report = verify(description, options); });
            progress.finish();
            holds = holds && report.holds();
            reports.push_back(to_json(report));
            if (args->json != "-") print_report(report);
        };
        if (args->scene.accelerator == "all") {
            for (const AcceleratorEntry& entry : accelerator_table()) check(entry.name);
        } else {
            check(args->scene.accelerator);
        }
        if (args->exact) {
            VerifyOptions options = args->verify;
            options.accelerator = "list";
            options.progress = &progress;
            ExactReport report;
            ThreadLimit(args->scene.threads).run([&] {
                report = verify_exact(description, options);
            });
            progress.finish();
            holds = holds && report.holds();
            reports.push_back(to_json(report));
            const bool any = report.solids + report.unchecked > 0;
            if (any && args->json != "-") print_report(report);
        }
        if (!args->json.empty())
            write_report(args->json,
                         reports.dump(2, ' ', true, json::error_handler_t::replace) + "\n");
        exit_status = holds ? kDone : kCheckFailed;
    });
}

}  // namespace alhazen::cli

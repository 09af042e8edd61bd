/// Experiments E3 and E4 of claims.h: beams.

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "alhazen/laboratory/claims/claim_run.h"
#include "alhazen/laboratory/cpu_clock.h"
#include "alhazen/math/constants.h"
#include "alhazen/renderers/beam_tracing/beam_tracing.h"
#include "alhazen/renderers/core/reports/beam_report.h"
#include "alhazen/renderers/whitted/whitted.h"

namespace alhazen {
namespace {

void add_beam_shape(SceneDescription& d, AnyShape shape, std::uint32_t material,
                    const Affine& placed = {}) {
    Part part;
    part.what = std::move(shape);
    part.material = MaterialId{material};
    part.object_from_part = placed;
    d.objects[0].parts.push_back(std::move(part));
}

/// Two mirrors that face each other in a room with a table, lit by the sun through a barred window.
SceneDescription mirror_hall() {
    SceneDescription d;
    d.objects.push_back({"root", {}, {}});
    const std::array<Rgb, 6> colors{{{0.75, 0.72, 0.65},
                                     {0.5, 0.35, 0.22},
                                     {0.45, 0.25, 0.12},
                                     {0.7, 0.12, 0.1},
                                     {0.1, 0.2, 0.65},
                                     {0.02, 0.02, 0.02}}};
    constexpr std::uint32_t kPlaster = 0, kFloor = 1, kWood = 2, kRed = 3, kBlue = 4, kMirror = 5;
    for (const Rgb& color : colors) {
        Material m;
        m.diffuse.color = m.ambient.color = color;
        if (d.materials.size() == kFloor) m.reflective.color = {0.08, 0.08, 0.08};
        if (d.materials.size() == kMirror) m.reflective.color = {0.9, 0.9, 0.9};
        d.materials.push_back({m, {}});
    }
    const auto wall = [&](const Vec3& corner, const Vec3& u, const Vec3& v, std::uint32_t m) {
        add_beam_shape(d, Rectangle{.corner = corner, .edge_u = u, .edge_v = v}, m);
    };
    wall({-2, -2.5, 0}, {4, 0, 0}, {0, 5, 0}, kFloor);
    wall({-2, -2.5, 3}, {0, 5, 0}, {4, 0, 0}, kPlaster);
    wall({-2, -2.5, 0}, {0, 5, 0}, {0, 0, 3}, kPlaster);
    wall({2, 2.5, 0}, {0, -5, 0}, {0, 0, 3}, kPlaster);
    wall({2, -2.5, 0}, {-4, 0, 0}, {0, 0, 3}, kPlaster);
    Polygon back;
    back.vertices = {{-2, 2.5, 0},   {2, 2.5, 0},      {2, 2.5, 3},      {-2, 2.5, 3},
                     {-1.4, 2.5, 1}, {-1.4, 2.5, 2.4}, {-0.3, 2.5, 2.4}, {-0.3, 2.5, 1}};
    back.loop_ends = {4, 8};
    add_beam_shape(d, back, kPlaster);
    add_beam_shape(d, BoxShape{{-0.9, 2.45, 1}, {-0.8, 2.55, 2.4}}, kWood);
    add_beam_shape(d, BoxShape{{-1.4, 2.46, 1.65}, {-0.3, 2.54, 1.75}}, kWood);
    wall({-1.98, -1.6, 0.4}, {0, 3.4, 0}, {0, 0, 2.2}, kMirror);
    wall({1.98, 1.8, 0.4}, {0, -3.4, 0}, {0, 0, 2.2}, kMirror);
    add_beam_shape(d, BoxShape{{-0.5, 0.2, 0.7}, {0.9, 1.1, 0.76}}, kWood);
    for (const double x : {-0.45, 0.77}) {
        for (const double y : {0.25, 0.97}) {
            add_beam_shape(d, BoxShape{{x, y, 0}, {x + 0.08, y + 0.08, 0.7}}, kWood);
        }
    }
    const Vec3 up{0, 0, 1};
    add_beam_shape(d, BoxShape{{-0.1, -0.1, 0}, {0.1, 0.1, 0.3}}, kRed,
                   Affine::translate({0.1, 0.6, 0.76}) * Affine::rotate(up, kPi / 6));
    add_beam_shape(d, BoxShape{{-0.15, -0.1, 0}, {0.15, 0.1, 0.16}}, kBlue,
                   Affine::translate({0.55, 0.7, 0.76}) * Affine::rotate(up, -kPi / 9));
    d.lights.push_back({"sky", AmbientLight{{0.2, 0.2, 0.2}}, {}});
    d.lights.push_back({"sun", DirectionalLight{.to_light = normalize(Vec3{-0.5, 0.85, 0.6})}, {}});
    d.lights.push_back({"lamp", PointLight{.position = {0.1, 0.2, 2.7}}, {}});
    d.cameras.push_back(
        {"main",
         look_along({-1.2, -2.3, 1.6}, {1.8, 3.3, -0.5}, up, 62 * kRadiansPerDegree, 1.0),
         1.0,
         {}});
    return d;
}

struct BeamScenes {
    struct Entry {
        const char* name;
        std::uint64_t size;  ///< of the generator; 0: the mirror hall
        int depth;           ///< -1: the scene's
    };
    static constexpr std::array<Entry, 4> all{
        {{"tetra", 6, -1}, {"gears", 1, 2}, {"city", 400, -1}, {"hall of mirrors", 0, -1}}};
};

SceneDescription description_of(ClaimRun& run, const BeamScenes::Entry& entry) {
    SceneDescription d = entry.size == 0 ? mirror_hall() : run.generated(entry.name, entry.size);
    if (entry.depth >= 0) d.conventions.shading.max_depth = entry.depth;
    return d;
}

struct TimedPicture {
    RenderReport report;
    double seconds = 0;  ///< processor time; for beams with their geometry
};

TimedPicture beam_picture(const Renderer& renderer, const SceneDescription& d, const Scene& scene,
                          int side) {
    const CameraDescription& camera = find_camera(scene, "");
    RenderJob job{.scene = scene,
                  .camera = with_aspect(camera.camera, camera.aspect, 1.0),
                  .description = &d};
    job.control.threads = 1;
    Film film(side, side, {0, 0, side, side});
    TimedPicture picture;
    const CpuClock clock;
    picture.report = renderer.render(job, film);
    picture.seconds = clock.seconds();
    return picture;
}

std::uint64_t beams_in(const RenderReport& report) {
    const BeamReport& b = *report.beams;
    return b.eye_beams + b.reflected_beams + b.refracted_beams + b.shadow_beams;
}

/// Least-squares line: seconds = [0] + [1] n.
std::array<double, 2> line_through(std::span<const double> n, std::span<const double> seconds) {
    double sn = 0, ss = 0, snn = 0, sns = 0;
    for (std::size_t i = 0; i < n.size(); ++i) {
        sn += n[i];
        ss += seconds[i];
        snn += n[i] * n[i];
        sns += n[i] * seconds[i];
    }
    const auto count = static_cast<double>(n.size());
    const double slope = (count * sns - sn * ss) / (count * snn - sn * sn);
    return {(ss - slope * sn) / count, slope};
}

}  // namespace

void claim_e3(ClaimRun& run) {
    constexpr std::array kSides{128, 256, 512, 1024};
    for (const BeamScenes::Entry& entry : BeamScenes::all) {
        const SceneDescription d = description_of(run, entry);
        const Scene scene = compile(d);
        std::vector<double> pixels, beam_times, ray_times, rays;
        std::vector<std::uint64_t> beams;
        for (const int side : kSides) {
            run.step(fmt::format("{}: {} x {}", entry.name, side, side));
            const TimedPicture b = beam_picture(BeamTracing(), d, scene, side);
            const TimedPicture r = beam_picture(Whitted(), d, scene, side);
            pixels.push_back(double(side) * side);
            beams.push_back(beams_in(b.report));
            beam_times.push_back(b.seconds);
            rays.push_back(static_cast<double>(r.report.counters.total_cast()));
            ray_times.push_back(r.seconds);
            run.tell(fmt::format("{}, {} x {}: seconds, beams and rays", entry.name, side, side),
                     fmt::format("{:.3f}", b.seconds), fmt::format("{:.3f}", r.seconds));
        }
        const double alone = beam_picture(BeamTracing(), d, scene, 1).seconds;
        const double growth = rays.back() / rays.front();
        run.expect(fmt::format("{}: beams from {} x {} to {} x {}", entry.name, kSides.front(),
                               kSides.front(), kSides.back(), kSides.back()),
                   fmt::format("{} to {}", beams.front(), beams.back()), "equal",
                   beams.front() == beams.back());
        run.expect(fmt::format("{}: growth of rays", entry.name), fmt::format("{:.1f}", growth),
                   "64 within 10 %", std::abs(growth - 64) <= 6.4);
        const auto by_beams = line_through(pixels, beam_times);
        const auto by_rays = line_through(pixels, ray_times);
        const double crossing = (by_beams[0] - by_rays[0]) / (by_rays[1] - by_beams[1]);
        run.tell(fmt::format("{}: beams are faster from", entry.name),
                 by_rays[1] <= by_beams[1] ? "no resolution"
                 : crossing <= 0.0         ? "the first pixel"
                                           : fmt::format("{0:.0f} x {0:.0f}", std::sqrt(crossing)),
                 fmt::format("{:.2f} s + {:.2f} us a pixel; rays {:.2f} us", by_beams[0],
                             1e6 * by_beams[1], 1e6 * by_rays[1]));
        run.tell(fmt::format("{}: drawn without pixels, faster than rays from", entry.name),
                 fmt::format("{0:.0f} x {0:.0f}", std::sqrt(alone / by_rays[1])),
                 fmt::format("{:.3f} s for a picture of one pixel", alone));
    }
    run.note(
        "Processor time of one thread: beams with their facets, tree and pixels, rays (`whitted`, "
        "`wide_bvh`) without the building of their hierarchy. The resolution is where the lines "
        "through the times meet.");
}

void claim_e4(ClaimRun& run) {
    for (const BeamScenes::Entry& entry : BeamScenes::all) {
        const SceneDescription d = description_of(run, entry);
        const Scene scene = compile_without_geometry(d);
        run.step(std::string(entry.name) + ": with hulls");
        const RenderReport with = beam_picture(BeamTracing(), d, scene, 64).report;
        run.step(std::string(entry.name) + ": without hulls");
        const RenderReport without =
            beam_picture(BeamTracing({.cast = {.hulls = false}}), d, scene, 64).report;
        const auto each = [](const RenderReport& report) {
            return static_cast<double>(report.beams->polygons_tested) /
                   static_cast<double>(beams_in(report));
        };
        const double ratio = each(without) / each(with);
        run.expect(fmt::format("{}, {} polygons, {} beams: polygons per beam by the tree alone "
                               "over those with hulls",
                               entry.name, with.beams->polygons, beams_in(with)),
                   fmt::format("{:.1f} / {:.1f} = {:.1f}", each(without), each(with), ratio),
                   ">= 5", ratio >= 5.0);
        run.tell(fmt::format("{}: hulls tested per beam, missed", entry.name),
                 fmt::format("{:.1f}, {:.0f} %",
                             static_cast<double>(with.beams->hulls_tested) /
                                 static_cast<double>(beams_in(with)),
                             100.0 * static_cast<double>(with.beams->hulls_missed) /
                                 static_cast<double>(with.beams->hulls_tested)));
    }
}

}  // namespace alhazen

/// Growth of the time per ray with the number of triangles: one shape at increasing tessellation.
/// Usage: alhazen_growth_bench [--from N] [--to N] [--side N] [--rounds N] [--csv FILE]
/// Writes one line per size, ray set and tracer, which growth.py plots, and prints the slopes on
/// logarithmic axes.

#include <fmt/format.h>

#include <cmath>

#include "alhazen/base/file.h"
#include "command_line.h"
#include "measure.h"
#include "our_tracer.h"
#ifdef ALHAZEN_HAVE_EMBREE
#include "embree/embree_packets.h"
#include "embree/embree_scene.h"
#endif

namespace {

using namespace alhazen;
using namespace alhazen::bench;

struct Settings {
    double from = 1e4, to = 1e7;
    int side = 512;
    int rounds = 5;
};

/// One point of a curve; nanoseconds per ray.
struct Point {
    std::string rays, tracer;
    double triangles = 0, median = 0, lower = 0, upper = 0;
};

Point point_of(const RaySet& set, double triangles, const Measured& m) {
    const Spread s = m.spread();
    // The upper quartile of the rate is the lower quartile of the time.
    return {set.name,       m.group + " " + m.name, triangles,
            1e3 / s.median, 1e3 / s.upper,          1e3 / s.lower};
}

std::vector<Point> measure_size(double wanted, const Settings& settings) {
    const KernelScene scene = growing_balls(static_cast<std::size_t>(wanted));
    const auto triangles = static_cast<double>(scene.mesh.triangles.size());
    const auto aggregate = build_ours(scene);
#ifdef ALHAZEN_HAVE_EMBREE
    const EmbreeScene robust(scene, {});
#endif
    std::vector<Point> points;
    for (const RaySet& set : ray_sets(scene, *aggregate, settings.side)) {
        if (set.name != "shuffled" && set.name != "lines") continue;
        OurTracer ours(*aggregate, set);
        std::vector<Contender> tracers{
            our_contender("wide_bvh", "single", [&](bool counts) { return ours.single(counts); }),
            our_contender("wide_bvh", "batch", [&](bool counts) { return ours.batches(counts); })};
#ifdef ALHAZEN_HAVE_EMBREE
        const auto packets = make_embree_packets(set, 1);
        tracers.push_back({"Embree", "robust", [&] { packets->reset(); },
                           [&] { packets->trace(robust.handle(), false); },
                           [&] { return packets->count_hits(); }});
#endif
        for (const Measured& m : measure(fmt::format("{} {}", set.name, triangles), tracers,
                                         set.rays.size(), settings.rounds)) {
            points.push_back(point_of(set, triangles, m));
            fmt::print("{:>9.0f} triangles {:<9} {:<16} {:8.1f} ns [{:.1f}, {:.1f}]\n", triangles,
                       set.name, points.back().tracer, points.back().median, points.back().lower,
                       points.back().upper);
        }
    }
    std::fflush(stdout);
    return points;
}

/// Slope of the least-squares line of log time against log size.
double slope_of(const std::vector<Point>& points, const Point& like) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const Point& p : points) {
        if (p.rays != like.rays || p.tracer != like.tracer) continue;
        const double x = std::log(p.triangles), y = std::log(p.median);
        n += 1;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

std::string as_csv(const std::vector<Point>& points) {
    std::string text = "triangles,rays,tracer,ns_per_ray,lower_quartile,upper_quartile\n";
    for (const Point& p : points) {
        text += fmt::format("{:.0f},{},{},{:.2f},{:.2f},{:.2f}\n", p.triangles, p.rays, p.tracer,
                            p.median, p.lower, p.upper);
    }
    return text;
}

void print_slopes(const std::vector<Point>& points) {
    if (points.front().triangles == points.back().triangles) return;
    for (const Point& p : points) {
        if (p.triangles != points.front().triangles) break;
        fmt::print("slope {:<9} {:<16} {:.3f}: ten times the triangles, {:.2f} times the time\n",
                   p.rays, p.tracer, slope_of(points, p), std::pow(10.0, slope_of(points, p)));
    }
}

}  // namespace

int main(int argc, char** argv) try {
    const CommandLine line(argc, argv, {"--from", "--to", "--side", "--rounds", "--csv"});
    Settings settings;
    settings.from = static_cast<double>(line.count("--from", 10'000));
    settings.to = static_cast<double>(line.count("--to", 10'000'000));
    settings.side = static_cast<int>(line.count("--side", 512));
    settings.rounds = static_cast<int>(line.count("--rounds", 5));
    const std::string file = line.text("--csv", "");
    std::vector<Point> points;
    // Steps of half a decade; the factor 1.01 includes the last size despite rounding.
    for (double n = settings.from; n < 1.01 * settings.to; n *= std::sqrt(10.0)) {
        for (Point& p : measure_size(n, settings)) points.push_back(std::move(p));
        if (!file.empty()) write_file_atomically(file, as_csv(points));
    }
    print_slopes(points);
    return 0;
} catch (const std::exception& error) {
    fmt::print(stderr, "growth_bench: {}\n", error.what());
    return 1;
}

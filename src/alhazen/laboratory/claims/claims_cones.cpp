/// Experiments E1 and E2 of claims.h: cones.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "alhazen/base/stopwatch.h"
#include "alhazen/geometry/cones/coverage_tables.h"
#include "alhazen/geometry/cones/disc_area.h"
#include "alhazen/laboratory/claims/claim_run.h"
#include "alhazen/math/constants.h"
#include "alhazen/renderers/cone_tracing/cone_tracing.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "alhazen/sampling/random.h"

namespace alhazen {
namespace {

constexpr int kConeWidth = 320, kConeHeight = 200;

void add_shape(SceneDescription& d, AnyShape shape, std::uint32_t material) {
    Part part;
    part.what = std::move(shape);
    part.material = MaterialId{material};
    d.objects[0].parts.push_back(std::move(part));
}

/// A checkered plane to the horizon, thin poles, and small spheres.
SceneDescription horizon_scene() {
    SceneDescription d;
    d.objects.push_back({"root", {}, {}});
    SolidTexture checks;
    checks.color = {0.85, 0.85, 0.8, 1};
    checks.other = {0.12, 0.14, 0.2, 1};
    checks.origin = {0.3, 0.2, 0};
    d.textures.push_back({"checks", checks, {}});
    const Rgb colors[] = {{1, 1, 1}, {0.75, 0.2, 0.1}, {0.1, 0.25, 0.7}};
    for (const Rgb& color : colors) {
        Material m;
        m.diffuse.color = m.ambient.color = color;
        if (d.materials.empty()) m.diffuse.texture = m.ambient.texture = TextureId{0};
        d.materials.push_back({m, {}});
    }
    add_shape(d, AnyShape{Plane{}}, 0);
    RandomStream random(1984);
    for (int k = 0; k < 24; ++k) {
        const double y = random.uniform(3, 40), x = random.uniform(-0.8, 0.8) * y;
        const double half = random.uniform(0.005, 0.03);
        add_shape(d, AnyShape{BoxShape{{x - half, y - half, 0}, {x + half, y + half, 3}}}, 1);
    }
    for (int k = 0; k < 60; ++k) {
        const double y = random.uniform(3, 40), x = random.uniform(-0.8, 0.8) * y;
        const double radius = random.uniform(0.01, 0.08);
        add_shape(d, AnyShape{Sphere{{x, y, random.uniform(radius, 2.5)}, radius}}, 2);
    }
    d.lights.push_back({"sun", DirectionalLight{.to_light = {-0.5, -0.4, 0.8}}, {}});
    d.lights.push_back({"sky", AmbientLight{{0.25, 0.27, 0.3}}, {}});
    d.picture.background = Rgb{0.55, 0.65, 0.85};
    return d;
}

struct ConePicture {
    Film film;
    double seconds = 0;
};
ConePicture picture_of(const Renderer& renderer, const SceneDescription& d, const Scene& scene,
                       const Camera& camera, int samples, const RayCone& cone, int threads) {
    ConePicture picture{Film(kConeWidth, kConeHeight, {0, 0, kConeWidth, kConeHeight})};
    RenderJob job{.scene = scene,
                  .camera = camera,
                  .samples_per_pixel = samples,
                  .seed = 7,
                  .cone = cone,
                  .description = &d};
    job.control.threads = threads;
    const Stopwatch time;
    (void)renderer.render(job, picture.film);
    picture.seconds = time.seconds();
    return picture;
}

double rmse(const Film& a, const Film& b) {
    double sum = 0;
    for (int y = 0; y < kConeHeight; ++y) {
        for (int x = 0; x < kConeWidth; ++x) {
            const Rgb d = a.at(x, y) - b.at(x, y);
            sum += d.r * d.r + d.g * d.g + d.b * d.b;
        }
    }
    return std::sqrt(sum / (3.0 * kConeWidth * kConeHeight));
}

/// Nanoseconds of one call; minimum of several passes.
template <class F>
double nanoseconds(const std::vector<Vec2>& places, double& sum, F&& f) {
    double least = kInfinity;
    for (int pass = 0; pass < 7; ++pass) {
        const Stopwatch time;
        for (const Vec2& p : places) sum += f(p.x, p.y);
        least = std::min(least, 1e9 * time.seconds() / static_cast<double>(places.size()));
    }
    return least;
}

}  // namespace

void claim_e1(ClaimRun& run) {
    const SceneDescription d = horizon_scene();
    run.step("the scene");
    const Scene scene = compile(d);
    const Camera camera =
        look_along({0, 0, 1.3}, {0, 1, -0.08}, {0, 0, 1}, 0.7, double(kConeWidth) / kConeHeight);
    const Whitted rays;
    run.step("reference, 1024 rays per pixel");
    const Film reference = picture_of(rays, d, scene, camera, 1024, {}, 0).film;
    run.step("cones");
    const ConePicture cones = picture_of(ConeTracing(), d, scene, camera, 1, {}, 1);
    const double ours = rmse(cones.film, reference);
    for (const int count : {1, 4, 16, 64}) {
        run.step(fmt::format("{} rays per pixel", count));
        const ConePicture lines = picture_of(rays, d, scene, camera, count, {}, 1);
        const double theirs = rmse(lines.film, reference);
        const std::string what =
            fmt::format("RMSE and seconds, one cone per pixel; {} rays", count);
        const std::string one = fmt::format("{:.5f}, {:.2f} s", ours, cones.seconds);
        const std::string other = fmt::format("{:.5f}, {:.2f} s", theirs, lines.seconds);
        if (count == 16) {
            run.expect(what, one, other, ours <= theirs);
        } else {
            run.tell(what, one, other);
        }
    }
    const RayCone footprint = eye_cone(camera, kConeHeight, 16);
    const ConePicture filtered = picture_of(rays, d, scene, camera, 16, footprint, 1);
    run.tell("the same, 16 rays that look up textures with their own footprints",
             fmt::format("{:.5f}, {:.2f} s", ours, cones.seconds),
             fmt::format("{:.5f}, {:.2f} s", rmse(filtered.film, reference), filtered.seconds));
    run.note(
        "320 x 200: a plane of checks, 24 poles, 60 spheres, a sun and its shadows; times of one "
        "thread. Rays are lines: they look up textures at points.");
}

void claim_e2(ClaimRun& run) {
    const CoverageTables& tables = CoverageTables::shared();
    RandomStream random(1987);
    double off_sphere = 0, off_plane = 0;
    std::vector<Vec2> places;
    run.step("errors");
    for (int k = 0; k < 2'000'000; ++k) {
        // Alternates radii of any size with radii near that of the cone.
        const double R = std::exp(k % 2 == 0 ? random.uniform(-6, 8) : random.uniform(-0.15, 0.15));
        const double least = std::abs(R - 1.0);
        const double d = least + random.uniform() * (R + 1.0 - least);
        off_sphere = std::max(off_sphere, std::abs(tables.sphere(d, R) - lens_area(1, R, d) / kPi));
        const double h = random.uniform(-1, 1);
        off_plane = std::max(off_plane, std::abs(tables.plane(h) - segment_area(1, h) / kPi));
        if (places.size() < 20'000) places.push_back({d, R});
    }
    run.expect("largest error of the table of spheres", fmt::format("{:.2e}", off_sphere),
               "<= 1e-3", off_sphere <= 1e-3);
    run.expect("largest error of the table of planes", fmt::format("{:.2e}", off_plane), "<= 1e-3",
               off_plane <= 1e-3);
    run.step("times");
    double sum = 0;
    const double formula =
        nanoseconds(places, sum, [](double d, double R) { return lens_area(1, R, d) / kPi; });
    const double table =
        nanoseconds(places, sum, [&](double d, double R) { return tables.sphere(d, R); });
    run.expect("sphere: the formula's time over the table's",
               fmt::format("{:.1f} / {:.1f} ns = {:.1f}", formula, table, formula / table), ">= 2",
               formula >= 2 * table);
    for (Vec2& p : places) p.x = random.uniform(-1, 1);
    const double segment =
        nanoseconds(places, sum, [](double h, double) { return segment_area(1, h) / kPi; });
    const double line = nanoseconds(places, sum, [&](double h, double) { return tables.plane(h); });
    run.expect("plane: the same",
               fmt::format("{:.1f} / {:.1f} ns = {:.1f}", segment, line, segment / line), ">= 2",
               segment >= 2 * line);
    run.note(fmt::format("Random discs that overlap; the sum of all lookups is {:.6g}.", sum));
}

}  // namespace alhazen

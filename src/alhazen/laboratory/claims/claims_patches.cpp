/// Experiments C1 to C3 of claims.h: scan-line rendering of curved patches.

#include <fmt/format.h>

#include <cmath>

#include "alhazen/laboratory/claims/claim_run.h"
#include "alhazen/renderers/core/reports/scan_line_report.h"
#include "alhazen/renderers/lane_carpenter/lane_carpenter.h"
#include "alhazen/sampling/random.h"
#include "alhazen/session/generators/teapot_patches.h"

namespace alhazen {
namespace {

/// A scene of one shape that is darker than its background.
struct PatchScene {
    SceneDescription description;
    Scene scene;

    /// `from_outside`: surfaces that face away from the eye are not drawn.
    explicit PatchScene(AnyShape shape, bool from_outside = false) {
        description.objects.push_back({"root", {}, {}});
        Material dark;
        dark.emission.color = {0.05, 0.0, 0.0};
        dark.double_sided = !from_outside;
        description.materials.push_back({dark, {}});
        Part part;
        part.what = std::move(shape);
        description.objects[0].parts.push_back(std::move(part));
        scene = compile_without_geometry(description);
        scene.background = {1, 1, 1};
    }
};

struct ScanPicture {
    Film film;
    ScanLineReport counts;
};

ScanPicture scan(const PatchScene& scene, const Camera& camera, int size,
                 const ScanLineOptions& options) {
    ScanPicture picture{Film(size, size, {0, 0, size, size}), {}};
    RenderJob job{.scene = scene.scene, .camera = camera, .description = &scene.description};
    job.control.threads = 1;
    picture.counts = *LaneCarpenter(options).render(job, picture.film).scan_lines;
    return picture;
}

AnyShape teapot_mesh() {
    PatchMesh mesh;
    for (const TeapotPatch& patch : teapot_patches()) {
        for (const auto& row : patch) {
            for (const Vec3& p : row) {
                mesh.patches.push_back(static_cast<std::uint32_t>(mesh.points.size()));
                mesh.points.push_back(p);
            }
        }
    }
    return AnyShape{std::move(mesh)};
}

/// A camera in a direction from the origin, filled mostly by a sphere around the origin.
Camera view_from(const Vec3& direction, double radius) {
    const Vec3 unit = normalize(direction);
    const Vec3 eye = 4.0 * radius * unit;
    return look_along(eye, -eye, std::abs(unit.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{0, 1, 0}, 0.52, 1.0);
}

/// Counts background pixels in the closure of the dark ones: with a dark pixel on both sides, in
/// their row and in their column, at most two pixels away.
int ground_inside(const Film& film, const Rgb& ground) {
    const PixelBox& crop = film.crop();
    const auto dark = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < crop.x1 && y < crop.y1 && film.at(x, y) != ground;
    };
    const auto between = [&](int x, int y, int dx, int dy) {
        return (dark(x - dx, y - dy) || dark(x - 2 * dx, y - 2 * dy)) &&
               (dark(x + dx, y + dy) || dark(x + 2 * dx, y + 2 * dy));
    };
    int count = 0;
    for (int y = 0; y < crop.y1; ++y) {
        for (int x = 0; x < crop.x1; ++x) {
            count += film.at(x, y) == ground && between(x, y, 1, 0) && between(x, y, 0, 1) &&
                     between(x, y, 1, 1) && between(x, y, 1, -1);
        }
    }
    return count;
}

constexpr double kTeapotRadius = 4.0;
constexpr double kClaimFlatness = 0.25;

}  // namespace

void claim_c1(ClaimRun& run) {
    const PatchScene teapot(teapot_mesh());
    for (const int size : {256, 512, 1024}) {
        run.step(fmt::format("teapot, {0} x {0}", size));
        const Camera camera = view_from({0.6, -1.0, 0.5}, kTeapotRadius);
        ScanLineOptions options;
        options.flatness = kClaimFlatness;
        const ScanLineReport lazy = scan(teapot, camera, size, options).counts;
        options.all_first = true;
        const ScanLineReport first = scan(teapot, camera, size, options).counts;
        const double ratio =
            static_cast<double>(first.most_held) / static_cast<double>(lazy.most_held);
        run.expect(fmt::format("teapot {0} x {0}: patches and polygons in memory, clark over "
                               "lane_carpenter",
                               size),
                   fmt::format("{} / {} = {:.1f}", first.most_held, lazy.most_held, ratio), ">= 5",
                   ratio >= 5.0);
        run.tell("of these, patches that are not yet flat",
                 fmt::format("{} / {}", first.most_patches, lazy.most_patches));
    }
    run.note("Both draw the same polygons, of a flatness of 0.25 pixels.");
}

void claim_c2(ClaimRun& run) {
    const PatchScene torus(AnyShape{Torus{.major_radius = 1.2, .minor_radius = 0.5}}, true);
    constexpr int kViews = 100, kSize = 256;
    struct Way {
        Cracks cracks;
        const char* name;
        bool any;
    };
    for (const Way& way : {Way{Cracks::Show, "show", true}, Way{Cracks::Tighter, "tighter", false},
                           Way{Cracks::Clark, "clark", false}}) {
        run.step(fmt::format("cracks={}", way.name));
        RandomStream random(1980);
        int pixels = 0, views = 0;
        std::uint64_t counted = 0, passes = 0;
        for (int k = 0; k < kViews; ++k) {
            Vec3 direction;
            do {
                direction = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
            } while (length_squared(direction) > 1.0 || length_squared(direction) < 0.01);
            ScanLineOptions options;
            options.flatness = 1.0;
            options.cracks = way.cracks;
            options.find_cracks = true;
            const ScanPicture picture = scan(torus, view_from(direction, 1.7), kSize, options);
            const int found = ground_inside(picture.film, torus.scene.background);
            pixels += found;
            views += found > 0;
            counted += picture.counts.crack_samples;
            passes += picture.counts.passes;
        }
        run.expect(fmt::format("cracks={}: pixels of ground inside, {} views", way.name, kViews),
                   fmt::format("{} in {} views", pixels, views), way.any ? "> 0" : "0",
                   way.any ? pixels > 0 : pixels == 0);
        if (way.cracks == Cracks::Clark) continue;
        run.tell("samples in cracks, by the edges",
                 fmt::format("{}, {:.1f} passes a view", counted, double(passes) / kViews));
    }
    run.note(
        "A torus of sixteen rational biquadratic patches, a flatness of 1 pixel; what is turned "
        "away from the eye is not drawn, else the far side shows through a crack. A pixel of "
        "ground "
        "is inside where the torus is at most two pixels away in all eight directions.");
}

void claim_c3(ClaimRun& run) {
    const PatchScene teapot(teapot_mesh());
    const PatchScene torus(AnyShape{Torus{.major_radius = 1.2, .minor_radius = 0.5}});
    const PatchScene cylinder(AnyShape{Cylinder{.base = {0, 0, -1.5}, .top = {0, 0, 1.5}}});
    const auto compare = [&](const char* name, const PatchScene& scene, double radius) {
        run.step(name);
        const Camera camera = view_from({0.6, -1.0, 0.5}, radius);
        ScanLineOptions options;
        options.flatness = kClaimFlatness;
        const std::uint64_t one = scan(scene, camera, 512, options).counts.quads;
        options.split = SplitRule::Both;
        const std::uint64_t both = scan(scene, camera, 512, options).counts.quads;
        run.expect(fmt::format("{}: polygons, split in one direction over both", name),
                   fmt::format("{} / {} = {:.2f}", one, both, double(one) / double(both)), "< 1",
                   one < both);
    };
    compare("teapot", teapot, kTeapotRadius);
    compare("torus", torus, 1.7);
    compare("cylinder", cylinder, 2.0);
    run.note("512 x 512, a flatness of 0.25 pixels in both.");
}

}  // namespace alhazen

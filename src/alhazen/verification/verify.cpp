#include "alhazen/verification/verify.h"

#include <algorithm>
#include <limits>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/stream_override.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/scene/scene.h"
#include "alhazen/verification/brute_force.h"
#include "alhazen/verification/shared_progress.h"
#include "alhazen/verification/verify_query_paths.h"
#include "alhazen/verification/verify_rays.h"

namespace alhazen {

namespace {

/// The number of rays that a query of the tested accelerator may trace: `list` tests every
/// primitive.
std::uint64_t affordable_rays(std::uint64_t rays, std::uint64_t primitives,
                              const VerifyOptions& options) {
    constexpr std::uint64_t kLeastRays = 100;
    if (!options.accelerator.starts_with("list")) return rays;
    const std::uint64_t affordable =
        options.most_list_tests / std::max<std::uint64_t>(1, primitives);
    return std::min(rays, std::max(kLeastRays, affordable));
}

/// Counts the crossings of whole lines with one closed surface.
void count_crossings(const Aggregate& surface, VerifyRays& rays, std::uint64_t lines,
                     SharedProgress& progress, VerifyReport& report) {
    constexpr std::size_t kLinesAtOnce = 1 << 16;
    ++report.closed_surfaces;
    report.parity_lines += lines;
    std::vector<VerifyRays::Sample> samples;
    std::vector<std::string> odd;  // [sample] description of an odd number; empty if even
    for (std::uint64_t done = 0; done < lines; done += samples.size()) {
        samples.clear();
        while (samples.size() < kLinesAtOnce && done + samples.size() < lines) {
            samples.push_back(rays.next());
            samples.back().ray.t_min = -std::numeric_limits<double>::infinity();
        }
        odd.assign(samples.size(), {});
        parallel_for(samples.size(), 256, [&](std::size_t begin, std::size_t end) {
            std::vector<Hit> hits;
            for (std::size_t i = begin; i < end; ++i) {
                hits.clear();
                surface.all_hits(samples[i].ray, hits, nullptr);
                if (hits.size() % 2 != 0) odd[i] = describe(hits);
            }
            progress.add(end - begin);
        });
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (odd[i].empty()) continue;
            ++report.odd_crossings;
            if (report.reported.size() >= kMostReported) continue;
            report.reported.push_back({samples[i].kind, "parity", samples[i].ray, std::move(odd[i]),
                                       "an even number of crossings"});
        }
    }
}

/// A table with one mesh or one analytic shape of the scene, in its own frame.
struct LoneSurface {
    PrimitiveTable table;
    bool closed = false;
    bool is_mesh = false;
    /// The table is empty: the aggregate of the scene is used.
    bool is_whole_scene = false;
};

/// True if the scene is only this mesh, not moved: its aggregate can be used.
bool is_only(const Scene& scene, const TriangleMesh& mesh) {
    const PrimitiveTable& table = scene.aggregate->primitives();
    if (scene.has_masks || table.meshes.size() != 1) return false;
    if (table.size() != mesh.triangles.size()) return false;
    const TriangleMesh& placed = *table.meshes.front().mesh;
    return &placed == &mesh ||
           (placed.triangles == mesh.triangles && placed.positions == mesh.positions);
}

LoneSurface lone_mesh(const std::shared_ptr<TriangleMesh>& mesh, const Scene& scene) {
    LoneSurface lone;
    lone.is_mesh = true;
    lone.closed = !mesh->triangles.empty() && mesh->closed();
    if (!lone.closed) return lone;
    lone.is_whole_scene = is_only(scene, *mesh);
    if (lone.is_whole_scene) return lone;
    auto plain = std::make_shared<TriangleMesh>();
    plain->positions = mesh->positions;
    plain->triangles = mesh->triangles;
    lone.table.meshes.push_back({std::move(plain), MaterialId{0}, 0, false});
    return lone;
}

LoneSurface lone_shape(const AnyShape& any) {
    LoneSurface lone;
    std::visit(
        [&]<class S>(const S& shape) {
            auto& column = std::get<ShapeColumn<S>>(lone.table.columns);
            S& prepared = column.shapes.emplace_back(shape);
            prepared.prepare();
            // Unbounded shapes may have an odd number of crossings.
            lone.closed = prepared.closed() && prepared.box().bounded();
            column.placements.push_back(kNoPlacement);
            column.materials.push_back(MaterialId{0});
        },
        any);
    return lone;
}

/// Every closed surface of the scene separately; of analytic shapes at most a sample.
std::vector<LoneSurface> lone_surfaces(const SceneDescription& description, const Scene& scene,
                                       VerifyReport& report) {
    constexpr std::size_t kMaxShapes = 64;
    std::vector<LoneSurface> surfaces;
    for (const MeshDescription& mesh : description.meshes) {
        surfaces.push_back(lone_mesh(mesh.mesh, scene));
    }
    std::size_t shapes = 0;
    for (const ObjectDescription& object : description.objects) {
        for (const Part& part : object.parts) {
            const AnyShape* shape = std::get_if<AnyShape>(&part.what);
            if (shape == nullptr) continue;
            if (shapes++ >= kMaxShapes) {
                ++report.shapes_left_out;
                continue;
            }
            surfaces.push_back(lone_shape(*shape));
            report.shapes_left_out += !surfaces.back().closed;
        }
    }
    return surfaces;
}

void count_all_crossings(const SceneDescription& description, const Scene& scene,
                         const VerifyOptions& options, VerifyReport& report) {
    std::vector<LoneSurface> surfaces = lone_surfaces(description, scene, report);
    std::size_t closed = 0;
    for (const LoneSurface& surface : surfaces) {
        closed += surface.closed;
        report.open_meshes += surface.is_mesh && !surface.closed;
    }
    if (closed == 0) return;
    const std::uint64_t lines = std::max<std::uint64_t>(100, options.rays / closed);
    const auto lines_of = [&](const LoneSurface& surface) {
        const auto& meshes =
            (surface.is_whole_scene ? scene.aggregate->primitives() : surface.table).meshes;
        const std::size_t count = meshes.empty() ? 1 : meshes.front().mesh->triangles.size();
        return affordable_rays(lines, count, options);
    };
    std::uint64_t all = 0;
    for (const LoneSurface& surface : surfaces) all += surface.closed ? lines_of(surface) : 0;
    SharedProgress progress(options.progress, "lines " + options.accelerator, all);
    for (LoneSurface& surface : surfaces) {
        if (!surface.closed) continue;
        const std::uint64_t own = lines_of(surface);
        const auto count = [&](const Aggregate& aggregate) {
            VerifyRays rays(aggregate.box(), nullptr, aggregate.primitives(), options.seed + 1);
            count_crossings(aggregate, rays, own, progress, report);
        };
        if (surface.is_whole_scene) {
            count(*scene.aggregate);
            continue;
        }
        surface.table.material_opacity.assign(1, Opacity::Opaque);
        surface.table.finish();
        count(*make_aggregate(options.accelerator, std::move(surface.table), options.build));
    }
}

}  // namespace

VerifyReport verify(const SceneDescription& description, const VerifyOptions& options) {
    const StreamOverride streams;
    VerifyReport report;
    report.accelerator = options.accelerator;
    Scene fast;
    {
        SharedProgress progress(options.progress, "build " + options.accelerator, 1);
        fast = compile(
            description,
            {.accelerator = options.accelerator, .csg = options.csg, .build = options.build});
        progress.add(1);
    }
    const Scene plain =
        compile(description,
                {.accelerator = "list", .csg = "roth", .build = {}, .own_accelerators = false});
    const BruteForce brute(*plain.aggregate);
    report.believed_boxes = brute.believed_boxes();
    const Camera* camera =
        fast.cameras.empty() ? nullptr : &find_camera(fast, options.camera).camera;
    VerifyRays rays(fast.aggregate->box(), camera, fast.aggregate->primitives(), options.seed);
    VerifyOptions affordable = options;
    affordable.rays = affordable_rays(options.rays, fast.census.effective_primitives, options);
    report.rays_left_out = options.rays - affordable.rays;
    QueryPathComparison(*fast.aggregate, brute, affordable, report).run(rays, fast.has_masks);
    count_all_crossings(description, fast, options, report);
    return report;
}

}  // namespace alhazen

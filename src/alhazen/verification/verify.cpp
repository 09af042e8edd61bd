#include "alhazen/verification/verify.h"

#include <algorithm>
#include <limits>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/scene/scene.h"
#include "alhazen/verification/verify_rays.h"
#include "alhazen/verification/verify_roads.h"

namespace alhazen {

namespace {

/// Counts the crossings of whole lines with one closed surface.
void count_crossings(const Aggregate& surface, VerifyRays& rays, std::uint64_t lines,
                     const VerifyOptions& options, VerifyReport& report) {
    ++report.closed_surfaces;
    std::vector<Hit> hits;
    for (std::uint64_t i = 0; i < lines; ++i) {
        VerifyRays::Sample sample = rays.next();
        sample.ray.t_min = -std::numeric_limits<double>::infinity();
        ++report.parity_lines;
        hits.clear();
        surface.all_hits(sample.ray, hits, nullptr);
        if (hits.size() % 2 == 0) continue;
        ++report.odd_crossings;
        if (report.reported.size() >= options.max_reported) continue;
        report.reported.push_back(
            {sample.kind, "parity", sample.ray, describe(hits), "an even number of crossings"});
    }
}

/// A table with one mesh or one analytic shape of the scene, in its own frame.
struct LoneSurface {
    PrimitiveTable table;
    bool closed = false;
    bool is_mesh = false;
};

LoneSurface lone_mesh(const std::shared_ptr<TriangleMesh>& mesh) {
    LoneSurface lone;
    lone.is_mesh = true;
    lone.closed = !mesh->triangles.empty() && mesh->closed();
    if (!lone.closed) return lone;
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
            // What has no bounds may be crossed oddly often.
            lone.closed = shape.closed() && shape.box().bounded();
            auto& column = std::get<ShapeColumn<S>>(lone.table.columns);
            column.shapes.push_back(shape);
            column.placements.push_back(kNoPlacement);
            column.materials.push_back(MaterialId{0});
        },
        any);
    return lone;
}

/// Every closed surface of the scene by itself; no more analytic shapes than a sample of each
/// scene.
std::vector<LoneSurface> lone_surfaces(const SceneDescription& description) {
    constexpr std::size_t kMaxShapes = 64;
    std::vector<LoneSurface> surfaces;
    for (const MeshDescription& mesh : description.meshes) surfaces.push_back(lone_mesh(mesh.mesh));
    std::size_t shapes = 0;
    for (const ObjectDescription& object : description.objects) {
        for (const Part& part : object.parts) {
            const AnyShape* shape = std::get_if<AnyShape>(&part.what);
            if (shape == nullptr || shapes++ >= kMaxShapes) continue;
            surfaces.push_back(lone_shape(*shape));
        }
    }
    return surfaces;
}

void count_all_crossings(const SceneDescription& description, const VerifyOptions& options,
                         VerifyReport& report) {
    std::vector<LoneSurface> surfaces = lone_surfaces(description);
    std::size_t closed = 0;
    for (const LoneSurface& surface : surfaces) {
        closed += surface.closed;
        report.open_meshes += surface.is_mesh && !surface.closed;
    }
    if (closed == 0) return;
    const std::uint64_t lines = std::max<std::uint64_t>(100, options.rays / closed);
    for (LoneSurface& surface : surfaces) {
        if (!surface.closed) continue;
        surface.table.material_opacity.assign(1, Opacity::Opaque);
        surface.table.finish();
        const auto aggregate =
            make_aggregate(options.accelerator, std::move(surface.table), options.build);
        VerifyRays rays(aggregate->box(), nullptr, aggregate->primitives(), options.seed + 1);
        count_crossings(*aggregate, rays, lines, options, report);
    }
}

}  // namespace

VerifyReport verify(const SceneDescription& description, const VerifyOptions& options) {
    VerifyReport report;
    report.accelerator = options.accelerator;
    const Scene fast =
        compile(description,
                {.accelerator = options.accelerator, .csg = options.csg, .build = options.build});
    const Scene brute =
        compile(description,
                {.accelerator = "list", .csg = "roth", .build = {}, .own_accelerators = false});
    const Camera* camera =
        fast.cameras.empty() ? nullptr : &find_camera(fast, options.camera).camera;
    VerifyRays rays(fast.aggregate->box(), camera, fast.aggregate->primitives(), options.seed);
    RoadComparison(*fast.aggregate, *brute.aggregate, options, report).run(rays, fast.has_masks);
    count_all_crossings(description, options, report);
    return report;
}

}  // namespace alhazen

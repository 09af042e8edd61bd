#include "alhazen/verification/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/scene/scene.h"
#include "alhazen/verification/verify_rays.h"

namespace alhazen {

namespace {

bool same_hit(const Hit& a, const Hit& b) {
    return a.t == b.t && a.u == b.u && a.v == b.v && a.part == b.part &&
           a.primitive == b.primitive && a.path == b.path;
}

std::string describe(const Hit& hit) {
    if (!hit.found()) return "no hit";
    return fmt::format("t={:.17g} primitive={} part={} u={:.17g} v={:.17g} level={}", hit.t,
                       static_cast<std::uint32_t>(hit.primitive), hit.part, hit.u, hit.v,
                       hit.path.size());
}

std::string describe(const std::vector<Hit>& hits) {
    std::string text = fmt::format("{} hits", hits.size());
    for (std::size_t i = 0; i < std::min<std::size_t>(hits.size(), 4); ++i) {
        text += "; " + describe(hits[i]);
    }
    return text;
}

class Verifier {
  public:
    Verifier(const VerifyOptions& options, VerifyReport& report)
        : options_(options), report_(report) {}

    /// As rays of `mask` see both.
    void compare(const Aggregate& fast, const Aggregate& brute, const VerifyRays::Sample& sample,
                 RayMask mask) {
        const Ray& ray = sample.ray;
        const RayQuery query{nullptr, mask};
        seen_by_.clear();
        for (std::size_t k = 0; mask != kAllRays && k < kRayKindCount; ++k) {
            if (mask == mask_of(static_cast<RayKind>(k))) seen_by_ = kRayKindNames[k];
        }
        ++report_.rays;
        Hit found, expected;
        (void)fast.closest(ray, found, query);
        (void)brute.closest(ray, expected, query);
        report_.hits += expected.found();
        if (found.found() != expected.found() || (found.found() && !same_hit(found, expected))) {
            disagree(sample, "closest", describe(found), describe(expected));
        }
        const bool occluded = fast.occluded(ray, query);
        if (occluded != expected.found()) {
            disagree(sample, "occluded", occluded ? "occluded" : "free",
                     expected.found() ? "occluded" : "free");
        }
        fast_hits_.clear();
        brute_hits_.clear();
        fast.all_hits(ray, fast_hits_, query);
        brute.all_hits(ray, brute_hits_, query);
        if (!std::equal(fast_hits_.begin(), fast_hits_.end(), brute_hits_.begin(),
                        brute_hits_.end(), same_hit)) {
            disagree(sample, "all_hits", describe(fast_hits_), describe(brute_hits_));
        }
        // The nearest of all hits must be the closest hit.
        if (!brute_hits_.empty() && !same_hit(brute_hits_.front(), expected)) {
            disagree(sample, "all_hits", "first: " + describe(brute_hits_.front()),
                     describe(expected));
        }
        fast_hits_.clear();
        brute_hits_.clear();
        const bool shadowed = fast.shadowed(ray, fast_hits_, query);
        const bool expect_shadow = brute.shadowed(ray, brute_hits_, query);
        if (shadowed != expect_shadow ||
            (!shadowed && !std::equal(fast_hits_.begin(), fast_hits_.end(), brute_hits_.begin(),
                                      brute_hits_.end(), same_hit))) {
            disagree(sample, "shadowed", describe(fast_hits_), describe(brute_hits_));
        }
    }

    /// Crossings of the whole line with one closed surface.
    void count_crossings(const Aggregate& surface, VerifyRays& rays, std::uint64_t lines) {
        ++report_.closed_surfaces;
        for (std::uint64_t i = 0; i < lines; ++i) {
            VerifyRays::Sample sample = rays.next();
            sample.ray.t_min = -std::numeric_limits<double>::infinity();
            ++report_.parity_lines;
            fast_hits_.clear();
            seen_by_.clear();
            surface.all_hits(sample.ray, fast_hits_, nullptr);
            if (fast_hits_.size() % 2 != 0) {
                ++report_.odd_crossings;
                report(sample, "parity", describe(fast_hits_), "an even number of crossings");
            }
        }
    }

  private:
    void disagree(const VerifyRays::Sample& sample, const char* query, std::string found,
                  std::string expected) {
        ++report_.disagreements;
        report(sample, query, std::move(found), std::move(expected));
    }
    void report(const VerifyRays::Sample& sample, const char* query, std::string found,
                std::string expected) {
        if (report_.reported.size() < options_.max_reported) {
            const std::string kind =
                seen_by_.empty() ? sample.kind : fmt::format("{} for {}", sample.kind, seen_by_);
            report_.reported.push_back(
                {kind, query, sample.ray, std::move(found), std::move(expected)});
        }
    }

    const VerifyOptions& options_;
    VerifyReport& report_;
    std::string seen_by_;  ///< kind of ray that is asked for; empty: all
    std::vector<Hit> fast_hits_, brute_hits_;
};

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
                         Verifier& verifier, VerifyReport& report) {
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
        verifier.count_crossings(*aggregate, rays, lines);
    }
}

/// Kinds of rays in turn; rays of one sort come every fourth time.
RayMask mask_of_ray(std::uint64_t i) {
    return mask_of(static_cast<RayKind>(i / 4 % kRayKindCount));
}

}  // namespace

VerifyReport verify(const SceneDescription& description, const VerifyOptions& options) {
    VerifyReport report;
    report.accelerator = options.accelerator;
    Verifier verifier(options, report);
    const Scene fast =
        compile(description,
                {.accelerator = options.accelerator, .csg = options.csg, .build = options.build});
    const Scene brute =
        compile(description,
                {.accelerator = "list", .csg = "roth", .build = {}, .own_accelerators = false});
    const Camera* camera =
        fast.cameras.empty() ? nullptr : &find_camera(fast, options.camera).camera;
    VerifyRays rays(fast.aggregate->box(), camera, fast.aggregate->primitives(), options.seed);
    for (std::uint64_t i = 0; i < options.rays; ++i) {
        verifier.compare(*fast.aggregate, *brute.aggregate, rays.next(),
                         fast.has_masks ? mask_of_ray(i) : kAllRays);
        if (options.progress != nullptr && i % 256 == 0) {
            options.progress->update("verify", i, options.rays);
        }
    }
    count_all_crossings(description, options, verifier, report);
    return report;
}

}  // namespace alhazen

#pragma once
/// Traces rays through geometry for programs that want hits and no renderer.
///
/// Conventions: points are origin + t * direction with t in [t_min, t_max]; the direction need not
/// be of unit length, and t is in units of it; it may be of any length that double holds
/// (geometry/ray_scale.h). An invalid ray (`is_valid`) hits nothing. A query
/// sees the geometry of which `visible_to` has a bit of its `mask`, through instances where that
/// holds for each of them too. Every accelerator gives the same hits, bit for bit. At equal t the
/// lower primitive wins: analytic shapes before triangles before instances, each kind in the order
/// in which it was added.
/// Complexity and threads: built in parallel, about O(n log n). Const functions may be called from
/// many threads at once, and give a batch to one thread each. A copy shares what was built.

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/accel/wide_bvh/build/build_options.h"
#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray.h"
#include "alhazen/primitives/aggregate.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/solids/spans.h"
#include "alhazen/tracer/tracer_scene.h"

namespace alhazen {

struct TracerOptions {
    /// One of `accelerator_table()`; another name throws Error (Usage) with the valid ones.
    std::string accelerator = kDefaultAccelerator;
    /// How much work goes into the build: {.build = {.quality = BuildQuality::High}}.
    BuildOptions build{};
};

/// What a `Hit` of a tracer means, in the coordinates of the tracer: the point, the normals, the
/// texture coordinates and what else a `Surface` holds. The materials in it mean nothing.
struct HitDetails : Surface {
    /// What was hit; inside of instances the id it has in the scene of the innermost.
    GeometryId geometry{};
    std::uint32_t primitive = 0;  ///< which triangle of a mesh; 0 of a shape
    /// The instances around it as ids, the outermost first; each in the scene of the one before.
    InlineVector<GeometryId, kMaxInstanceDepth> instances;
};

/// All hits of a batch of rays, ray after ray.
struct HitLists {
    std::vector<Hit> hits;
    std::vector<std::size_t> ends;  ///< [ray] where its hits end; they begin where those before end

    [[nodiscard]] std::span<const Hit> of(std::size_t ray) const {
        const std::size_t begin = ray == 0 ? 0 : ends[ray - 1];
        return std::span(hits).subspan(begin, ends[ray] - begin);
    }
};

class Tracer {
  public:
    /// Builds over all of the scene; it may be empty.
    explicit Tracer(TracerScene scene, const TracerOptions& options = {});
    /// With a tree that `save` stored for the same scene, mapped into memory instead of built. The
    /// hits are the same. Throws Error (File) when the file is damaged or of other geometry, or of
    /// another version of the library: then build. Instances are loaded or built on their own.
    [[nodiscard]] static Tracer load(TracerScene scene, const std::filesystem::path& file);
    /// Stores the tree, not the geometry, as one step. Throws Error: Usage for an accelerator other
    /// than `wide_bvh`, File when the file cannot be written.
    void save(const std::filesystem::path& file) const;

    /// The nearest hit: t, and u and v, the weights of the second and third vertex of a triangle or
    /// the parameters of a shape. True when there is one; else `hit.found()` is false.
    bool intersect(const Ray& ray, Hit& hit, RayMask mask = kAllRays) const;
    /// True when there is any hit: cheaper than the nearest one.
    [[nodiscard]] bool occluded(const Ray& ray, RayMask mask = kAllRays) const;
    /// Replaces `hits` by every hit, the nearest first.
    void all_hits(const Ray& ray, std::vector<Hit>& hits, RayMask mask = kAllRays) const;

    // ---- The same for many rays of any kind and in any order. From about ten rays on the first
    // two are faster than ray by ray. `coherence` says what is known of the rays
    // (primitives/aggregate.h): Coherent makes eye rays in tiles and shadow rays of a point light
    // faster, other rays slower, and changes no hit. Throws Error (Usage) where two spans differ
    // in length.
    void intersect(std::span<const Ray> rays, std::span<Hit> hits, RayMask mask = kAllRays,
                   Coherence coherence = Coherence::Any) const;
    void occluded(std::span<const Ray> rays, std::span<bool> occluded, RayMask mask = kAllRays,
                  Coherence coherence = Coherence::Any) const;
    void all_hits(std::span<const Ray> rays, HitLists& lists, RayMask mask = kAllRays) const;

    /// Where a hit of this very tracer lies and what it belongs to. `leaving_ray`
    /// (primitives/surface.h) begins the next ray there. Throws Error (Usage) when nothing was hit.
    [[nodiscard]] HitDetails details(const Ray& ray, const Hit& hit) const;

    /// Spans, thickness and points inside, of the geometry that bounds volumes. Finds out which
    /// does (a sort of the edges of every mesh): to be made once. Shares the geometry with the
    /// tracer.
    [[nodiscard]] SolidQueries solids() const { return SolidQueries(aggregate_); }

    /// Holds all geometry; empty for an empty scene, infinite with planes in it.
    [[nodiscard]] Box3 box() const { return aggregate_->box(); }
    [[nodiscard]] std::size_t geometry_count() const { return geometry_count_; }
    /// Bytes of the acceleration structure, without those of instanced tracers.
    [[nodiscard]] std::size_t memory_bytes() const { return aggregate_->memory_bytes(); }
    /// For code that counts steps or asks for more than this class offers. It takes directions as
    /// they are: of 2^-40 to 2^40 they give what this class gives.
    [[nodiscard]] const Aggregate& aggregate() const { return *aggregate_; }

  private:
    friend class TracerScene;
    Tracer(std::shared_ptr<const Aggregate> aggregate, std::size_t geometry_count,
           std::size_t depth)
        : aggregate_(std::move(aggregate)), geometry_count_(geometry_count), depth_(depth) {}

    void append_hits(const Ray& ray, std::vector<Hit>& hits, RayMask mask) const;

    std::shared_ptr<const Aggregate> aggregate_;
    std::size_t geometry_count_;
    std::size_t depth_;  ///< levels of instances
};

}  // namespace alhazen

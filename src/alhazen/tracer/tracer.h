#pragma once
/// Ray tracing without rendering: hits of rays on geometry.
///
/// Conventions: points are origin + t * direction with t in [t_min, t_max]; the direction need not
/// be normalised, t is in units of it; any length in the range of double is valid
/// (geometry/ray_scale.h). An invalid ray (`is_valid`) hits nothing. A query sees geometry whose
/// `visible_to` shares a bit with its `mask`; the same holds for each enclosing instance. All
/// accelerators give the same hits, bit for bit. At equal t the lower primitive wins: analytic
/// shapes before triangles before instances, each kind in the order of addition.
/// Complexity and threads: parallel build, about O(n log n). Const functions are thread-safe; a
/// batch runs on its calling thread. Copies share the acceleration structure.

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

struct Scene;

struct TracerOptions {
    /// A name of `accelerator_table()`; others throw Error (Usage) with the valid names.
    std::string accelerator = kDefaultAccelerator;
    /// Build effort: {.build = {.quality = BuildQuality::High}}.
    BuildOptions build{};
};

/// The geometry of a `Hit` in tracer coordinates: point, normals, texture coordinates and the other
/// members of `Surface`. Its materials are unused.
struct HitDetails : Surface {
    /// The geometry hit; within instances, its id in the scene of the innermost one.
    GeometryId geometry{};
    std::uint32_t primitive = 0;  ///< triangle of a mesh; 0 for a shape
    /// Ids of the enclosing instances, outermost first; each in the scene of the previous one.
    InlineVector<GeometryId, kMaxInstanceDepth> instances;
};

/// What was hit, without its surface.
struct HitIds {
    GeometryId geometry{};        ///< as HitDetails::geometry
    std::uint32_t primitive = 0;  ///< triangle of a mesh; 0 for a shape
    GeometryId outermost{};       ///< the outermost instance around it, or the geometry itself
};

/// All hits of a batch of rays, in the order of the rays.
struct HitLists {
    std::vector<Hit> hits;
    std::vector<std::size_t> ends;  ///< [ray] end of its hits; they begin at the previous end

    [[nodiscard]] std::span<const Hit> of(std::size_t ray) const {
        const std::size_t begin = ray == 0 ? 0 : ends[ray - 1];
        return std::span(hits).subspan(begin, ends[ray] - begin);
    }
};

class Tracer {
  public:
    /// Builds over the whole scene, which may be empty.
    explicit Tracer(TracerScene scene, const TracerOptions& options = {});
    /// Maps a tree stored by `save` for the same scene into memory instead of building it. The hits
    /// are the same. Throws Error (File) when the file is damaged, of other geometry or of another
    /// library version; build instead. Instances are loaded or built separately.
    [[nodiscard]] static Tracer load(TracerScene scene, const std::filesystem::path& file);
    /// Stores the tree, not the geometry, atomically. Throws Error: Usage for an accelerator other
    /// than `wide_bvh`, File when the file cannot be written.
    void save(const std::filesystem::path& file) const;

    /// Traces a compiled scene that has its aggregate; geometry is numbered by the parts of its
    /// description (Surface::part). Moving parts are where they are as the shutter opens.
    [[nodiscard]] static Tracer of(const Scene& scene);

    /// Finds the nearest hit: t, u and v (the weights of the second and third vertex of a triangle,
    /// or the parameters of a shape). True on a hit; otherwise `hit.found()` is false.
    bool intersect(const Ray& ray, Hit& hit, RayMask mask = kAllRays) const;
    /// True when there is any hit; cheaper than the nearest hit.
    [[nodiscard]] bool occluded(const Ray& ray, RayMask mask = kAllRays) const;
    /// Replaces `hits` by all hits, nearest first.
    void all_hits(const Ray& ray, std::vector<Hit>& hits, RayMask mask = kAllRays) const;

    // --- Batches: many rays of any kind in any order. `intersect` and `occluded` are faster than
    // single rays from about ten rays on. `coherence` describes the rays (primitives/aggregate.h):
    // Coherent speeds up eye rays in tiles and shadow rays of a point light, slows down other rays,
    // and changes no hit. Throws Error (Usage) when two spans differ in length.
    void intersect(std::span<const Ray> rays, std::span<Hit> hits, RayMask mask = kAllRays,
                   Coherence coherence = Coherence::Any) const;
    void occluded(std::span<const Ray> rays, std::span<bool> occluded, RayMask mask = kAllRays,
                  Coherence coherence = Coherence::Any) const;
    void all_hits(std::span<const Ray> rays, HitLists& lists, RayMask mask = kAllRays) const;

    /// Names what was hit: cheaper than `details`. Throws Error (Usage) without a hit.
    [[nodiscard]] HitIds ids(const Hit& hit) const;
    /// The surface at a hit of this tracer. `leaving_ray` (primitives/surface.h) starts the next
    /// ray there. Throws Error (Usage) without a hit.
    [[nodiscard]] HitDetails details(const Ray& ray, const Hit& hit) const;

    /// The surface alone, into `surface`, which is large and not copied; without texture
    /// coordinates. Precondition: a hit of this tracer.
    void surface(const Ray& ray, const Hit& hit, Surface& surface) const;

    /// The normal of the surface alone, the same bits as `surface` gives; cheap for triangles that
    /// lie in no instance. Precondition: a hit of this tracer. `scratch` is left unspecified.
    [[nodiscard]] Vec3 normal(const Ray& ray, const Hit& hit, Surface& scratch) const;

    /// Spans, thickness and containment queries for geometry that bounds volumes. Creation tests
    /// which geometry does (a sort of the edges of every mesh): create once. Shares the geometry
    /// with the tracer.
    [[nodiscard]] SolidQueries solids() const { return SolidQueries(aggregate_); }

    /// Bounds all geometry; empty for an empty scene, infinite with planes.
    [[nodiscard]] Box3 box() const { return aggregate_->box(); }
    /// Calls that added geometry; of a compiled scene the shapes and triangles stored.
    [[nodiscard]] std::size_t geometry_count() const { return geometry_count_; }
    /// Bytes of the acceleration structure, excluding instanced tracers.
    [[nodiscard]] std::size_t memory_bytes() const { return aggregate_->memory_bytes(); }
    /// For step counts and queries beyond this class. Takes directions unscaled: lengths of 2^-40
    /// to 2^40 give the results of this class.
    [[nodiscard]] const Aggregate& aggregate() const { return *aggregate_; }

  private:
    friend class TracerScene;
    Tracer(std::shared_ptr<const Aggregate> aggregate, std::size_t geometry_count,
           std::size_t depth)
        : aggregate_(std::move(aggregate)), geometry_count_(geometry_count), depth_(depth) {}

    void append_hits(const Ray& ray, std::vector<Hit>& hits, RayMask mask) const;

    std::shared_ptr<const Aggregate> aggregate_;
    std::size_t geometry_count_;
    std::size_t depth_;  ///< levels of instancing
};

}  // namespace alhazen

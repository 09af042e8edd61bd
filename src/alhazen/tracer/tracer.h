#pragma once
/// Ray tracing without rendering: hits of rays on geometry.
///
/// Conventions: points are origin + t * direction with t in [t_min, t_max]; the direction need not
/// be normalised, t is in units of it; any length in the range of double is valid
/// (geometry/ray_scale.h). An invalid ray (`is_valid`) hits nothing. A query sees geometry whose
/// `visible_to` shares a bit with its `mask`; the same holds for each enclosing instance. All
/// accelerators give the same hits, bit for bit. At equal t the lower primitive wins: analytic
/// shapes (by type, in the order of shapes/shape_list.h) before triangles before instances, each
/// type in the order of addition.
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
#include "alhazen/geometry/ray_columns.h"
#include "alhazen/primitives/aggregate.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/solids/spans.h"
#include "alhazen/tracer/tracer_scene.h"

namespace alhazen {

struct Scene;

struct TracerOptions {
    /// A name of `accelerator_table()`; other names throw Error (Usage) with the valid ones.
    std::string accelerator = kDefaultAccelerator;
    /// Build effort: {.build = {.quality = BuildQuality::High}}.
    BuildOptions build{};
};

/// The geometry of a `Hit` in tracer coordinates: the members of `Surface`; materials are unused.
struct HitDetails : Surface {
    /// The geometry hit; inside instances, its id in the scene of the innermost one.
    GeometryId geometry{};
    std::uint32_t primitive = 0;  ///< triangle of a mesh; 0 for a shape
    /// Enclosing instances, outermost first; each id is in the scene of the previous instance.
    InlineVector<GeometryId, kMaxInstanceDepth> instances;
};

/// The ids of a hit, without its surface.
struct HitIds {
    GeometryId geometry{};        ///< as HitDetails::geometry
    std::uint32_t primitive = 0;  ///< triangle of a mesh; 0 for a shape
    GeometryId outermost{};       ///< the outermost enclosing instance, or the geometry itself
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

/// Where the nearest hits of rays in columns are written. Empty columns are not.
struct TracedColumns {
    std::span<double> t{};                 ///< infinite without a hit
    std::span<double> u{}, v{};            ///< as in Hit; 0 without a hit
    std::span<GeometryId> geometry{};      ///< as HitIds::geometry; kNoGeometry without a hit
    std::span<std::uint32_t> primitive{};  ///< as HitIds::primitive
    std::span<GeometryId> outermost{};     ///< as HitIds::outermost
};
/// The ids of rays without a hit in columns.
inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFu;
inline constexpr GeometryId kNoGeometry{kNoTriangle};

class Tracer {
  public:
    /// Builds over the whole scene, which may be empty.
    explicit Tracer(TracerScene scene, const TracerOptions& options = {});
    /// Maps a tree stored by `save` for the same scene into memory instead of building it. The hits
    /// are the same, as is the precision. Throws Error (File) when the file is damaged, belongs to
    /// other geometry or comes from another library version. Instances are loaded or built
    /// separately.
    [[nodiscard]] static Tracer load(TracerScene scene, const std::filesystem::path& file);
    /// Stores the tree, not the geometry, atomically. Throws Error: Usage for an accelerator other
    /// than `wide_bvh`, File when the file cannot be written.
    void save(const std::filesystem::path& file) const;

    /// Traces a compiled scene that has its aggregate. Geometry ids are the parts of its
    /// description (Surface::part). Moving parts have their placement as the shutter opens.
    [[nodiscard]] static Tracer of(const Scene& scene);

    /// Finds the nearest hit: t, u and v (the weights of the second and third vertex of a triangle,
    /// or the parameters of a shape). True on a hit; otherwise `hit.found()` is false.
    bool intersect(const Ray& ray, Hit& hit, RayMask mask = kAllRays) const;
    /// True if there is any hit; faster than the nearest hit.
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

    // --- Batches of rays in float, in columns (geometry/ray_columns.h). The hits are those of the
    // same numbers in double. Coherent rays are read in place, and their hits written once. Throws
    // Error (Usage) when a column is neither empty nor as long as the directions.
    void intersect(const RayColumns& rays, const TracedColumns& hits, RayMask mask = kAllRays,
                   Coherence coherence = Coherence::Any) const;
    void occluded(const RayColumns& rays, std::span<bool> occluded, RayMask mask = kAllRays,
                  Coherence coherence = Coherence::Any) const;

    /// The ids of the geometry hit; faster than `details`. Throws Error (Usage) without a hit.
    [[nodiscard]] HitIds ids(const Hit& hit) const;
    /// The surface at a hit of this tracer. `leaving_ray` (primitives/surface.h) starts the next
    /// ray there. Throws Error (Usage) without a hit. A hit whose t has left the range of double,
    /// of a very short or long direction, is found again; where t is that of several crossings of
    /// the primitive, the point is the nearest and the bound of its error covers all.
    [[nodiscard]] HitDetails details(const Ray& ray, const Hit& hit) const;

    /// Writes the surface without texture coordinates into `surface`, as the type is large.
    /// Precondition: a hit of this tracer.
    void surface(const Ray& ray, const Hit& hit, Surface& surface) const;

    /// The normal alone, bit-identical to that of `surface`; fast for triangles outside instances.
    /// Precondition: a hit of this tracer. `scratch` is left unspecified.
    [[nodiscard]] Vec3 normal(const Ray& ray, const Hit& hit, Surface& scratch) const;

    /// Span, thickness and containment queries for geometry that bounds volumes. Creation tests
    /// which geometry does (it sorts the edges of every mesh): create once. Shares the geometry
    /// with the tracer.
    [[nodiscard]] SolidQueries solids() const { return SolidQueries(aggregate_); }

    /// The bounds of all geometry; empty for an empty scene, infinite with planes.
    [[nodiscard]] Box3 box() const { return aggregate_->box(); }
    /// The number of calls that added geometry; for a compiled scene, of shapes and triangles
    /// stored.
    [[nodiscard]] std::size_t geometry_count() const { return geometry_count_; }
    /// Bytes of the acceleration structure, without instanced tracers.
    [[nodiscard]] std::size_t memory_bytes() const { return aggregate_->memory_bytes(); }
    /// For step counts and queries beyond this class. Rays are not rescaled: direction lengths of
    /// 2^-40 to 2^40 give the results of this class.
    [[nodiscard]] const Aggregate& aggregate() const { return *aggregate_; }

  private:
    friend class TracerScene;
    Tracer(std::shared_ptr<const Aggregate> aggregate, std::size_t geometry_count,
           std::size_t depth)
        : aggregate_(std::move(aggregate)), geometry_count_(geometry_count), depth_(depth) {}

    /// Of rays whose directions have usual lengths, in a scene without instances.
    void intersect_usual(const RayColumns& rays, const TracedColumns& hits, RayMask mask,
                         Coherence coherence) const;
    /// Writes the ids of a hit, where they are wanted.
    void set_ids(const TracedColumns& hits, std::size_t i, const Hit& hit) const;
    void append_hits(const Ray& ray, std::vector<Hit>& hits, RayMask mask) const;

    std::shared_ptr<const Aggregate> aggregate_;
    std::size_t geometry_count_;
    std::size_t depth_;  ///< levels of instancing
};

}  // namespace alhazen

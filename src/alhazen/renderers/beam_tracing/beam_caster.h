#pragma once
/// What a beam sees, and what of it a light reaches, as polygons of the picture window.
///
/// Source: Heckbert and Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984 (what is visible
/// is cut out of the beam, the rest goes on); Atherton, Weiler and Greenberg, "Polygon Shadow
/// Generation", SIGGRAPH 1978 (the view from the light divides surfaces into lit and unlit parts).
/// Differs: an occluder is projected from the light to the plane of the surface and from there into
/// the window, in one linear map, so that shadows, too, are cut in the window. A beam whose rest
/// has many corners is divided in two, each with its own place in the tree. What is left of a beam
/// but thinner than the lattice belongs to the piece that it was cut off.
/// Conventions: the window is the lattice of polygon_sets; the film reaches kBeamFilm from its
/// middle. Threads: used by one thread; memory is kept.

#include <functional>

#include "alhazen/geometry/facets/depth_order.h"
#include "alhazen/geometry/polygon_sets/set_operations.h"
#include "alhazen/geometry/ray_mask.h"
#include "alhazen/renderers/beam_tracing/beam_scene.h"

namespace alhazen {

/// Lattice units from the middle of the film to its edges.
inline constexpr double kBeamFilm = 16'777'000;

inline constexpr std::uint32_t kNoFacet = 0xFFFFFFFFu;

struct BeamView {
    BeamProjection projection;
    BeamApex apex;  ///< in the space of the scene
    RayKind kind = RayKind::Eye;
    std::uint32_t from = kNoFacet;  ///< the facet that it leaves
    bool has_start = false;
    FacetPlane start{{}, 0};  ///< with `has_start`: only what lies before it is seen
};

struct SeenFacet {
    std::uint32_t facet = kNoFacet;  ///< kNoFacet: nothing
    PolygonSet region;
};

/// A part of a piece that light reaches.
struct LitPart {
    PolygonSet region;
    std::vector<std::uint32_t> through;  ///< facets that let light through, in any order
};

struct BeamCounts {
    std::uint64_t beams = 0, shadow_beams = 0;
    std::uint64_t pieces = 0;
    std::uint64_t cuts = 0;        ///< set operations
    FacetWalkCounts seen, shadow;  ///< of the tree

    BeamCounts& operator+=(const BeamCounts& other);
};

struct BeamCastOptions {
    bool hulls = true;  ///< leave subtrees whose hull the beam misses
    bool tree = true;   ///< false: each beam sorts all polygons by depth
};

class BeamCaster {
  public:
    /// The scene must outlive the object.
    BeamCaster(const BeamScene& scene, const BeamCastOptions& options)
        : scene_(scene), options_(options) {}

    /// Appends the pieces of `region`, nearest first; then what is left of it. They add up to
    /// `region` without gap and overlap, and its area exactly where it is a rectangle.
    void see(const BeamView& view, PolygonSet region, std::vector<SeenFacet>& result);

    /// The parts of a piece of `facet` that the light reaches; `opaque`: everything blocks it.
    [[nodiscard]] std::vector<LitPart> lit(const BeamView& view, const SeenFacet& piece,
                                           const BeamApex& light, bool opaque);

    [[nodiscard]] const BeamCounts& counts() const { return counts_; }

  private:
    /// The order of the polygons, and the place in it.
    struct Order {
        FacetWalk walk;
        std::size_t next = 0;  ///< in `list_`
    };
    struct Rest {
        PolygonSet region;
        Order order;
    };

    /// Makes pieces a partition of `whole`.
    void fit_together(const PolygonSet& whole, std::span<SeenFacet> pieces);
    void see_rest(const BeamView& view, Rest& rest, std::vector<Rest>& waiting,
                  std::vector<SeenFacet>& result);
    [[nodiscard]] std::span<const FacetPiece> next(Order& order, const BeamSides& sides);
    [[nodiscard]] bool is_seen(const BeamView& view, std::uint32_t facet) const;
    /// The piece in the window; false where nothing of it is there.
    [[nodiscard]] bool project(const BeamProjection& projection, std::span<const Vec3> corners,
                               PolygonSet& result);
    /// Planes through the apex around a region, after `limits_`.
    void set_sides(const BeamProjection& projection, const PolygonSet& region);
    /// Those of its convex hull; false where that has too many edges.
    [[nodiscard]] bool set_hull_sides(const BeamProjection& projection, const PolygonSet& region);
    void take_slivers(PolygonCut& parts);
    /// Moves a half of a region with many corners to the end of `waiting`.
    void divide(Rest& rest, std::vector<Rest>& waiting);
    void darken(const PolygonSet& shadow, std::uint32_t facet, bool opaque,
                std::vector<LitPart>& parts);

    const BeamScene& scene_;
    BeamCastOptions options_;
    BeamCounts counts_;
    BeamSides limits_;  ///< the planes that the beam begins and ends at
    BeamSides sides_;   ///< all its planes
    std::vector<FacetPiece> list_;
    FacetPool list_pool_;
    std::vector<Vec3> loop_, clipped_;
    std::vector<LatticePoint> flat_, hull_;
    PolygonSet shape_;
    PolygonCut cut_;
    std::vector<PolygonSet> parts_;
};

}  // namespace alhazen

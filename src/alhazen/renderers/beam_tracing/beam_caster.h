#pragma once
/// The facets visible in a beam, and the parts of them that a light reaches, as polygons in the
/// picture window.
///
/// Source: Heckbert and Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984 (visible facets
/// are cut out of the beam, the remainder continues); Atherton, Weiler and Greenberg, "Polygon
/// Shadow Generation", SIGGRAPH 1978 (the view from the light divides surfaces into lit and unlit
/// parts).
/// Differs: an occluder is projected from the light to the plane of the surface and from there into
/// the window, by one linear map, so that shadows, too, are cut in the window. A beam whose
/// remainder has many corners is divided in two, each with its own traversal state. Remainders
/// thinner than the lattice are added to the piece from which they were cut off.
/// Conventions: the window is the lattice of polygon_sets; the film extends to kBeamFilm from its
/// middle. Threads: used by one thread; memory is reused.

#include <functional>

#include "alhazen/geometry/facets/depth_order.h"
#include "alhazen/geometry/polygon_sets/set_operations.h"
#include "alhazen/geometry/ray_mask.h"
#include "alhazen/renderers/beam_tracing/beam_scene.h"
#include "alhazen/renderers/beam_tracing/box_index.h"

namespace alhazen {

/// Lattice units from the middle of the film to its edges.
inline constexpr double kBeamFilm = 16'777'000;

inline constexpr std::uint32_t kNoFacet = 0xFFFFFFFFu;

struct BeamView {
    BeamProjection projection;
    BeamApex apex;  ///< in world space
    RayKind kind = RayKind::Eye;
    std::uint32_t from = kNoFacet;  ///< the facet where the beam starts
    bool has_start = false;
    FacetPlane start{{}, 0};  ///< if `has_start`: only facets in front of it are visible
};

struct SeenFacet {
    std::uint32_t facet = kNoFacet;  ///< kNoFacet: nothing
    PolygonSet region;
};

/// A part of a piece that the light reaches.
struct LitPart {
    PolygonSet region;
    std::vector<std::uint32_t> through;  ///< facets that transmit the light, in any order
};

struct BeamCounts {
    std::uint64_t beams = 0, shadow_beams = 0;
    std::uint64_t pieces = 0;
    std::uint64_t cuts = 0;        ///< set operations
    FacetWalkCounts seen, shadow;  ///< traversals of the tree

    BeamCounts& operator+=(const BeamCounts& other);
};

struct BeamCastOptions {
    bool hulls = true;  ///< prune subtrees whose hull the beam misses
    bool tree = true;   ///< false: each beam sorts all polygons by depth
    /// Number of lit parts of a piece from which on shadows of transparent facets do not divide
    /// them: a part that is mostly in such a shadow is behind the facet as a whole. 0: no limit.
    std::size_t most_parts = 0;
};

class BeamCaster {
  public:
    /// The scene must outlive the object.
    BeamCaster(const BeamScene& scene, const BeamCastOptions& options)
        : scene_(scene), options_(options) {}

    /// Appends the visible pieces of `region`, nearest first, and then the remainder. Together they
    /// cover `region` without gap and overlap; the total area is exact if it is a rectangle.
    void see(const BeamView& view, PolygonSet region, std::vector<SeenFacet>& result);

    /// The parts of a piece of `facet` that the light reaches; `opaque`: all facets block it.
    [[nodiscard]] std::vector<LitPart> lit(const BeamView& view, const SeenFacet& piece,
                                           const BeamApex& light, bool opaque);

    [[nodiscard]] const BeamCounts& counts() const { return counts_; }

  private:
    /// A position in the front-to-back order of the polygons.
    struct Order {
        FacetWalk walk;
        std::size_t next = 0;  ///< in `list_`
    };
    struct Rest {
        PolygonSet region;
        Order order;
    };

    /// Makes the pieces a partition of `whole`.
    void fit_together(const PolygonSet& whole, std::span<SeenFacet> pieces);
    void see_rest(const BeamView& view, Rest& rest, std::vector<Rest>& waiting,
                  std::vector<SeenFacet>& result);
    [[nodiscard]] std::span<const FacetPiece> next(Order& order, const BeamSides& sides);
    [[nodiscard]] bool is_seen(const BeamView& view, std::uint32_t facet) const;
    /// Projects a piece to the window; false if nothing of it is visible.
    [[nodiscard]] bool project(const BeamProjection& projection, std::span<const Vec3> corners,
                               PolygonSet& result);
    /// Sets the planes through the apex around a region, after `limits_`.
    void set_sides(const BeamProjection& projection, const PolygonSet& region);
    /// Sets those of its convex hull; false if the hull has too many edges.
    [[nodiscard]] bool set_hull_sides(const BeamProjection& projection, const PolygonSet& region);
    void take_slivers(PolygonCut& parts);
    /// Moves a half of a region with many corners to the end of `waiting`.
    void divide(Rest& rest, std::vector<Rest>& waiting);
    /// Cuts a shadow out of `parts`, which may become empty; `part_boxes_` has their boxes.
    void darken(const PolygonSet& shadow, std::uint32_t facet, bool opaque,
                std::vector<LitPart>& parts);

    const BeamScene& scene_;
    BeamCastOptions options_;
    BeamCounts counts_;
    BeamSides limits_;  ///< the planes where the beam begins and ends
    BeamSides sides_;   ///< all its planes
    std::vector<FacetPiece> list_;
    FacetPool list_pool_;
    std::vector<Vec3> loop_, clipped_;
    std::vector<LatticePoint> flat_, hull_;
    PolygonSet shape_;
    PolygonCut cut_;
    std::vector<PolygonSet> parts_;
    BoxIndex part_boxes_;
    std::size_t lit_parts_ = 0;  ///< parts that are not empty
};

}  // namespace alhazen

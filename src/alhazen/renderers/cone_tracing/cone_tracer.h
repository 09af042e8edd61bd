#pragma once
/// The radiance along a cone: visible pieces, their shading, and the reflected, refracted and
/// shadow cones from them.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, sections 3 to 5.
/// Differs: shading is that of `whitted` (local_shading.h), by the conventions of the scene. A
/// light without extent is seen from the whole footprint of a piece: the shadow cone starts with
/// the width of the piece and ends in the light, so that edges of shadows are as smooth as those of
/// objects.
/// Conventions: as in Whitted. Threads: used by one thread; memory is reused.

#include <deque>
#include <optional>

#include "alhazen/geometry/cones/wavefront_curvature.h"
#include "alhazen/renderers/cone_tracing/cone_pieces.h"
#include "alhazen/renderers/core/aov_geometry.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/core/tinted_media.h"
#include "alhazen/renderers/volumes/touching_faces.h"

namespace alhazen {

/// The history of a cone.
struct ConePath {
    ConeStart start;
    bool inside = false;        ///< starts inside a transparent object
    Rgb contribution{1, 1, 1};  ///< product of the coefficients along the path
    Rgb absorption;             ///< absorption of the medium it starts in
    std::uint32_t medium = 0;   ///< of TintedMedia
};

/// Identifies one of the cones to a light: a large piece has several.
struct ConeToLight {
    std::size_t light = 0;  ///< index in Scene::lights
    int part = 0, parts = 1;
    double weight = 1;  ///< weight of the part of the piece
};

/// Observer of traced cones, called in order: a piece is shaded between `begin_piece` and
/// `end_piece`, and cones that leave it are reported in between.
class ConeWatcher {
  public:
    virtual ~ConeWatcher() = default;
    /// `cone`: the narrowed cone that was searched, a part of `whole`.
    virtual void begin_cone(const ConeRay& whole, const ConeRay& cone, const ConePath& path,
                            int depth) = 0;
    /// `weight`: share of the cone; `radius`: of the piece.
    virtual void begin_piece(const ConePiece& piece, double weight, double radius, double t,
                             const ShadingPoint& point) = 0;
    virtual void end_piece(const Rgb& color) = 0;
    /// `left`: share of the cone that nothing covers.
    virtual void end_cone(double left, const Rgb& radiance) = 0;
    /// A shadow cone of a part of the piece; `distance`: of the light.
    virtual void shadow_cone(const ConeRay& cone, double distance, const Rgb& through,
                             const ConeToLight& to) = 0;
};

/// The cone with half the width.
[[nodiscard]] inline ConeRay narrowed(const ConeRay& cone) {
    return {cone.origin, cone.axis, 0.5 * cone.radius, 0.5 * cone.spread};
}

class ConeTracer {
  public:
    /// All arguments must outlive the object.
    ConeTracer(const RenderJob& job, const ConeScene& scene, bool tables, RayCounters& counters);

    /// A cone from the eye, which may lie inside solids. `geometry`: as of `trace`.
    [[nodiscard]] Rgb trace_eye(const ConeRay& cone, PixelGeometry* geometry = nullptr);
    /// `geometry` receives the geometry of the piece with the largest share; may be null.
    [[nodiscard]] Rgb trace(const ConeRay& cone, const ConePath& path, int depth,
                            PixelGeometry* geometry = nullptr);
    /// Transmittance of a cone towards a light, which lies beyond `start.range.z_max`. `from`: the
    /// path of the cone that met the surface; null: the start is in air.
    [[nodiscard]] Rgb let_through(const ConeRay& cone, const ConeStart& start,
                                  const ConeToLight& to = {}, const ConePath* from = nullptr);
    /// Sets an observer, or null; it must outlive the calls of `trace`.
    void set_watcher(ConeWatcher* watcher) { watcher_ = watcher; }

  private:
    /// A piece at which shading takes place.
    struct Seen {
        const ConePiece& piece;
        const ConeRay& cone;
        const ConePath& path;
        Ray ray;            ///< through the middle of the piece
        double t = 0;       ///< along `ray`
        double radius = 0;  ///< radius of a disc of the piece's size, perpendicular to the cone
        int depth = 0;
    };

    [[nodiscard]] Seen seen_at(const ConePiece& piece, const ConeRay& cone, const ConePath& path,
                               int depth) const;
    /// What a piece lets through of the light.
    struct PieceInShadow {
        double coverage = 1;
        Rgb tint;  ///< of the covered points
    };
    /// What a shadow cone has crossed.
    struct Crossed {
        double last = 0;      ///< distance of the last crossing
        bool within = false;  ///< none led out of the volume around the start
    };
    /// Where a shadow cone leaves the volumes around its start.
    enum class Way : std::uint8_t { Clear, ToWall, ToLight };
    struct LightInside {
        std::uint32_t source;
        bool inside;
    };
    /// A cone that meets more pieces is narrowed.
    static constexpr int kMostPieces = 192;
    static constexpr int kMostNarrowings = 16;  ///< afterwards the nearest pieces are taken
    /// `meets_backs`: as in Arrival.
    void set_point(const Seen& seen, ShadingPoint& point, bool meets_backs,
                   SurfaceOptics* optics = nullptr) const;
    /// The piece of another closed source at the place of one, where `to_wall` meets its boundary.
    [[nodiscard]] std::optional<ConePiece> piece_at(const Seen& seen, std::uint32_t source,
                                                    const Ray& to_wall) const;
    /// Joins the faces of other solids at a completed point with it; an opaque one replaces it.
    void join_touching(const Seen& seen, ShadingPoint& point);
    [[nodiscard]] SurfaceShare share_of(const ConePiece& piece, const ConeStart& start) const;
    /// Gathers the visible pieces and the remainder of the cone. False if there are too many.
    [[nodiscard]] bool gather(const ConeRay& cone, const ConePath& path, int depth,
                              std::vector<SeenPiece>& pieces, double& left);
    /// Computes the transmittance; false as in `gather`.
    [[nodiscard]] bool find_blocked(const ConeRay& cone, const ConeStart& start, Rgb& result);
    [[nodiscard]] double least_contribution() const;
    [[nodiscard]] Rgb color_of(const Seen& seen, const ShadingPoint& point);
    [[nodiscard]] Rgb direct_light(const Seen& seen, const ShadingPoint& point);
    [[nodiscard]] Rgb shadow_at(const Seen& seen, const ShadingPoint& point, std::size_t number,
                                const LightSample& light, double light_radius);
    [[nodiscard]] Rgb reflected(const Seen& seen, const ShadingPoint& point);
    [[nodiscard]] Rgb transmitted(const Seen& seen, const ShadingPoint& point);
    void begin_way(const ConeRay& cone, const ConeStart& start, const ConePath* from);
    /// Sets what a piece lets through. False if it is not met.
    [[nodiscard]] bool cross_piece(const ConePiece& piece, const ConeRay& cone,
                                   const ConeStart& start, Crossed& crossed, PieceInShadow& met);
    /// The length of the line of a piece in a sphere that it enters.
    [[nodiscard]] static double chord_of(const Seen& seen, const ConeSource& source) {
        return 2.0 * std::abs(dot(seen.ray.at(seen.t) - source.point, seen.ray.direction));
    }
    [[nodiscard]] Rgb passing_far_wall(const Seen& seen, const ConeSource& source) const;
    [[nodiscard]] double length_behind(const Seen& seen, const ConeSource& source, double t_light,
                                       bool ends_inside) const;
    [[nodiscard]] double length_before(const Seen& seen, const ConeSource& source,
                                       const ConeStart& start) const;
    [[nodiscard]] bool light_is_inside(std::uint32_t number, const ConeRay& cone,
                                       const ConeStart& start);
    /// The history of a cone that leaves the piece; the caller sets its kind and contribution.
    [[nodiscard]] ConePath onward(const Seen& seen, const ShadingPoint& point,
                                  const ConeRay& cone) const;
    [[nodiscard]] bool refracts(const ShadingPoint& point, const Ray& ray, double& eta,
                                Vec3& direction) const;
    [[nodiscard]] SectionCurvatures curvatures(const Seen& seen, const ShadingPoint& point) const;

    const RenderJob& job_;
    const Scene& scene_;
    const ShadingConventions& conventions_;
    const ConeScene& geometry_;
    RayCounters& counters_;
    const std::vector<Rgb> ambient_;
    const DepthScale depth_;
    ConeSearch search_;
    TintedMedia tinted_;
    TouchingFaces touching_;                   ///< at the last piece
    CrossedVolumes volumes_;                   ///< around the start of a shadow cone
    Way way_ = Way::Clear;                     ///< of the shadow cone
    std::optional<LightInside> light_inside_;  ///< the last answer, for one shadow cone
    ConeWatcher* watcher_ = nullptr;
    std::optional<Vec3> eye_;                    ///< of the last cone from the eye
    ConePath eye_path_;                          ///< its path
    std::deque<std::vector<SeenPiece>> frames_;  ///< by depth of recursion
};

}  // namespace alhazen

#pragma once
/// The radiance along a cone: what it sees, shaded where each piece is; reflected, refracted and
/// shadow cones from there.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, sections 3 to 5.
/// Differs: shading is that of `whitted` (local_shading.h), by the conventions of the scene. A
/// light without extent is seen from the whole footprint of a piece: the shadow cone begins as wide
/// as the piece and ends in the light, so edges of shadows are as smooth as those of objects.
/// Conventions: as in Whitted. Threads: used by one thread; memory is kept.

#include <deque>

#include "alhazen/geometry/cones/wavefront_curvature.h"
#include "alhazen/renderers/cone_tracing/cone_pieces.h"
#include "alhazen/renderers/core/aov_geometry.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

/// The history of a cone.
struct ConePath {
    ConeStart start;
    bool inside = false;        ///< it starts inside something transparent
    Rgb contribution{1, 1, 1};  ///< product of the coefficients along the path
    Rgb absorption;             ///< of the medium it starts in
};

/// Which of the cones to a light this is: a large piece is asked in parts.
struct ConeToLight {
    std::size_t light = 0;  ///< of Scene::lights
    int part = 0, parts = 1;
    double weight = 1;  ///< of the part
};

/// Watches cones while they are traced, in the order of the calls: a piece is shaded between
/// `begin_piece` and `end_piece`, with the cones that leave it in between.
class ConeWatcher {
  public:
    virtual ~ConeWatcher() = default;
    /// `cone`: as wide as was searched, of `whole`.
    virtual void begin_cone(const ConeRay& whole, const ConeRay& cone, const ConePath& path,
                            int depth) = 0;
    /// `weight`: of the cone; `radius`: of the piece.
    virtual void begin_piece(const ConePiece& piece, double weight, double radius, double t,
                             const ShadingPoint& point) = 0;
    virtual void end_piece(const Rgb& color) = 0;
    /// `left`: of the cone, what nothing covers.
    virtual void end_cone(double left, const Rgb& radiance) = 0;
    /// A cone of a part of the piece; `distance`: of the light.
    virtual void shadow_cone(const ConeRay& cone, double distance, const Rgb& through,
                             const ConeToLight& to) = 0;
};

/// The cone from a point that just holds a sphere of light.
[[nodiscard]] ConeRay cone_to_light(const Vec3& point, const Vec3& center, double radius);

class ConeTracer {
  public:
    /// All must outlive the object.
    ConeTracer(const RenderJob& job, const ConeScene& scene, bool tables, RayCounters& counters);

    /// `geometry`: gets what most of the cone shows; may be null.
    [[nodiscard]] Rgb trace(const ConeRay& cone, const ConePath& path, int depth,
                            PixelGeometry* geometry = nullptr);
    /// What is left of the light that comes down a cone. The light beyond `start.range.z_max`.
    [[nodiscard]] Rgb let_through(const ConeRay& cone, const ConeStart& start,
                                  const ConeToLight& to = {});
    /// May be null; must outlive the calls of `trace`.
    void set_watcher(ConeWatcher* watcher) { watcher_ = watcher; }

  private:
    /// A piece where it is shaded.
    struct Seen {
        const ConePiece& piece;
        const ConeRay& cone;
        const ConePath& path;
        Ray ray;            ///< through the middle of the piece
        double t = 0;       ///< along `ray`
        double radius = 0;  ///< of the piece: of a disc of its size across the cone
        int depth = 0;
    };

    [[nodiscard]] Seen seen_at(const ConePiece& piece, const ConeRay& cone, const ConePath& path,
                               int depth) const;
    void set_point(const Seen& seen, ShadingPoint& point);
    /// Gathers what the cone sees, and what is left of it. False where that is too much.
    [[nodiscard]] bool gather(const ConeRay& cone, const ConePath& path, int depth,
                              std::vector<SeenPiece>& pieces, double& left);
    /// What is left of the light; false as before.
    [[nodiscard]] bool find_blocked(const ConeRay& cone, const ConeStart& start, Rgb& result);
    [[nodiscard]] double least_contribution() const;
    [[nodiscard]] Rgb color_of(const Seen& seen, const ShadingPoint& point);
    [[nodiscard]] Rgb direct_light(const Seen& seen, const ShadingPoint& point);
    [[nodiscard]] Rgb shadow_at(const Seen& seen, const ShadingPoint& point, std::size_t number,
                                const LightSample& light, double light_radius);
    [[nodiscard]] Rgb reflected(const Seen& seen, const ShadingPoint& point);
    [[nodiscard]] Rgb transmitted(const Seen& seen, const ShadingPoint& point);
    [[nodiscard]] Rgb transmittance_of(const ConePiece& piece, const ConeRay& cone,
                                       const ConeStart& start, double& share);
    /// The history of a cone that leaves the piece; the caller adds its kind and contribution.
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
    ConeWatcher* watcher_ = nullptr;
    std::deque<std::vector<SeenPiece>> frames_;  ///< by depth
};

}  // namespace alhazen

#pragma once
/// Shades points of the pieces of a tree of beams, as `whitted` does.
///
/// Source: Heckbert and Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984, section 5 (the
/// tree of beams is shaded like a tree of rays).
/// Differs: coefficients of mirrors and panes are those of the ray through the point.
/// Conventions: as in Whitted. Threads: used by one thread; memory is reused.

#include "alhazen/renderers/beam_tracing/beam_tree.h"
#include "alhazen/renderers/core/aov_geometry.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/core/tinted_media.h"

namespace alhazen {

class BeamShading {
  public:
    /// All must outlive the object.
    BeamShading(const RenderJob& job, const BeamScene& scene, const BeamTree& tree);

    /// Textures of further points are filtered over that width, in pixels; at first over a pixel.
    void filter_over(double width) { filter_width_ = width; }
    /// Moves to a point of a piece, in the window; includes the throughput of the path to it.
    void go(const BeamPiece& piece, const Vec2& at);
    /// Emission and ambient light of the point; the background if there is no facet.
    [[nodiscard]] Rgb own() const;
    /// The light that reaches the point through the facets of the part.
    [[nodiscard]] Rgb light(const BeamLight& light);
    /// Distance of the point from the hit of a ray refracted by Snell's law with the plane of the
    /// piece; 0 without refraction, infinite after total reflection. Computed only if the layer is
    /// requested.
    [[nodiscard]] double refraction_error() const;
    /// Only for a piece that the eye sees.
    void add_to(PixelGeometry& geometry) const;

  private:
    /// The state of a ray along its path from the eye.
    struct Way : RayMedium {
        Rgb share{1, 1, 1};
    };
    void set_surface_of(std::uint32_t facet, const Ray& ray, double t, Surface& surface);
    /// Sets the point where a ray of a beam meets a facet. Returns the distance from `from`.
    double meet(std::uint32_t facet, const Ray& ray, const Vec3& from, const Way& way);
    void attenuate(double distance, Way& way) const;
    /// Continues the true ray through a facet, whose material `point_` has.
    void follow(std::uint32_t facet, RayKind kind);
    void pass(RayKind kind, double distance, Way& way);
    [[nodiscard]] bool is_closed(const Surface& surface) const {
        const std::vector<std::uint8_t>& closed = geometry_.closed_parts;
        return surface.part < closed.size() && closed[surface.part] != 0;
    }
    /// The medium of a ray that leaves the point along the direction.
    [[nodiscard]] RayMedium medium_along(const Vec3& direction);
    [[nodiscard]] Rgb tint(std::span<const std::uint32_t> through, const LightSample& light,
                           const RayMedium& medium);

    const RenderJob& job_;
    double filter_width_ = 1.0;  ///< in widths of the job's cone
    const Scene& scene_;
    const ShadingConventions& conventions_;
    const BeamScene& geometry_;
    const BeamTree& tree_;
    EyeRays eye_;
    const std::vector<Rgb> ambient_;
    MaterialCache constant_;
    DepthScale depth_;
    ShadingPoint point_;
    Surface between_;
    TintedMedia tinted_;
    CrossedVolumes volumes_;
    Way way_;
    Rgb filter_{1, 1, 1};  ///< factor on all light of the point
    bool nothing_ = false;
    /// The ray by Snell's law, in addition to that of the beam.
    struct TrueRay {
        Vec3 at, direction;
        bool refracted = false, lost = false;
    };
    TrueRay true_;
    bool follows_ = false;
    double off_ = 0;
    std::vector<std::uint32_t> chain_;  ///< pieces from the leaf to the eye
};

}  // namespace alhazen

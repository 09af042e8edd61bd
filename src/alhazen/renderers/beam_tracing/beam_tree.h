#pragma once
/// The tree of beams of a picture: pieces that the eye sees, pieces that reflected and refracted
/// beams see behind mirrors and panes, and the parts of each that lights reach.
///
/// Source: Heckbert and Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984.
/// Differs: refraction stretches space along the normal by tan(refracted) / tan(incident) of the
/// ray through the middle of the piece; the paper uses the ratio of the indices, which is the limit
/// for rays along the normal.
/// Conventions: beams are stored by generations, each in the order of its pieces. Threads: the tree
/// is independent of their number.

#include <span>

#include "alhazen/cameras/eye_rays.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/beam_tracing/beam_caster.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

struct BeamTreeOptions {
    BeamCastOptions cast;
    double least_contribution = 0;  ///< least contribution of reflected and refracted beams
    double least_area = 0;          ///< their least area, as a fraction of the film
    /// About the number of hulls of the facet tree that beams and shadows may test. Of a generation
    /// that would test more, the beams of the largest area times contribution remain. 0: no limit.
    std::uint64_t most_tests = 0;
};

struct BeamNode {
    BeamView view;
    SpaceMap back;                   ///< from the space of the eye
    std::uint32_t piece = kNoFacet;  ///< the piece where it starts; kNoFacet: the eye
    int depth = 0;
    Rgb contribution{1, 1, 1};  ///< upper bound
    bool inside = false;        ///< starts inside a transparent object
};

/// Light that reaches a part of a piece.
struct BeamLight {
    std::uint32_t light = 0;
    LitPart part;
};

struct BeamPiece {
    std::uint32_t beam = 0;
    SeenFacet seen;
    std::vector<BeamLight> lights;
};

struct BeamTree {
    std::vector<BeamNode> beams;
    std::vector<BeamPiece> pieces;
    BeamCounts counts;
    std::vector<std::uint64_t> beams_of_kind;  ///< [RayKind]
    std::uint64_t left_out = 0;                ///< beams beyond BeamTreeOptions::most_tests
};

/// The projection of a camera whose film extends to kBeamFilm from the middle, and its apex.
[[nodiscard]] BeamView eye_view(const Camera& camera);

/// The ray of a point of the window, in the space of the eye.
[[nodiscard]] Ray window_ray(const EyeRays& eye, const Vec2& at);
/// The ray in the space of a beam; unit direction.
[[nodiscard]] Ray space_ray(const SpaceMap& back, const Ray& ray);

/// `region`: in the window. Returns early after a stop.
[[nodiscard]] BeamTree beam_tree(const RenderJob& job, const BeamScene& scene,
                                 const PolygonSet& region, const BeamTreeOptions& options);

}  // namespace alhazen

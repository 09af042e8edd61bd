#pragma once
/// The geometry of a description for scan lines: Bezier patches in world space, and flat facets.
///
/// Source: exact_forms.h (the patches that shapes exactly are).
/// Conventions: numbers of parts and instances are those of Surface. Everything that has no such
/// form (solids of CSG, blobs, algebraic surfaces) is refused by name, all at once.

#include <string>
#include <vector>

#include "alhazen/scene/scene.h"
#include "alhazen/shapes/patches/patch_tree.h"

namespace alhazen {

/// A placed shape or mesh.
struct ScanSource {
    const AnyShape* shape = nullptr;     ///< null: a mesh
    const TriangleMesh* mesh = nullptr;  ///< in its own frame
    std::shared_ptr<const AnyShape> prepared;
    Affine world_from_own, own_from_world;
    bool placed = false;    ///< the placement is not the identity
    bool mirrored = false;  ///< it reverses orientation
    MaterialId material{0};
    std::uint32_t part = 0, instance = 0;
    bool may_pass = false;     ///< a point of it may be missing, or unseen from behind
    bool is_patch = false;     ///< u and v of its pieces are the shape's own parameters
    bool is_triangle = false;  ///< its piece is a triangle with a collapsed edge (steiner_patch)
    bool is_by_ray = false;    ///< the shape's own test completes the hit
};

/// A patch of a source.
struct ScanPiece {
    BezierNet net;  ///< in world space
    std::uint32_t source = 0, part = 0;
    Vec2 lo{0, 0}, hi{1, 1};
    bool polynomial = false;  ///< all weights are 1
    bool trimmed = false;     ///< trimming loops of the NURBS surface leave a part of it out
    bool inward = false;      ///< du x dv points into the solid
};

/// A flat polygon with the odd-even rule, or a triangle of a mesh.
struct ScanFacet {
    std::uint32_t source = 0;
    std::uint32_t part = 0;   ///< of the shape, or the triangle's number
    std::uint32_t first = 0;  ///< in ScanScene::loops; loops of a shape's facet
    std::uint32_t loops = 0;  ///< 0: a triangle
    Vec3 point, normal;       ///< its plane, world space; of no length for a triangle
};

struct ScanScene {
    std::vector<ScanSource> sources;
    std::vector<ScanPiece> pieces;
    std::vector<ScanFacet> facets;
    std::vector<std::vector<HomogeneousPoint>> loops;  ///< world space; w = 0: at infinity
    double farthest = 0;  ///< distance from the eye that no finite corner exceeds

    /// Whether what lies behind a point of the piece may be seen there.
    [[nodiscard]] bool may_pass(const ScanPiece& piece) const {
        return piece.trimmed || sources[piece.source].may_pass;
    }
};

/// Throws Error (Usage) naming every part that cannot take part.
[[nodiscard]] ScanScene scan_scene(const SceneDescription& description, const Scene& scene,
                                   const Vec3& eye);

/// The corners of a mesh triangle in world space.
[[nodiscard]] std::array<Vec3, 3> triangle_corners(const ScanSource& source,
                                                   std::uint32_t triangle);

}  // namespace alhazen

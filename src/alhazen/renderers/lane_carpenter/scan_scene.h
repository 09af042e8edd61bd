#pragma once
/// The geometry of a description for scan conversion: Bezier patches in world space, and flat
/// facets.
///
/// Source: exact_forms.h (shapes as exact patches).
/// Conventions: indices of parts and instances are those of Surface. All parts without such a form
/// (solids of CSG, blobs, algebraic surfaces) are refused by name, in one message.

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
    bool may_pass = false;     ///< a point may be transparent by coverage, or invisible from behind
    bool is_patch = false;     ///< u and v of its pieces are the shape's own parameters
    bool is_triangle = false;  ///< its piece is a triangle with a collapsed edge (steiner_patch)
    bool is_by_ray = false;    ///< the hit is completed by the shape's ray intersection
};

/// A patch of a source.
struct ScanPiece {
    BezierNet net;  ///< in world space
    std::uint32_t source = 0, part = 0;
    Vec2 lo{0, 0}, hi{1, 1};
    bool polynomial = false;  ///< all weights are 1
    bool trimmed = false;     ///< trimming loops of the NURBS surface remove a part of it
    bool inward = false;      ///< du x dv points into the solid
};

/// A flat polygon with the odd-even rule, or a triangle of a mesh.
struct ScanFacet {
    std::uint32_t source = 0;
    std::uint32_t part = 0;   ///< part of the shape, or index of the triangle
    std::uint32_t first = 0;  ///< in ScanScene::loops; loops of a shape's facet
    std::uint32_t loops = 0;  ///< 0: a triangle
    Vec3 point, normal;       ///< its plane, world space; zero for a triangle
};

struct ScanScene {
    std::vector<ScanSource> sources;
    std::vector<ScanPiece> pieces;
    std::vector<ScanFacet> facets;
    std::vector<std::vector<HomogeneousPoint>> loops;  ///< world space; w = 0: at infinity
    double farthest = 0;  ///< upper bound of the distance of finite corners from the eye

    /// True if surfaces behind a point of the piece may be visible.
    [[nodiscard]] bool may_pass(const ScanPiece& piece) const {
        return piece.trimmed || sources[piece.source].may_pass;
    }
};

/// Throws Error (Usage) naming every part that is not supported.
[[nodiscard]] ScanScene scan_scene(const SceneDescription& description, const Scene& scene,
                                   const Vec3& eye);

/// The corners of a mesh triangle in world space.
[[nodiscard]] std::array<Vec3, 3> triangle_corners(const ScanSource& source,
                                                   std::uint32_t triangle);

}  // namespace alhazen

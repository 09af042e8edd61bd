#pragma once
/// The geometry of a description for cone tracing: spheres, planes, flat faces, triangle meshes.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984 (spheres, planes, polygons).
/// Differs: also triangle meshes, and boxes, polyhedra and rectangles by their faces. All other
/// parts are refused by name, in one message. A polygon that crosses itself is several faces.
/// Conventions: indices of parts and instances are those of Surface. Faces that share an edge, bit
/// for bit, are one surface, even of different parts.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "alhazen/primitives/primitive_table.h"
#include "alhazen/renderers/cone_tracing/cone_tree.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

/// A placed shape or mesh.
struct ConeSource {
    enum class Kind : std::uint8_t { Sphere, Plane, Faces, Mesh };
    Kind kind = Kind::Mesh;
    bool placed = false;     ///< the placement is not the identity
    bool closed = false;     ///< a solid: its front hides its back from outside
    bool inward = false;     ///< corners are clockwise from outside, in world space
    bool may_pass = false;   ///< a point may be transparent by coverage, or invisible from behind
    bool has_alpha = false;  ///< a point may be transparent by coverage
    bool varies = false;     ///< its points may differ in what they let through
    RayMask visible_to = kAllRays;
    MaterialId material{0};
    std::uint32_t part = 0, instance = 0;
    std::uint32_t surface = 0;  ///< index of the surface; pieces of one surface abut
    std::uint32_t solid = 0;    ///< of a closed source, but for planes: its index in `solids`
    std::shared_ptr<const AnyShape> shape;
    PlacedMesh mesh;
    Placement placement;
    Vec3 point, normal;  ///< world: centre of the sphere; a point of the plane, its normal
    double radius = 0;   ///< radius of the sphere
    const ConeTree* tree = nullptr;  ///< over the triangles of the mesh, in its own frame
    /// [triangle] of a closed mesh of several shells: winds otherwise than `inward` says; or null.
    const std::vector<bool>* turned = nullptr;

    /// True if the corners of the triangle are clockwise from outside, in world space.
    [[nodiscard]] bool is_inward(std::uint32_t triangle) const {
        return turned != nullptr ? inward != (*turned)[triangle] : inward;
    }
};

/// A flat face in world space.
struct ConeFace {
    std::uint32_t source = 0, part = 0;
    Vec3 point, normal;
    std::vector<Vec3> vertices;            ///< front counter-clockwise; holes in the opposite order
    std::vector<std::uint32_t> loop_ends;  ///< empty: one loop
};

/// An item of a tree leaf: a sphere, a mesh, or a face.
struct ConeItem {
    static constexpr std::uint32_t kNoFace = 0xFFFFFFFFu;
    std::uint32_t source = 0, face = kNoFace;
};

/// A closed source.
struct ConeSolid {
    std::uint32_t source = 0;
    std::uint32_t first_face = 0, end_face = 0;  ///< its faces, if it has any
    double size = 0;                             ///< diagonal of its box
    /// No other closed source reaches points that are nearer to its boundary.
    double apart = 0;
};

struct ConeScene {
    std::vector<ConeSource> sources;
    std::vector<ConeFace> faces;
    std::vector<ConeItem> items;
    std::vector<std::uint32_t> planes;  ///< unbounded sources
    ConeTree tree;                      ///< over `items`
    std::vector<ConeSolid> solids;      ///< the bounded ones
    ConeTree solid_tree;                ///< over `solids`
    std::map<const TriangleMesh*, std::unique_ptr<ConeTree>> mesh_trees;
    std::map<const TriangleMesh*, std::vector<bool>> turned;  ///< ConeSource::turned
    std::uint32_t surfaces = 0;
};

/// Throws Error (Usage) naming every part that is not supported.
[[nodiscard]] ConeScene cone_scene(const SceneDescription& description, const Scene& scene);

}  // namespace alhazen

#pragma once
/// A description as planar facets in world space, in a tree, for beam tracing.
///
/// Source: Heckbert and Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984.
/// Conventions: supports polygons with holes, rectangles, boxes, polyhedra and triangle meshes, in
/// any number of instances. All other parts are refused by name, in one message. Polygons with
/// corners off their plane or with crossing edges are repaired (repaired_polygon.h). Indices of
/// parts and instances are those of Surface. Corners of facets are counter-clockwise from outside.

#include <memory>
#include <string>
#include <vector>

#include "alhazen/geometry/facets/facet_tree.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

/// A placed shape or mesh.
struct BeamSource {
    bool placed = false;  ///< the placement is not the identity
    Placement placement;
    MaterialId material{0};
    std::uint32_t part = 0, instance = 0;
    RayMask visible_to = kAllRays;
    std::shared_ptr<const AnyShape> shape;  ///< null: a mesh
    PlacedMesh mesh;
    bool smooth = false;  ///< its shading normals differ from those of its planes
};

struct BeamFacet {
    std::uint32_t source = 0;
    std::uint32_t part = 0;    ///< face of the shape, or triangle of the mesh
    bool one_sided = false;    ///< invisible from behind
    bool blocks_light = true;  ///< its material is opaque
};

struct BeamScene {
    std::vector<BeamSource> sources;
    std::vector<BeamFacet> facets;
    FacetTree tree;
    std::vector<std::uint8_t> closed_parts;  ///< as Scene::closed_parts, of the parts gathered
    std::vector<std::string> notes;          ///< one line for each repaired polygon

    [[nodiscard]] const FacetPlane& plane(std::uint32_t facet) const {
        return tree.pool().planes[facet];
    }
};

/// Throws Error (Usage) naming every part that is not supported.
[[nodiscard]] BeamScene beam_scene(const SceneDescription& description, const Scene& scene);

}  // namespace alhazen

#pragma once
/// A description as planar facets in world space, ordered in a tree, for beams.
///
/// Source: Heckbert and Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984.
/// Conventions: polygons with holes, rectangles, boxes, polyhedra and triangle meshes, placed by
/// any number of instances. All else is refused by name, all at once. Polygons with corners off
/// their plane or with edges that cross are mended (mended_polygon.h). Numbers of parts and
/// instances are those of Surface. Facets count corners counter-clockwise from outside.

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
    bool smooth = false;  ///< its normals for shading differ from those of its planes
};

struct BeamFacet {
    std::uint32_t source = 0;
    std::uint32_t part = 0;    ///< face of the shape, or triangle of the mesh
    bool one_sided = false;    ///< not seen from behind
    bool blocks_light = true;  ///< its material is opaque
};

struct BeamScene {
    std::vector<BeamSource> sources;
    std::vector<BeamFacet> facets;
    FacetTree tree;
    std::vector<std::string> notes;  ///< what was mended, a polygon a line

    [[nodiscard]] const FacetPlane& plane(std::uint32_t facet) const {
        return tree.pool().planes[facet];
    }
};

/// Throws Error (Usage) naming every part that cannot take part.
[[nodiscard]] BeamScene beam_scene(const SceneDescription& description, const Scene& scene);

}  // namespace alhazen

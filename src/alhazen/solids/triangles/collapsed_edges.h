#pragma once
/// Merges the triangles of a mesh within a distance: flat parts become few, edges stay sharp.
///
/// Source: Hoppe, DeRose, Duchamp, McDonald and Stuetzle, "Mesh Optimization", SIGGRAPH 1993 (edge
/// collapse); Dey, Edelsbrunner, Guha and Nekhayev, "Topology preserving edge contraction", 1999
/// (which collapses keep the topology); Cohen, Manocha and Olano, "Simplifying polygonal models
/// using successive mappings", Visualization 1997 (the bound of the distance).
/// Differs: a vertex moves to one beside it, so that all vertices stay on the surface, with its
/// normals. The mapping of the old triangles around a vertex to the new ones is a projection in
/// which all face the same side; the largest distance is then at crossings of their edges. It is
/// added to the largest bound of the triangles that are replaced. A line between materials, normals
/// or texture coordinates moves by no more than that, along the surface also.
/// Conventions: vertices of a point are one, also where another point has its position. A closed
/// mesh stays closed; what touches itself at a point stays as it is there. Triangles keep their
/// side: normals at the corners deviate from a new triangle's by no more than acos 0.8, or than
/// from the old ones, and by less than a right angle. Complexity and threads: O(triangles), serial:
/// the same for any number of threads.

#include <cstdint>
#include <vector>

#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// `points`: [vertex] the first vertex at its point. `distance`: from each point of the old mesh to
/// the new one, and of the new one to the old one. `coordinates`: the largest change of texture
/// coordinates at any point. Precondition: the mesh has normals, texture coordinates and materials
/// at its vertices, the material of a triangle at all three.
void collapse_edges(TriangleMesh& mesh, std::vector<std::uint32_t> points, double distance,
                    double coordinates);

}  // namespace alhazen

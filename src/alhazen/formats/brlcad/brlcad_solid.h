#pragma once
/// Solids of a BRL-CAD database with their parameters from the file, for versions 4 and 5.
///
/// Source: BRL-CAD, "MGED Quick Reference" and the text output of its program `g2asc`.
/// Differs: both versions use the same structures. arb4 to arb8 have eight points each, spheres are
/// ellipsoids, all cylinders and cones are `tgc`.
/// Conventions: lengths in millimetres.

#include <array>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "alhazen/math/vec.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// A convex solid of eight corners with the topology of a cube; corners may coincide.
struct BrlcadArb8 {
    std::array<Vec3, 8> corners;
};

/// An ellipsoid: centre and semi-axes.
struct BrlcadEllipsoid {
    Vec3 center, a, b, c;
};

/// A truncated cone with the ellipse a, b around `base` and the ellipse c, d around
/// `base + height`.
struct BrlcadTgc {
    Vec3 base, height, a, b, c, d;
};

struct BrlcadTorus {
    Vec3 center, axis;
    double major = 0, minor = 0;
};

/// The points p with dot(normal, p) <= distance.
struct BrlcadHalfSpace {
    Vec3 normal;
    double distance = 0;
};

/// The sweep of a sphere along `height`, its radius changing linearly.
struct BrlcadParticle {
    Vec3 base, height;
    double base_radius = 0, top_radius = 0;
};

/// A cylinder over a parabola (rpc) or a hyperbola (rhc) through base + breadth, with half width
/// `half_width` at the base, extruded along `height`. The asymptotes of the hyperbola intersect at
/// `apex_distance` above it.
struct BrlcadConicCylinder {
    Vec3 base, height, breadth;
    double half_width = 0, apex_distance = 0;
    bool hyperbolic = false;
};

/// An elliptic paraboloid (epa) or one sheet of a hyperboloid (ehy) with its apex at base + height.
/// Its section at the base has the semi-axes `radius_a` along `a` and `radius_b` perpendicular.
struct BrlcadConicDome {
    Vec3 base, height, a;
    double radius_a = 0, radius_b = 0, apex_distance = 0;
    bool hyperbolic = false;
};

/// The solid of revolution about `axis` of an ellipse with semi-axis `c` and a perpendicular one of
/// length `minor`.
struct BrlcadEllipticTorus {
    Vec3 center, axis, c;
    double major = 0, minor = 0;
};

/// A hyperboloid of one sheet from `base` along `height`. The semi-axes at both ends are `a` and a
/// perpendicular one of length `radius_b`; in the middle they are scaled by `neck`.
struct BrlcadHyperboloid {
    Vec3 base, height, a;
    double radius_b = 0, neck = 0;
};

struct BrlcadSuperellipsoid {
    Vec3 center, a, b, c;
    double north = 1, east = 1;
};

/// The points p with dot(normal, p) <= distance for every plane.
struct BrlcadPolyhedron {
    std::vector<BrlcadHalfSpace> planes;
};

/// A mesh of an ars or bot.
struct BrlcadMesh {
    std::shared_ptr<TriangleMesh> mesh;
    bool solid = true;   ///< false: a surface
    bool plate = false;  ///< a surface with a thickness, which is dropped
};

/// A solid that the importer does not support.
struct BrlcadUnsupported {
    std::string reason = "has an unsupported type";
};

struct BrlcadSolid {
    std::string type;  ///< as in the file, for example "tgc"
    std::variant<BrlcadUnsupported, BrlcadArb8, BrlcadEllipsoid, BrlcadTgc, BrlcadTorus,
                 BrlcadHalfSpace, BrlcadParticle, BrlcadConicCylinder, BrlcadConicDome,
                 BrlcadEllipticTorus, BrlcadHyperboloid, BrlcadSuperellipsoid, BrlcadPolyhedron,
                 BrlcadMesh>
        form;
};

}  // namespace alhazen

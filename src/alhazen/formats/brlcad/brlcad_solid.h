#pragma once
/// The solids of a BRL-CAD database as the file gives them, whatever its version.
///
/// Source: BRL-CAD, "MGED Quick Reference" and the text that its program `g2asc` writes. Differs:
/// solids of the two versions become the same structures; arb4 to arb8 are all eight points,
/// spheres are ellipsoids, all cylinders and cones are `tgc`. Conventions: millimetres.

#include <array>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "alhazen/math/vec.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// A convex solid of eight corners, of which some may coincide; four a side, as a cube's.
struct BrlcadArb8 {
    std::array<Vec3, 8> corners;
};

/// Three semi-axes.
struct BrlcadEllipsoid {
    Vec3 center, a, b, c;
};

/// Between the ellipse a, b around `base` and the ellipse c, d around `base + height`.
struct BrlcadTgc {
    Vec3 base, height, a, b, c, d;
};

struct BrlcadTorus {
    Vec3 center, axis;
    double major = 0, minor = 0;
};

/// dot(normal, p) <= distance.
struct BrlcadHalfSpace {
    Vec3 normal;
    double distance = 0;
};

/// A sphere that grows or shrinks while it moves along `height`.
struct BrlcadParticle {
    Vec3 base, height;
    double base_radius = 0, top_radius = 0;
};

/// A parabola (rpc), or a hyperbola whose asymptotes meet at `apex_distance` above it (rhc),
/// through base + breadth, of half width `half_width` at the base, moved along `height`.
struct BrlcadConicCylinder {
    Vec3 base, height, breadth;
    double half_width = 0, apex_distance = 0;
    bool hyperbolic = false;
};

/// An elliptic paraboloid (epa), or one sheet of a hyperboloid (ehy), with its apex at base +
/// height; its section at the base has the semi-axes `radius_a` along `a` and `radius_b` across.
struct BrlcadConicDome {
    Vec3 base, height, a;
    double radius_a = 0, radius_b = 0, apex_distance = 0;
    bool hyperbolic = false;
};

/// An ellipse of semi-axis `c` and a perpendicular one of length `minor`, turned about `axis`.
struct BrlcadEllipticTorus {
    Vec3 center, axis, c;
    double major = 0, minor = 0;
};

/// A hyperboloid of one sheet from `base` along `height`: semi-axes `a` and one of length
/// `radius_b` at both ends, `neck` times as long in the middle.
struct BrlcadHyperboloid {
    Vec3 base, height, a;
    double radius_b = 0, neck = 0;
};

struct BrlcadSuperellipsoid {
    Vec3 center, a, b, c;
    double north = 1, east = 1;
};

/// All p with dot(normal, p) <= distance for each plane.
struct BrlcadPolyhedron {
    std::vector<BrlcadHalfSpace> planes;
};

/// ars and bot.
struct BrlcadMesh {
    std::shared_ptr<TriangleMesh> mesh;
    bool solid = true;   ///< else a surface only
    bool plate = false;  ///< a surface that has a thickness, which is not kept
};

/// A solid of a type that is not read.
struct BrlcadUnsupported {};

struct BrlcadSolid {
    std::string type;  ///< as in the file: "tgc"
    std::variant<BrlcadUnsupported, BrlcadArb8, BrlcadEllipsoid, BrlcadTgc, BrlcadTorus,
                 BrlcadHalfSpace, BrlcadParticle, BrlcadConicCylinder, BrlcadConicDome,
                 BrlcadEllipticTorus, BrlcadHyperboloid, BrlcadSuperellipsoid, BrlcadPolyhedron,
                 BrlcadMesh>
        form;
};

}  // namespace alhazen

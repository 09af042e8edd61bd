#pragma once
/// Planes, apexes and projections of beams.
///
/// Source: Heckbert and Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984: a beam is an
/// apex and a polygon; mirrors and windows change it by a linear transformation of space.
/// Differs: all beams of a picture are drawn in the window of the eye: a reflected or refracted
/// beam has the projection of the eye after the reflection, or the linear transformation, of space.
/// Its cross-section is then the visible piece of the mirror, without a change of coordinates.
/// Conventions: window coordinates are x = X / W and y = Y / W with (X, Y, W) = rows * (p, 1); W >
/// 0 in front of the apex. An apex at infinity has weight 0, and `at` is the direction towards it.

#include <array>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The plane dot(normal, p) = offset; its function `at` is positive on the side of the normal.
struct FacetPlane {
    Vec3 normal;
    double offset = 0;

    [[nodiscard]] double at(const Vec3& p) const { return dot(normal, p) - offset; }
    [[nodiscard]] FacetPlane reversed() const { return {-normal, -offset}; }
};

struct BeamApex {
    Vec3 at;
    double weight = 1;  ///< 0: the apex is at infinity, in direction `at`

    /// Positive if the apex lies on the side of the plane's normal.
    [[nodiscard]] double side(const FacetPlane& plane) const {
        return dot(plane.normal, at) - plane.offset * weight;
    }
};

/// A linear transformation of homogeneous points.
struct SpaceMap {
    std::array<std::array<double, 4>, 4> m{
        {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

    /// The reflection in a plane of unit normal.
    [[nodiscard]] static SpaceMap mirror(const FacetPlane& plane) { return stretch(plane, -1.0); }
    /// Scales distances from a plane of unit normal.
    [[nodiscard]] static SpaceMap stretch(const FacetPlane& plane, double factor) {
        SpaceMap map;
        for (std::size_t i = 0; i < 3; ++i) {
            const double n = (factor - 1.0) * plane.normal[static_cast<int>(i)];
            for (std::size_t j = 0; j < 3; ++j) {
                map.m[i][j] += n * plane.normal[static_cast<int>(j)];
            }
            map.m[i][3] = -n * plane.offset;
        }
        return map;
    }
    /// The projection onto a plane from an apex in front of it: points between the two have weights
    /// above 0.
    [[nodiscard]] static SpaceMap shadow(const FacetPlane& plane, const BeamApex& light) {
        const std::array<double, 4> p{plane.normal.x, plane.normal.y, plane.normal.z,
                                      -plane.offset};
        const std::array<double, 4> l{light.at.x, light.at.y, light.at.z, light.weight};
        const double side = light.side(plane);
        SpaceMap map;
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; j < 4; ++j) map.m[i][j] = (i == j ? side : 0.0) - l[i] * p[j];
        }
        return map;
    }
    [[nodiscard]] BeamApex operator()(const BeamApex& a) const {
        const auto row = [&](std::size_t i) {
            return m[i][0] * a.at.x + m[i][1] * a.at.y + m[i][2] * a.at.z + m[i][3] * a.weight;
        };
        return {{row(0), row(1), row(2)}, row(3)};
    }
};

struct BeamProjection {
    std::array<std::array<double, 4>, 3> rows{};

    /// (X, Y, W) of a point.
    [[nodiscard]] Vec3 operator()(const Vec3& p) const { return {row(0, p), row(1, p), row(2, p)}; }
    [[nodiscard]] double row(std::size_t i, const Vec3& p) const {
        return rows[i][0] * p.x + rows[i][1] * p.y + rows[i][2] * p.z + rows[i][3];
    }
    /// The projection of space transformed by `map`.
    [[nodiscard]] BeamProjection after(const SpaceMap& map) const {
        BeamProjection result;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 4; ++j) {
                for (std::size_t k = 0; k < 4; ++k) result.rows[i][j] += rows[i][k] * map.m[k][j];
            }
        }
        return result;
    }
    /// a X + b Y + c W = 0 as a plane of space, with a unit normal unless the normal is 0.
    [[nodiscard]] FacetPlane plane(double a, double b, double c) const {
        const auto sum = [&](std::size_t j) {
            return a * rows[0][j] + b * rows[1][j] + c * rows[2][j];
        };
        const Vec3 normal{sum(0), sum(1), sum(2)};
        const double size = length(normal);
        return size > 0.0 ? FacetPlane{normal / size, -sum(3) / size} : FacetPlane{{}, -sum(3)};
    }
};

}  // namespace alhazen

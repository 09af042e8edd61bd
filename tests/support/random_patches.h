#pragma once
/// Random patches: wavy, flat, folded, with degenerate edges, rational or not; patch meshes that
/// are open sheets or closed boxes.

#include <array>
#include <map>

#include "support/shape_source.h"

namespace alhazen::testing {

inline int random_patch_degree(Random& random) {
    return random.coin() ? 3 : 1 + random.below(kMaxPatchDegree);
}

/// Random weights: empty, or one for each point.
inline std::vector<double> random_patch_weights(const ShapeSource& from, std::size_t count) {
    std::vector<double> weights;
    if (from.random.coin()) return weights;
    for (std::size_t k = 0; k < count; ++k) {
        weights.push_back(from.lattice ? 0.5 * (1 + from.random.below(4))
                                       : from.random.log_uniform(0.2, 5));
    }
    return weights;
}

/// A block of six bilinear patches.
inline PatchMesh patch_block(const Vec3& lo, const Vec3& hi) {
    PatchMesh block;
    block.degree_u = block.degree_v = 1;
    for (int corner = 0; corner < 8; ++corner) {
        block.points.push_back(
            {corner & 4 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y, corner & 1 ? hi.z : lo.z});
    }
    block.patches = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 4, 5, 2, 3, 6, 7, 0, 2, 4, 6, 1, 3, 5, 7};
    return block;
}

/// rows * columns points of a sheet, u-major: a parallelogram with waves. The sine of the angle
/// between its sides is above 0.05.
inline std::vector<Vec3> random_sheet(const ShapeSource& from, int rows, int columns) {
    Random& random = from.random;
    const Vec3 corner = from.point();
    Vec3 a, b;
    do {
        a = from.vector();
        b = from.vector();
    } while (!(length(cross(a, b)) > 0.05 * length(a) * length(b)));
    const double wave = random.below(3) == 0 ? 0.0 : 0.3 * std::min(length(a), length(b));
    const bool pole = random.below(4) == 0;  // the edge u = 0 is one point
    std::vector<Vec3> points;
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) {
            const Vec3 flat = corner + (double(i) / (rows - 1)) * a +
                              (pole && i == 0 ? 0.0 : double(j) / (columns - 1)) * b;
            Vec3 noise = wave * random.in_cube(1.0);
            if (from.lattice)
                noise = wave == 0.0 ? Vec3{} : 0.5 * Vec3{0, 0, double(random.below(3))};
            points.push_back(pole && i == 0 ? corner : flat + noise);
        }
    }
    // Sometimes two neighbouring control points coincide.
    if (random.below(4) == 0) points[1] = points[0];
    return points;
}

template <>
struct RandomShape<BezierPatch> {
    static BezierPatch make(const ShapeSource& from) {
        BezierPatch patch;
        patch.degree_u = std::uint32_t(random_patch_degree(from.random));
        patch.degree_v = std::uint32_t(random_patch_degree(from.random));
        patch.points = random_sheet(from, int(patch.degree_u) + 1, int(patch.degree_v) + 1);
        patch.weights = random_patch_weights(from, patch.points.size());
        return patch;
    }
};

template <>
struct RandomShape<PatchMesh> {
    static PatchMesh make(const ShapeSource& from) {
        return from.random.coin() ? box(from) : sheet(from);
    }

  private:
    /// Six patches around a box whose control points are displaced; closed.
    static PatchMesh box(const ShapeSource& from) {
        Random& random = from.random;
        const int n = 1 + random.below(3);
        const Vec3 corner = from.point();
        const Vec3 size{from.length(), from.length(), from.length()};
        PatchMesh mesh{.degree_u = std::uint32_t(n), .degree_v = std::uint32_t(n)};
        std::map<std::array<int, 3>, std::uint32_t> known;
        const double wave = from.lattice ? 0.0 : 0.2 / n;
        const auto point = [&](const std::array<int, 3>& at) {
            const auto [entry, fresh] = known.try_emplace(at, std::uint32_t(mesh.points.size()));
            if (fresh) {
                const Vec3 noise = wave * random.in_cube(1.0);
                Vec3 p = corner;
                for (int k = 0; k < 3; ++k) {
                    p[k] += size[k] * (double(at[std::size_t(k)]) / n + noise[k]);
                }
                mesh.points.push_back(p);
            }
            return entry->second;
        };
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const int side : {0, n}) {
                for (int i = 0; i <= n; ++i) {
                    for (int j = 0; j <= n; ++j) {
                        // du x dv points outward.
                        std::array<int, 3> at{};
                        at[axis] = side;
                        at[(axis + 1) % 3] = side == 0 ? j : i;
                        at[(axis + 2) % 3] = side == 0 ? i : j;
                        mesh.patches.push_back(point(at));
                    }
                }
            }
        }
        mesh.weights = random_patch_weights(from, mesh.points.size());
        return mesh;
    }
    /// One to nine patches side by side.
    static PatchMesh sheet(const ShapeSource& from) {
        Random& random = from.random;
        const int du = random_patch_degree(random), dv = random_patch_degree(random);
        const int rows = 1 + random.below(3), columns = 1 + random.below(3);
        const int width = columns * dv + 1;
        PatchMesh mesh{.degree_u = std::uint32_t(du), .degree_v = std::uint32_t(dv)};
        mesh.points = random_sheet(from, rows * du + 1, width);
        for (int patch = 0; patch < rows * columns; ++patch) {
            const int first = (patch / columns) * du * width + (patch % columns) * dv;
            for (int k = 0; k < (du + 1) * (dv + 1); ++k) {
                mesh.patches.push_back(std::uint32_t(first + k / (dv + 1) * width + k % (dv + 1)));
            }
        }
        mesh.weights = random_patch_weights(from, mesh.points.size());
        return mesh;
    }
};

template <>
struct RandomShape<NurbsSurface> {
    static NurbsSurface make(const ShapeSource& from) {
        Random& random = from.random;
        NurbsSurface s;
        s.degree_u = std::uint32_t(1 + random.below(4));
        s.degree_v = std::uint32_t(1 + random.below(4));
        const int rows = int(s.degree_u) + 1 + random.below(4);
        const int columns = int(s.degree_v) + 1 + random.below(4);
        s.knots_u = knots(from, int(s.degree_u), rows);
        s.knots_v = knots(from, int(s.degree_v), columns);
        s.points = random_sheet(from, rows, columns);
        s.weights = random_patch_weights(from, s.points.size());
        const double u0 = s.knots_u[s.degree_u], u1 = s.knots_u[std::size_t(rows)];
        const double v0 = s.knots_v[s.degree_v], v1 = s.knots_v[std::size_t(columns)];
        const auto at = [&](double x, double y) {
            return Vec2{u0 + x * (u1 - u0), v0 + y * (v1 - v0)};
        };
        if (random.coin()) return s;
        s.trims.push_back({TrimCurve{
            .points = {at(0, 0), at(1, 0), at(1, 1), at(0.125, 1), at(0, 0.75), at(0, 0)}}});
        if (random.coin()) {
            s.trims.push_back({TrimCurve{.degree = 2,
                                         .points = {at(0.25, 0.5), at(0.25, 0.25), at(0.5, 0.25)},
                                         .weights = {1, 0.75, 1}},
                               TrimCurve{.degree = 2,
                                         .knots = {0, 0, 0, 1, 2, 2, 2},
                                         .points = {at(0.5, 0.25), at(0.75, 0.5), at(0.5, 0.75),
                                                    at(0.25, 0.5)}}});
        }
        return s;
    }

  private:
    static std::vector<double> knots(const ShapeSource& from, int degree, int count) {
        Random& random = from.random;
        const bool clamped = random.below(4) != 0;
        std::vector<double> knots;
        double at = from.lattice ? 0.0 : random.uniform(-1, 1);
        bool twice = false;
        for (int k = 0; k < count + degree + 1; ++k) {
            const bool inner = k > degree && k <= count;
            twice = inner && degree > 1 && k > degree + 1 && !twice && random.below(5) == 0;
            if (k > 0 && (inner || !clamped) && !twice) {
                at += from.lattice ? 1.0 : random.log_uniform(0.2, 2);
            }
            knots.push_back(at);
        }
        // The end of the domain must be above its beginning.
        return knots;
    }
};

template <>
struct RandomShape<BilinearPatch> {
    static BilinearPatch make(const ShapeSource& from) {
        for (;;) {
            const std::vector<Vec3> p = random_sheet(from, 2, 2);
            BilinearPatch patch{.p00 = p[0], .p10 = p[2], .p01 = p[1], .p11 = p[3]};
            Diagnostics findings;
            patch.validate({}, findings);
            if (findings.error_count() == 0) return patch;
        }
    }
};

template <>
struct RandomShape<SteinerPatch> {
    static SteinerPatch make(const ShapeSource& from) {
        for (;;) {
            const std::vector<Vec3> p = random_sheet(from, 3, 3);
            SteinerPatch patch;
            // 200, 110, 020, 101, 011, 002: the triangle below the diagonal of the sheet.
            patch.points = {p[0], p[3], p[6], p[1], p[4], p[2]};
            patch.weights = random_patch_weights(from, 6);
            Diagnostics findings;
            patch.validate({}, findings);
            if (findings.error_count() == 0) return patch;
        }
    }
};

}  // namespace alhazen::testing

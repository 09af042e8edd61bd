// Shapes as the rational Bezier patches that they exactly are.

#include "alhazen/shapes/patches/forms/exact_forms.h"

#include <gtest/gtest.h>

#include <map>

#include "support/random_shapes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Uses of each boundary curve that is more than a point, by its control points from either end.
std::map<std::vector<double>, int> boundary_uses(const std::vector<BezierPiece>& pieces) {
    std::map<std::vector<double>, int> uses;
    for (const BezierPiece& piece : pieces) {
        for (int side = 0; side < 4; ++side) {
            std::array<HomogeneousPoint, kMaxPatchOrder> curve;
            const int count = boundary_curve(piece.net, side, curve);
            std::vector<double> forward, backward;
            bool point = true;
            for (int k = 0; k < count; ++k) {
                const HomogeneousPoint& a = curve[static_cast<std::size_t>(k)];
                const HomogeneousPoint& b = curve[static_cast<std::size_t>(count - 1 - k)];
                for (const double x : {a.x + 0.0, a.y + 0.0, a.z + 0.0, a.w}) forward.push_back(x);
                for (const double x : {b.x + 0.0, b.y + 0.0, b.z + 0.0, b.w}) backward.push_back(x);
                point = point && projected(a) == projected(curve[0]);
            }
            if (!point) ++uses[std::min(forward, backward)];
        }
    }
    return uses;
}

/// Points of the patches lie on the shape, where a line along their normal crosses it, with the
/// shape's own normal.
template <HasPatchForm S>
void expect_exact(int shapes) {
    testing::Random random(11);
    double farthest = 0;
    for (int i = 0; i < shapes; ++i) {
        const S shape = testing::random_shape<S>({random, i % 2 == 1});
        std::vector<BezierPiece> pieces;
        append_pieces(shape, pieces);
        ASSERT_FALSE(pieces.empty()) << S::kName;
        Box3 box;
        for (const BezierPiece& piece : pieces) box.include(control_box(piece.net));
        const double reach = max_component(abs(box.lo)) + max_component(abs(box.hi));
        for (int k = 0; k < 50; ++k) {
            const BezierPiece& piece =
                pieces[static_cast<std::size_t>(random.below(static_cast<int>(pieces.size())))];
            const double u = random.uniform(0.01, 0.99), v = random.uniform(0.01, 0.99);
            const Vec3 p = point_at(piece.net, u, v);
            const Vec3 n = patch_normal(piece.net, u, v);
            const double size = length(box.size());
            const Ray ray = testing::line(p, n);
            ShapeHits hits;
            append_hits(shape, ray, hits);
            const ShapeHit* nearest = nullptr;
            for (const ShapeHit& hit : hits) {
                if (!nearest || std::abs(hit.t) < std::abs(nearest->t)) nearest = &hit;
            }
            ASSERT_NE(nearest, nullptr) << S::kName << " shape " << i << " point " << k;
            ASSERT_LE(std::abs(nearest->t), 1e-13 * (reach + size)) << S::kName << " " << i;
            ASSERT_EQ(nearest->part, piece.part) << S::kName;
            ASSERT_GT(dot(shape.surface(ray, *nearest).normal, n), 0.999) << S::kName << " " << i;
            farthest = std::max(farthest, std::abs(nearest->t) / (reach + size));
        }
        if (shape.closed()) {
            for (const auto& [curve, count] : boundary_uses(pieces)) {
                ASSERT_EQ(count % 2, 0) << S::kName << " shape " << i;
            }
        }
    }
    EXPECT_LE(farthest, 1e-14) << S::kName;
}

TEST(ExactForms, LieOnTheShapeAndClose) {
    expect_exact<Sphere>(200);
    expect_exact<Ellipsoid>(200);
    expect_exact<Cylinder>(200);
    expect_exact<Cone>(200);
    expect_exact<EllipticCylinder>(200);
    expect_exact<EllipticCone>(200);
    expect_exact<Tgc>(200);
    expect_exact<Paraboloid>(200);
    expect_exact<Hyperboloid>(200);
    expect_exact<TwoSheetHyperboloid>(200);
    expect_exact<Torus>(200);
    expect_exact<Lathe>(200);
    expect_exact<Disc>(200);
    expect_exact<Rectangle>(200);
}

TEST(ExactForms, WhatIsAPointOfAProfileHasNoPatch) {
    const Vec2 a{1, 0}, b{2, 0}, c{1, 1};
    Lathe ring;
    ring.profile.curves = {line_curve(a, b), line_curve(b, b), cubic_curve(b, b, b, b),
                           line_curve(b, c), line_curve(c, a)};
    ring.profile.loop_ends = {5};
    // The loop once, and twice: then two points are left of it.
    for (const std::size_t loops : {std::size_t{1}, std::size_t{2}}) {
        Lathe lathe = ring;
        if (loops == 2) {
            lathe.profile.curves.insert(lathe.profile.curves.end(), ring.profile.curves.begin(),
                                        ring.profile.curves.end());
            lathe.profile.loop_ends.push_back(10);
        }
        lathe.prepare();
        std::vector<BezierPiece> pieces;
        append_pieces(lathe, pieces);
        EXPECT_EQ(pieces.size(), loops == 1 ? 12u : 0u);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE

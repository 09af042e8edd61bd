/// Patches written as .bpt and OBJ and read back.

#include "alhazen/formats/patch_files/patch_export.h"

#include <gtest/gtest.h>

#include "alhazen/formats/bpt/bpt_importer.h"
#include "alhazen/formats/obj/obj_importer.h"
#include "support/random_shapes.h"
#include "support/same_description.h"
#include "unit/formats/text_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::RandomShape;

constexpr std::uint32_t kNoPart = 0xFFFFFFFFu;

/// Bits of the nets of all patches.
std::vector<HomogeneousPoint> nets_of(const PatchMesh& mesh) {
    std::vector<HomogeneousPoint> all;
    for (std::size_t k = 0; k < mesh.patch_count(); ++k) {
        const BezierNet net = mesh.net(k);
        all.insert(all.end(), net.points.begin(), net.points.begin() + net.count());
    }
    return all;
}

std::vector<HomogeneousPoint> nets_of(const BezierPatch& patch) {
    const BezierNet net = patch.net();
    return {net.points.begin(), net.points.begin() + net.count()};
}

template <class Importer>
testing::Imported read_back(const AnyShape& shape, const Affine& placement = {}) {
    const std::vector<NamedSurface> surfaces{{"name", &shape, placement, ""}};
    const bool bpt = std::is_same_v<Importer, BptImporter>;
    const std::string text = bpt ? bpt_text(surfaces) : obj_surfaces_text(surfaces);
    auto read = testing::import_text<Importer>(text, bpt ? "a.bpt" : "a.obj");
    EXPECT_EQ(read.messages(), "") << text.substr(0, 2000);
    return read;
}

const PatchMesh& mesh_of(const testing::Imported& read) {
    return std::get<PatchMesh>(std::get<AnyShape>(read.parts().at(0).what));
}

/// The piece of a prepared surface that has the parameters of a hit.
std::uint32_t part_at(const NurbsSurface& s, const ShapeHit& hit) {
    const PatchPieces& pieces = s.tree->pieces();
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        const Vec2& lo = pieces.lo(k);
        const Vec2& hi = pieces.hi(k);
        if (lo.x <= hit.u && hit.u <= hi.x && lo.y <= hit.v && hit.v <= hi.y) return pieces.part(k);
    }
    return kNoPart;
}

TEST(PatchExport, PatchesComeBackBitForBit) {
    testing::Random random(20);
    for (int i = 0; i < 60; ++i) {
        auto mesh = RandomShape<PatchMesh>::make({random, i % 2 == 1});
        auto patch = RandomShape<BezierPatch>::make({random, i % 2 == 1});
        EXPECT_EQ(nets_of(mesh_of(read_back<ObjImporter>(AnyShape{mesh}))), nets_of(mesh));
        EXPECT_EQ(nets_of(mesh_of(read_back<ObjImporter>(AnyShape{patch}))), nets_of(patch));
        EXPECT_EQ(fits_bpt(AnyShape{mesh}), mesh.weights.empty());
        mesh.weights.clear();
        patch.weights.clear();
        EXPECT_EQ(nets_of(mesh_of(read_back<BptImporter>(AnyShape{mesh}))), nets_of(mesh));
        EXPECT_EQ(nets_of(mesh_of(read_back<BptImporter>(AnyShape{patch}))), nets_of(patch));
    }
}

TEST(PatchExport, SurfacesOfEqualNamesAndOfNoneStayApartInAnObj) {
    testing::Random random(24);
    std::vector<AnyShape> shapes;
    std::vector<NamedSurface> surfaces;
    shapes.reserve(4);
    for (const char* name : {"", "a", "", "a"}) {
        shapes.emplace_back(RandomShape<BezierPatch>::make({random, false}));
        surfaces.push_back({name, &shapes.back(), {}, ""});
    }
    const auto read = testing::import_text<ObjImporter>(obj_surfaces_text(surfaces), "a.obj");
    ASSERT_EQ(read.parts().size(), 4u) << read.messages();
    EXPECT_EQ(read.parts()[1].name, "a");
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& mesh = std::get<PatchMesh>(std::get<AnyShape>(read.parts()[i].what));
        EXPECT_EQ(nets_of(mesh), nets_of(std::get<BezierPatch>(shapes[i])));
    }
}

TEST(PatchExport, NurbsSurfacesComeBackWithTheirLoops) {
    testing::Random random(21);
    for (int i = 0; i < 60; ++i) {
        auto s = RandomShape<NurbsSurface>::make({random, i % 2 == 1});
        const auto read = read_back<ObjImporter>(AnyShape{s});
        auto back = std::get<NurbsSurface>(std::get<AnyShape>(read.parts().at(0).what));
        // Curves of the file have knots.
        ASSERT_EQ(back.trims.size(), s.trims.size());
        for (std::size_t k = 0; k < s.trims.size(); ++k) {
            ASSERT_EQ(back.trims[k].size(), s.trims[k].size());
            for (std::size_t c = 0; c < s.trims[k].size(); ++c) {
                EXPECT_EQ(back.trims[k][c].points, s.trims[k][c].points);
                EXPECT_EQ(back.trims[k][c].weights, s.trims[k][c].weights);
            }
        }
        back.trims = s.trims = {};
        EXPECT_TRUE(testing::same(back, s)) << i;
    }
}

TEST(PatchExport, AMirroringPlacementReversesU) {
    testing::Random random(22);
    auto patch = RandomShape<BezierPatch>::make({random, false});
    const Affine mirror = Affine::scale({-1, 1, 1});
    const auto check = [&](const testing::Imported& read) {
        const BezierNet own = patch.net(), net = mesh_of(read).net(0);
        ASSERT_EQ(net.degree_u, own.degree_u);
        ASSERT_EQ(net.degree_v, own.degree_v);
        for (int i = 0; i <= own.degree_u; ++i) {
            for (int j = 0; j <= own.degree_v; ++j) {
                EXPECT_EQ(projected(net.at(own.degree_u - i, j)),
                          mirror.point(projected(own.at(i, j))));
            }
        }
    };
    check(read_back<ObjImporter>(AnyShape{patch}, mirror));
    patch.weights.clear();  // a .bpt file has none
    check(read_back<BptImporter>(AnyShape{patch}, mirror));
}

TEST(PatchExport, AMirroredNurbsSurfaceReversesItsKnotsAndLoops) {
    testing::Random random(23);
    const Affine mirror = Affine::scale({1, 1, -1});
    for (int i = 0; i < 60; ++i) {
        auto s = RandomShape<NurbsSurface>::make({random, i % 2 == 1});
        const auto read = read_back<ObjImporter>(AnyShape{s}, mirror);
        auto back = std::get<NurbsSurface>(std::get<AnyShape>(read.parts().at(0).what));
        s.prepare();
        back.prepare();
        ASSERT_EQ(back.knots_v, s.knots_v);
        for (int k = 0; k < 20; ++k) {
            const double u = random.uniform(), v = random.uniform();
            const Vec2 lo{s.knots_u[s.degree_u], s.knots_v[s.degree_v]};
            const Vec2 hi{s.knots_u[s.knots_u.size() - s.degree_u - 1],
                          s.knots_v[s.knots_v.size() - s.degree_v - 1]};
            ShapeHit hit, other;
            hit.u = lo.x + u * (hi.x - lo.x);
            hit.v = lo.y + v * (hi.y - lo.y);
            other = hit;
            other.u = -hit.u;
            EXPECT_EQ(back.keeps(other), s.keeps(hit));
            hit.part = part_at(s, hit);
            other.part = part_at(back, other);
            // Pieces that the loops remove are not stored.
            if (hit.part == kNoPart || other.part == kNoPart) continue;
            const ShapeSurface here = s.surface(Ray{}, hit), there = back.surface(Ray{}, other);
            EXPECT_LT(length(mirror.point(here.point) - there.point),
                      1e-9 * (1 + length(here.point)));
            EXPECT_NEAR(there.uv.x, 1.0 - here.uv.x, 1e-12);
            EXPECT_NEAR(there.uv.y, here.uv.y, 1e-12);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE

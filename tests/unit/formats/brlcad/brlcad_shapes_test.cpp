/// Solids of BRL-CAD at the limits of their definitions.

#include "alhazen/formats/brlcad/brlcad_shapes.h"

#include <gtest/gtest.h>

#include "alhazen/formats/brlcad/brlcad_importer.h"
#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

BrlcadPieces pieces_of(auto form) {
    BrlcadSolid solid;
    solid.form = std::move(form);
    return brlcad_pieces(solid);
}

TEST(BrlcadShapes, AParticleOneOfWhoseSpheresHoldsTheOtherIsThatSphere) {
    struct Case {
        double height, base, top;
        double radius, z;  ///< of the sphere
    };
    for (const Case& c : {Case{0, 1, 1, 1, 0}, Case{0, 2, 1, 2, 0}, Case{0, 1, 2, 2, 0},
                          Case{1, 2, 1, 2, 0}, Case{1, 1, 2, 2, 1}, Case{0.5, 2, 1, 2, 0}}) {
        const BrlcadPieces made =
            pieces_of(BrlcadParticle{{0, 0, 0}, {0, 0, c.height}, c.base, c.top});
        EXPECT_EQ(made.refused, "");
        ASSERT_EQ(made.pieces.size(), 1u) << c.height << " " << c.base << " " << c.top;
        const auto& sphere = std::get<Sphere>(std::get<AnyShape>(made.pieces[0].what));
        EXPECT_EQ(sphere.radius, c.radius);
        EXPECT_EQ(sphere.center.z, c.z);
    }
    EXPECT_NE(pieces_of(BrlcadParticle{{0, 0, 0}, {0, 0, 0}, 0, 0}).refused, "");
    EXPECT_EQ(pieces_of(BrlcadParticle{{0, 0, 0}, {0, 0, 2}, 1, 1}).pieces.size(), 3u);
}

TEST(BrlcadShapes, AxesThatContradictTheDefinitionAreDoubted) {
    const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, o{};
    EXPECT_EQ(pieces_of(BrlcadTgc{o, z, x, y, 2.0 * x, y}).doubt, "");
    EXPECT_EQ(pieces_of(BrlcadTgc{o, z, x, y, o, y}).doubt, "");
    EXPECT_NE(pieces_of(BrlcadTgc{o, z, x, y, 2.0 * y, x}).doubt, "");
    EXPECT_EQ(pieces_of(BrlcadEllipsoid{o, x, 3.0 * y, z}).doubt, "");
    EXPECT_NE(pieces_of(BrlcadEllipsoid{o, x, x + y, z}).doubt, "");
    EXPECT_EQ(pieces_of(BrlcadConicCylinder{o, z, y, 1, 0, false}).doubt, "");
    EXPECT_NE(pieces_of(BrlcadConicCylinder{o, z, y + z, 1, 0, false}).doubt, "");
}

TEST(BrlcadShapes, DoubtsAreWarningsAtTheSolid) {
    const std::string text =
        "put ball ell V {0 0 0} A {2 0 0} B {2 2 0} C {0 0 2}\n"
        "put r comb region yes tree {u {l ball} {l ball}}\n";
    Diagnostics found;
    (void)BrlcadImporter().import({text, "a.asc", {}}, found);
    EXPECT_EQ(found.warning_count(), 1u) << testing::text_of(found);
    EXPECT_TRUE(testing::mentions(
        found, "a.asc:1:1: warning: solid 'ball' (ell): its semi-axes are not perpendicular"))
        << testing::text_of(found);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE

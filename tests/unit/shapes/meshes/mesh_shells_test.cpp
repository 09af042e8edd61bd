#include "alhazen/shapes/meshes/mesh_shells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "alhazen/geometry/box.h"
#include "support/box_mesh.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::add_box;
using testing::Random;

struct Shell {
    Box3 box;
    bool inward;
};

TriangleMesh mesh_of(const std::vector<Shell>& shells) {
    TriangleMesh mesh;
    for (const Shell& shell : shells) add_box(mesh, shell.box, shell.inward);
    return mesh;
}

bool lies_in(const Box3& inner, const Box3& outer) {
    const Vec3 low = inner.lo - outer.lo, high = outer.hi - inner.hi;
    return std::min({low.x, low.y, low.z, high.x, high.y, high.z}) > 0.0;
}
bool are_apart(const Box3& a, const Box3& b) {
    return max_component(a.lo - b.hi) > 0.0 || max_component(b.lo - a.hi) > 0.0;
}

/// The same triangles, each with vertices of its own.
TriangleMesh soup_of(const TriangleMesh& mesh) {
    TriangleMesh soup;
    for (const auto& triangle : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(soup.positions.size());
        for (const std::uint32_t v : triangle) soup.positions.push_back(mesh.positions[v]);
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    return soup;
}

const Box3 kLarge{{-4, -4, -4}, {4, 4, 4}}, kMiddle{{-2, -2, -2}, {2, 2, 2}},
    kSmall{{-1, -1, -1}, {1, 1, 1}}, kBeside{{6, -1, -1}, {8, 1, 1}};

TEST(MeshShells, AShellFacesInwardUnlessItIsACavity) {
    const struct {
        std::vector<Shell> shells;
        bool inward;
    } cases[] = {
        {{}, false},
        {{{kLarge, false}}, false},
        {{{kLarge, true}}, true},
        {{{kLarge, false}, {kBeside, false}}, false},
        {{{kLarge, false}, {kBeside, true}}, true},
        {{{kBeside, true}, {kLarge, false}}, true},
        {{{kLarge, false}, {kSmall, true}}, false},
        {{{kLarge, true}, {kSmall, false}}, true},
        {{{kLarge, false}, {kMiddle, true}, {kSmall, false}}, false},
        {{{kLarge, false}, {kMiddle, true}, {kSmall, true}}, true},
        {{{kLarge, false}, {kMiddle, false}, {kSmall, true}}, false},
    };
    for (const auto& c : cases) {
        for (const double away : {0.0, 0.3, 1e12}) {
            TriangleMesh mesh = mesh_of(c.shells);
            mesh.transform(Affine::translate({away, -away, away}));
            EXPECT_EQ(has_inward_shell(mesh), c.inward) << &c - cases << " at " << away;
            EXPECT_EQ(has_inward_shell(soup_of(mesh)), c.inward) << &c - cases << " at " << away;
        }
    }
}

TEST(MeshShells, ShellsThatTouchInAVertexAreTwo) {
    const auto at_corner = [](double size) { return Box3{{1, 1, 1}, Vec3{1, 1, 1} * (1 + size)}; };
    // Inside at a corner of the large box, of which three faces are flush.
    const Box3 flush{{1, 1, 1}, {4, 4, 4}};
    const struct {
        std::vector<Shell> shells;
        bool inward;
    } cases[] = {
        {{{kSmall, false}, {at_corner(1), true}}, true},
        {{{kSmall, false}, {at_corner(2), true}}, true},
        {{{at_corner(0.5), true}, {kSmall, false}}, true},
        {{{kSmall, false}, {at_corner(2), false}}, false},
        {{{kLarge, false}, {kSmall, true}, {at_corner(2), true}}, false},
        {{{kLarge, false}, {flush, true}}, false},
        {{{flush, true}, {kLarge, false}}, false},
    };
    for (const auto& c : cases) {
        for (const double turn : {0.0, 1.0, 2.0, 3.0}) {
            TriangleMesh mesh = mesh_of(c.shells);
            // The order of vertices and triangles relative to the axes.
            mesh.transform(Affine::rotate({0, 0, 1}, turn * 1.5707963267948966));
            for (Vec3& v : mesh.positions)
                v = {std::round(v.x * 2) / 2, std::round(v.y * 2) / 2, v.z};
            EXPECT_EQ(has_inward_shell(mesh), c.inward) << &c - cases << " " << turn;
            EXPECT_EQ(has_inward_shell(soup_of(mesh)), c.inward) << &c - cases << " " << turn;
            std::reverse(mesh.triangles.begin(), mesh.triangles.end());
            EXPECT_EQ(has_inward_shell(mesh), c.inward) << &c - cases << " " << turn;
        }
    }
}

TEST(MeshShells, TrianglesWithoutAreaJoinNone) {
    // The boxes touch in vertices 7 and 8.
    const TriangleMesh boxes =
        mesh_of({{{{0, 0, 0}, {2, 2, 2}}, false}, {{{2, 2, 2}, {3, 3, 3}}, true}});
    const std::vector<std::vector<std::array<std::uint32_t, 3>>> added{
        {}, {{7, 7, 3}}, {{7, 7, 3}, {8, 8, 9}}, {{7, 8, 3}, {8, 7, 9}}, {{7, 7, 7}, {8, 8, 8}}};
    for (const auto& triangles : added) {
        TriangleMesh mesh = boxes;
        mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
        EXPECT_TRUE(has_inward_shell(mesh)) << &triangles - added.data();
    }
    // Points on all vertices of the inward box.
    TriangleMesh points = boxes;
    for (std::uint32_t v = 8; v < 16; ++v) points.triangles.push_back({v, v, v});
    EXPECT_TRUE(has_inward_shell(points));
}

TEST(MeshShells, OnlyClosedAndOrientedMeshesHaveAnInside) {
    TriangleMesh open = mesh_of({{kLarge, true}}), crooked = open;
    open.triangles.pop_back();
    std::swap(crooked.triangles[0][0], crooked.triangles[0][1]);
    EXPECT_FALSE(has_inward_shell(open));
    EXPECT_FALSE(has_inward_shell(crooked));
    // A sheet of two sides in a plane in general position.
    TriangleMesh flat{.positions = {{0.1, 0.2, 0.3}, {1.7, 0.3, 1.1}, {0.3, 1.9, 0.7}},
                      .triangles = {{0, 1, 2}, {0, 2, 1}}};
    EXPECT_FALSE(has_inward_shell(flat));
}

TEST(MeshShells, BoxesInAndBesideBoxesAreCountedByTheirWindingNumber) {
    Random random(17);
    const auto whole = [&](double lo, double hi) { return std::floor(random.uniform(lo, hi)); };
    int inward = 0;
    for (int trial = 0; trial < 300; ++trial) {
        // Boxes with whole coordinates, of which two lie one in the other or apart.
        std::vector<Shell> shells;
        for (int i = 0; i < 60; ++i) {
            const Vec3 lo{whole(0, 12), whole(0, 12), whole(0, 12)};
            const Box3 box{lo, lo + Vec3{whole(1, 9), whole(1, 9), whole(1, 9)}};
            const bool fits = std::all_of(shells.begin(), shells.end(), [&](const Shell& other) {
                return lies_in(box, other.box) || lies_in(other.box, box) ||
                       are_apart(box, other.box);
            });
            if (fits) shells.push_back({box, false});
        }
        // A solid with cavities, of which few faces are turned.
        for (Shell& shell : shells) {
            const auto around =
                std::count_if(shells.begin(), shells.end(),
                              [&](const Shell& other) { return lies_in(shell.box, other.box); });
            shell.inward = (around % 2 == 1) != (random.uniform() < 0.02);
        }
        bool expected = false;
        for (const Shell& shell : shells) {
            int winding = 0;
            for (const Shell& other : shells) {
                if (lies_in(shell.box, other.box)) winding += other.inward ? -1 : 1;
            }
            expected = expected || (shell.inward && winding <= 0);
        }
        inward += expected;
        ASSERT_EQ(has_inward_shell(mesh_of(shells)), expected) << trial;
    }
    EXPECT_GT(inward, 30);
    EXPECT_LT(inward, 270);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE

// Volumes that rest on an opaque floor: their faces at its place are off by the rounding of their
// placements.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/primitives/surface.h"
#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

constexpr double kRightAngle = 90 * kPi / 180;

TriangleMesh quad(double size, double height) {
    TriangleMesh mesh;
    mesh.positions = {
        {-size, -size, height}, {size, -size, height}, {size, size, height}, {-size, size, height}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}
TriangleMesh cube(double half) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.positions.push_back(
            {i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half});
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

enum class Floor { Rectangle, Disc, Plane, Mesh };
constexpr Floor kFloors[] = {Floor::Rectangle, Floor::Disc, Floor::Plane, Floor::Mesh};
enum class Block { Box, Mesh, Instance };

void add_floor(SceneMaker& maker, Floor floor, double size, double height) {
    const MaterialId white = maker.material(matt({1, 1, 1}));
    if (floor == Floor::Mesh) return maker.add(maker.mesh(quad(size, height)), white);
    if (floor == Floor::Plane) return maker.add(Plane{{0, 0, height}, {0, 0, 1}}, white);
    if (floor == Floor::Disc) {
        Disc disc;
        disc.center = {0, 0, height};
        disc.radius = size;
        return maker.add(disc, white);
    }
    maker.add(rectangle({-size, -size, height}, {2 * size, 0, 0}, {0, 2 * size, 0}), white);
}

/// Adds a cube around the origin whose placement puts it onto the floor.
void add_block(SceneMaker& maker, Block block, double half, const Affine& placement) {
    const double density = 0.5 / half;
    const MaterialId clear = maker.material(fog({density, density, density}, {}));
    const Vec3 corner{half, half, half};
    if (block == Block::Mesh) return maker.add(maker.mesh(cube(half)), clear, placement);
    if (block == Block::Box) return maker.add(BoxShape{-corner, corner}, clear, placement);
    const ObjectIndex owner = maker.object("block");
    maker.add(BoxShape{-corner, corner}, clear, {}, owner);
    maker.add(owner, MaterialId{0}, placement);
}

/// Rotations whose matrices are those of right angles but for their rounding.
std::vector<Affine> rotations() {
    const auto times = [](int n, const Vec3& axis) {
        Affine all;
        for (int i = 0; i < n; ++i) all = Affine::rotate(axis, kRightAngle / n) * all;
        return all;
    };
    const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    return {{},
            Affine::rotate(x, kRightAngle),
            Affine::rotate(x, -kRightAngle),
            Affine::rotate(y, kRightAngle),
            Affine::rotate(x, 2 * kRightAngle),
            Affine::rotate(z, 0.3),
            Affine::rotate({1, 1, 1}, 4 * kRightAngle / 3),
            times(2, y),
            times(3, x),
            times(9, x)};
}

/// The square around the origin or next to it, seen from above; absorption dims light by exp(-1) on
/// its way down, and up again.
void expect_dimmed_once(SceneMaker& maker, Floor floor, double height, double half,
                        const Vec3& place, const std::string& name) {
    const bool reaches_infinity = floor == Floor::Plane;
    const double side = 1.2 * half;
    maker.description().cameras[0].camera = OrthographicCamera{
        {place.x, place.y, height + 8 * half}, {0, 0, -1}, {side, 0, 0}, {0, side, 0}};
    maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
    // Of `whitted`.
    maker.description().conventions.shading.optics = {true, true};
    const Scene scene = maker.compile();
    std::vector<const char*> renderers{"path_tracing", "whitted"};
    // Paths from the light all over a plane do not reach the lens.
    if (!reaches_infinity) renderers.push_back("bidirectional");
    for (const char* renderer : renderers) {
        const Film film = picture_of(scene, renderer, 4, 1);
        for (int i = 0; i < 16; ++i) {
            EXPECT_NEAR(film.at(i % 4, i / 4).g, std::exp(-2.0), 1e-5)
                << name << ", " << renderer << ", pixel " << i;
        }
    }
}

TEST(RestingVolumes, TurnedBlocksOnAFloorAreEnteredOnce) {
    const std::vector<Affine> turns = rotations();
    for (const double height : {0.0, 1e-6, 1e-3, 1.0, 1e6}) {
        for (const double half : {1.0, 0.07}) {
            for (std::size_t turn = 0; turn < turns.size(); ++turn) {
                const double up = height + half;
                const std::pair<Vec3, Affine> places[] = {
                    {{0.11 * half, -0.07 * half, 0}, Affine::translate({0, 0, up})},
                    {{0.3 * half, -0.7 * half, 0},
                     Affine::translate({0.3 * half, -0.7 * half, up - 0.3 * half}) *
                         Affine::translate({0, 0, 0.2 * half}) *
                         Affine::translate({0, 0, 0.1 * half})}};
                for (const auto& [place, shift] : places) {
                    for (const Floor floor : kFloors) {
                        // Of a plane, bounds near the origin are less than what the block's
                        // placement rounds, the more the more rotations it is the product of.
                        const bool is_near = place.y > -0.5 * half || turn + 1 == turns.size();
                        if (floor == Floor::Plane && is_near) continue;
                        for (const Block block : {Block::Box, Block::Mesh, Block::Instance}) {
                            SceneMaker maker;
                            add_floor(maker, floor, 9 * half, height);
                            add_block(maker, block, half, shift * turns[turn]);
                            expect_dimmed_once(maker, floor, height, half, place,
                                               "height " + std::to_string(height) + ", half " +
                                                   std::to_string(half) + ", turn " +
                                                   std::to_string(turn) + ", place " +
                                                   std::to_string(place.x) + ", floor " +
                                                   std::to_string(int(floor)) + ", block " +
                                                   std::to_string(int(block)));
                        }
                    }
                }
            }
        }
    }
}

/// Of meshes, triangles with a size of 9 err by more, as shapes do along the normal: 96 ulps.
TEST(RestingVolumes, BlocksSlightlyAboveAFloorAreApart) {
    for (const double height : {0.0, 1e-6, 1e-3, 1.0, 1e6}) {
        const double largest = std::max(9.0, height);
        for (const double ulps : {height > 9.0 ? 100.0 : 64.0, 1e3, 1e6}) {
            const double gap = ulps * 0x1p-52 * largest;
            for (const Floor floor : {Floor::Rectangle, Floor::Disc, Floor::Plane}) {
                const std::string name = "height " + std::to_string(height) + ", ulps " +
                                         std::to_string(ulps) + ", floor " +
                                         std::to_string(int(floor));
                SceneMaker maker;
                add_floor(maker, floor, 9.0, height);
                const MaterialId clear = maker.material(fog({0.5, 0.5, 0.5}, {}));
                maker.add(BoxShape{{-1, -1, height + gap}, {1, 1, height + gap + 2}}, clear);
                expect_dimmed_once(maker, floor, height, 1.0, {0.11, -0.07, 0}, name);
                // A sheet as close hides the floor from light.
                SceneMaker covered;
                add_floor(covered, floor, 9.0, height);
                covered.add(rectangle({-1, -1, height + gap}, {2, 0, 0}, {0, 2, 0}),
                            covered.material({}));
                const Scene scene = covered.compile();
                const Ray up{{0.3, 0.2, height - 5}, {0, 0, 1}};
                Hit hit;
                ASSERT_TRUE(scene.aggregate->closest(up, hit, nullptr)) << name;
                const Surface surface = surface_at(*scene.aggregate, up, hit);
                EXPECT_TRUE(scene.aggregate->occluded(leaving_ray(surface, {0, 0, 1}), nullptr))
                    << name;
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE

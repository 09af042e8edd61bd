#pragma once
/// Solids with known volume, area, centroid and moments, for the tests of measures.

#include <string>
#include <vector>

#include "alhazen/solids/isolated_solid.h"
#include "support/scene_maker.h"

namespace alhazen::testing {

struct KnownSolid {
    std::string name;
    AnyShape shape;
    Affine placement;
    double volume = 0, area = 0;
    Vec3 centroid;
    Vec3 inertia;  ///< diagonal about the centroid, density 1, for placements that only translate
};

inline std::vector<KnownSolid> known_solids() {
    constexpr double pi = 3.14159265358979323846;
    const Affine turned = Affine::rotate({1, 2, 3}, 0.7);
    const Vec3 at{3, -2, 5};
    const double cone_volume = pi * 4.0 / 3;
    const double cone_x = 3.0 / 80 * cone_volume * (4 * 1 + 16);
    std::vector<KnownSolid> all;
    all.push_back({"sphere",
                   Sphere{at, 2},
                   {},
                   32 * pi / 3,
                   16 * pi,
                   at,
                   0.4 * 4 * 32 * pi / 3 * Vec3{1, 1, 1}});
    all.push_back({"box",
                   BoxShape{at, at + Vec3{1, 2, 3}},
                   {},
                   6,
                   22,
                   at + Vec3{0.5, 1, 1.5},
                   Vec3{13 / 2.0, 10 / 2.0, 5 / 2.0}});
    all.push_back({"turned box",
                   BoxShape{{-1, -1, -1}, {1, 1, 2}},
                   turned,
                   12,
                   32,
                   turned.point({0, 0, 0.5}),
                   {}});
    all.push_back({"cylinder",
                   Cylinder{{0, 0, 0}, {0, 0, 3}, 1},
                   {},
                   3 * pi,
                   8 * pi,
                   {0, 0, 1.5},
                   3 * pi * Vec3{1, 1, 0.5}});
    all.push_back({"turned cylinder",
                   Cylinder{{0, 0, 0}, {0, 0, 3}, 1},
                   turned,
                   3 * pi,
                   8 * pi,
                   turned.point({0, 0, 1.5}),
                   {}});
    all.push_back({"cone",
                   Cone{{0, 0, 0}, {0, 0, 4}, 1, 0},
                   {},
                   cone_volume,
                   pi * (1 + std::sqrt(17.0)),
                   {0, 0, 1},
                   {cone_x, cone_x, 0.3 * cone_volume}});
    // Far from the origin: rounding is larger than a relative one of the volume.
    const Vec3 far{1000, -2000, 3000};
    all.push_back({"plate",
                   BoxShape{far, far + Vec3{0.5, 0.25, 0.0078125}},
                   {},
                   0.0009765625,
                   2 * (0.125 + 0.00390625 + 0.001953125),
                   far + Vec3{0.25, 0.125, 0.00390625},
                   {}});
    return all;
}

/// A scene of one solid.
struct LoneScene {
    explicit LoneScene(const KnownSolid& known)
        : solids([&] {
              SceneMaker maker;
              std::visit([&](const auto& s) { maker.add(s, MaterialId{0}, known.placement); },
                         known.shape);
              return maker.compile().aggregate;
          }()),
          solid(solids, SolidId{0}) {}

    SolidList solids;
    IsolatedSolid solid;
};

}  // namespace alhazen::testing

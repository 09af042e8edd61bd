#include "alhazen/session/generators/field.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/sampling/random.h"
#include "alhazen/session/generators/generated_scene.h"

namespace alhazen {

namespace {

constexpr int kBlades = 125, kTrianglesOfBlade = 8;
constexpr std::uint64_t kTuftTriangles = kBlades * kTrianglesOfBlade;
constexpr double kTuftWidth = 0.3;
constexpr std::uint64_t kFieldSide = 10;  ///< of a patch in tufts, of a plot in patches, ...
constexpr std::size_t kVariants = 4;
/// Maximum number of top-level units laid out in rows.
constexpr std::uint64_t kMaxRows = 4096;

using Variants = std::array<ObjectIndex, kVariants>;

VertexColor color(double r, double g, double b) {
    return {static_cast<float>(r), static_cast<float>(g), static_cast<float>(b), 1};
}

/// Four quadrilaterals along a bent blade, the last one narrow at the tip.
void add_blade(RandomStream& random, const Vec3& root, TriangleMesh& mesh) {
    const double heading = random.uniform(0, 2 * kPi), height = random.uniform(0.14, 0.34);
    const double lean = random.uniform(0.02, 0.16), width = random.uniform(0.004, 0.009);
    const Vec3 forward{std::cos(heading), std::sin(heading), 0};
    const Vec3 side{-forward.y, forward.x, 0};
    const double fresh = random.uniform();
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i <= 4; ++i) {
        const double s = i / 4.0;
        const Vec3 middle =
            root + (lean * s * s) * forward + Vec3{0, 0, height * (s - 0.2 * s * s)};
        const Vec3 half = (0.5 * width * (1.0 - 0.9 * s * s)) * side;
        mesh.positions.push_back(middle - half);
        mesh.positions.push_back(middle + half);
        const VertexColor c = color(0.15 + 0.35 * s * fresh, 0.35 + 0.6 * s, 0.08 + 0.1 * s);
        mesh.colors.insert(mesh.colors.end(), 2, c);
    }
    for (std::uint32_t i = 0; i < 8; i += 2) {
        const std::uint32_t a = first + i;
        mesh.triangles.push_back({a, a + 1, a + 3});
        mesh.triangles.push_back({a + 3, a + 2, a});
    }
}

/// Stem of two triangles and six petals.
void add_flower(RandomStream& random, const Vec3& root, TriangleMesh& mesh) {
    const double height = random.uniform(0.26, 0.40), radius = random.uniform(0.012, 0.02);
    const double turn = random.uniform(0, 2 * kPi);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Vec3 top = root + Vec3{0, 0, height};
    const Vec3 half{0.0015 * std::cos(turn), 0.0015 * std::sin(turn), 0};
    for (const Vec3& p : {root - half, root + half, top + half, top - half}) {
        mesh.positions.push_back(p);
        mesh.colors.push_back(color(0.2, 0.4, 0.1));
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first + 2, first + 3, first});
    const bool yellow = random.uniform() < 0.5;
    const auto at_angle = [&](double a) {
        return top + Vec3{radius * std::cos(a), radius * std::sin(a), 0.4 * radius};
    };
    for (int petal = 0; petal < 6; ++petal) {
        const double a = turn + 2 * kPi * petal / 6;
        const auto n = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec3& p : {top, at_angle(a), at_angle(a + 0.9)}) mesh.positions.push_back(p);
        mesh.colors.push_back(color(0.8, 0.55, 0.1));
        const VertexColor c = yellow ? color(0.95, 0.85, 0.2) : color(0.95, 0.95, 0.98);
        mesh.colors.insert(mesh.colors.end(), 2, c);
        mesh.triangles.push_back({n, n + 1, n + 2});
    }
}

TriangleMesh tuft_mesh(RandomStream& random, int flowers) {
    TriangleMesh mesh;
    for (int i = 0; i < kBlades; ++i) {
        const Vec3 root{random.uniform(-0.5, 0.5) * kTuftWidth,
                        random.uniform(-0.5, 0.5) * kTuftWidth, 0};
        if (i < flowers) {
            add_flower(random, root, mesh);
        } else {
            add_blade(random, root, mesh);
        }
    }
    return mesh;
}

/// Columns and rows of units, from y = 0 on and to both sides of x = 0.
struct Rows {
    std::uint64_t columns, rows;
    double unit;  ///< side of a unit
    [[nodiscard]] Vec3 middle(std::uint64_t c, std::uint64_t r) const {
        return {unit * (static_cast<double>(c) + 0.5 - 0.5 * static_cast<double>(columns)),
                unit * (static_cast<double>(r) + 0.5), 0};
    }
};

/// Rotates tufts by any angle, larger units by one of the four quarter turns that keep the rows.
Part placed(const Variants& units, const Vec3& at, bool tufts, RandomStream& random) {
    const ObjectIndex unit = units[random.below(kVariants)];
    Affine place = Affine::translate(at);
    if (tufts) {
        const double jitter = 0.2 * kTuftWidth, size = random.uniform(0.75, 1.2);
        place = place *
                Affine::translate(
                    {random.uniform(-jitter, jitter), random.uniform(-jitter, jitter), 0}) *
                Affine::rotate({0, 0, 1}, random.uniform(0, 2 * kPi)) *
                Affine::scale({size, size, size});
    } else {
        static constexpr double kCos[] = {1, 0, -1, 0}, kSin[] = {0, 1, 0, -1};
        const std::uint64_t quarter = random.below(4);
        const double c = kCos[quarter], s = kSin[quarter];
        place.linear = Mat3{{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
    }
    return part_of(unit, place);
}

void lay_out(SceneDescription& scene, ObjectIndex object, const Rows& rows, const Vec3& shift,
             const Variants& units, bool tufts, RandomStream& random) {
    for (std::uint64_t r = 0; r < rows.rows; ++r) {
        for (std::uint64_t c = 0; c < rows.columns; ++c) {
            scene.objects[static_cast<std::size_t>(object)].parts.push_back(
                placed(units, rows.middle(c, r) + shift, tufts, random));
        }
    }
}

/// Puts the rows into an object of their own, separate from the ground, so that they can have a
/// grid.
Rows make_field(std::uint64_t triangles, SceneDescription& scene) {
    scene = generated_scene({{0.3, -1.0, 1.1}, {0, 5, 0.25}, 40});
    scene.picture.background = Rgb{0.55, 0.7, 0.9};
    const MaterialId plants = add_material(scene, "plants", {1, 1, 1});
    const MaterialId soil = add_material(scene, "soil", {0.16, 0.2, 0.07});
    scene.objects.front().parts.push_back(part_of(Plane{}, soil));

    RandomStream random(7);
    Variants units;
    for (std::size_t i = 0; i < kVariants; ++i) {
        units[i] = add_object(scene, "tuft");
        const MeshIndex mesh = add_mesh(scene, "tuft", tuft_mesh(random, 2 * static_cast<int>(i)));
        scene.objects[static_cast<std::size_t>(units[i])].parts.push_back(part_of(mesh, plants));
    }
    double width = kTuftWidth;
    std::uint64_t size = kTuftTriangles;
    bool tufts = true;
    const auto count = [&] { return (triangles - 1) / size + 1; };
    for (; count() > kMaxRows;
         size *= kFieldSide * kFieldSide, width *= kFieldSide, tufts = false) {
        Variants larger;
        for (ObjectIndex& object : larger) {
            object = add_object(scene, "plot");
            const Vec3 to_middle{0, -0.5 * width * kFieldSide, 0};
            lay_out(scene, object, {kFieldSide, kFieldSide, width}, to_middle, units, tufts,
                    random);
        }
        units = larger;
    }
    const auto columns = static_cast<std::uint64_t>(std::ceil(std::sqrt(count())));
    const Rows rows{columns, (count() - 1) / columns + 1, width};
    const ObjectIndex all = add_object(scene, "rows");
    lay_out(scene, all, rows, {0, 0, 0}, units, tufts, random);
    scene.objects.front().parts.push_back(part_of(all, Affine{}));
    return rows;
}

}  // namespace

SceneDescription field(std::uint64_t triangles) {
    SceneDescription scene;
    (void)make_field(triangles, scene);
    return scene;
}

SceneDescription field_of_grids(std::uint64_t triangles) {
    SceneDescription scene;
    const Rows rows = make_field(triangles, scene);
    const auto grid_of = [](std::uint64_t columns, std::uint64_t lines) {
        return fmt::format("uniform_grid:nx={},ny={},nz=1", columns, lines);
    };
    for (ObjectDescription& object : scene.objects) {
        if (object.name == "tuft") object.accelerator = "uniform_grid";
        if (object.name == "plot") object.accelerator = grid_of(kFieldSide, kFieldSide);
        if (object.name == "rows") object.accelerator = grid_of(rows.columns, rows.rows);
    }
    return scene;
}

}  // namespace alhazen

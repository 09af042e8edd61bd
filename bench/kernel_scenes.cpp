#include "kernel_scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "alhazen/base/error.h"
#include "alhazen/formats/mesh_files/mesh_io.h"
#include "mesh_makers.h"

namespace alhazen::bench {

namespace {

/// A sphere of the sphereflake and its parent.
struct Ball {
    Vec3 center;
    double radius;
    Vec3 parent_center;
    bool is_root;
};

/// Visits a sphere and, around it, nine spheres of a third of its radius: six around the equator,
/// three above, at a distance of `gap` times their radius. Source: Haines, "A Proposal for Standard
/// Graphics Environments", IEEE CG&A 7(11), 1987; the directions of the children differ, the
/// clustering is the same.
void flake(const Ball& ball, const Vec3& axis, double gap, int depth,
           const std::function<void(const Ball&)>& visit) {
    visit(ball);
    if (depth == 0) return;
    const Vec3 u = perpendicular(axis);
    const Vec3 v = cross(axis, u);
    const double small = ball.radius / 3.0;
    for (int i = 0; i < 9; ++i) {
        const bool equator = i < 6;
        const double around = equator ? i * 1.0471975511965976 : (i - 6) * 2.0943951023931953 + 0.5;
        const double up = equator ? 0.0 : 0.8660254037844386;
        const double out = std::sqrt(1.0 - up * up);
        const Vec3 d = out * (std::cos(around) * u + std::sin(around) * v) + up * axis;
        const Vec3 center = ball.center + (ball.radius + (1.0 + gap) * small) * d;
        flake({center, small, ball.center, false}, d, gap, depth - 1, visit);
    }
}

const Ball kRoot{{0, 0, 0}, 0.5, {0, 0, 0}, true};

/// A floor under the balls, and a view of them.
KernelScene scene_of_balls(const std::string& name) {
    KernelScene scene;
    scene.name = name;
    scene.eye = {2.1, 1.3, 1.7};
    scene.light = {12, 28, 2};
    scene.ray_start = 1e-4;
    for (const double x : {-12.0, 12.0}) {
        for (const double y : {-12.0, 12.0}) scene.mesh.positions.push_back({x, y, -0.5});
    }
    scene.mesh.triangles = {{0, 2, 3}, {0, 3, 1}};
    return scene;
}

Sphere float_sphere(const Ball& ball) {
    return {to_float(ball.center), to_float(ball.radius)};
}

KernelScene tessellated_balls(const std::string& name, int depth, const TriangleMesh& ball_mesh) {
    KernelScene scene = scene_of_balls(name);
    flake(kRoot, {0, 0, 1}, 0, depth,
          [&](const Ball& ball) { append(scene.mesh, ball_mesh, ball.center, ball.radius); });
    round_to_float(scene.mesh);
    return scene;
}

KernelScene exact_balls(const std::string& name, int depth) {
    KernelScene scene = scene_of_balls(name);
    flake(kRoot, {0, 0, 1}, 0, depth,
          [&](const Ball& ball) { scene.spheres.push_back(float_sphere(ball)); });
    return scene;
}

KernelScene mixed(const std::string& name, int depth) {
    KernelScene scene = scene_of_balls(name);
    scene.eye = 1.3 * scene.eye;
    const TriangleMesh ball_mesh = icosphere(1);
    bool tessellated = false;
    flake(kRoot, {0, 0, 1}, 1.5, depth, [&](const Ball& ball) {
        tessellated = !tessellated;
        if (tessellated) {
            append(scene.mesh, ball_mesh, ball.center, ball.radius);
        } else {
            scene.spheres.push_back(float_sphere(ball));
        }
        if (ball.is_root) return;
        // From the parent's surface to the child's, extended slightly into both.
        const Vec3 d = normalize(ball.center - ball.parent_center);
        Cylinder cylinder;
        cylinder.base = to_float(ball.parent_center + 2.9 * ball.radius * d);
        cylinder.top = to_float(ball.center - 0.9 * ball.radius * d);
        cylinder.radius = to_float(0.3 * ball.radius);
        scene.cylinders.push_back(cylinder);
    });
    round_to_float(scene.mesh);
    return scene;
}

KernelScene read_scene(const std::filesystem::path& file, int splits, bool interior) {
    Diagnostics diagnostics;
    KernelScene scene;
    scene.name = file.stem().string();
    scene.mesh = read_mesh(file, {}, diagnostics);
    diagnostics.throw_if_errors();
    scene.mesh.normals.clear();
    scene.mesh.uvs.clear();
    for (int s = 0; s < splits; ++s) split_triangles(scene.mesh);
    if (splits > 0) scene.name += fmt::format("@{}", splits);
    round_to_float(scene.mesh);
    const Box3 box = scene.mesh.box();
    const Vec3 size = box.size();
    const double diagonal = length(size);
    scene.ray_start = 1e-4 * diagonal;
    scene.look_at = box.center();
    if (interior) {
        const int along = dominant_axis(size);
        scene.eye = box.center();
        scene.eye[along] -= 0.3 * size[along];
        scene.light = box.center() + Vec3{0, 0.2 * size.y, 0};
    } else {
        scene.eye = box.center() + 1.2 * diagonal * normalize(Vec3{0.3, 0.2, 1});
        scene.light = scene.eye + Vec3{0.3 * diagonal, 0.8 * diagonal, 0};
    }
    return scene;
}

/// Returns the number after the last `mark` and removes both from `text`.
int cut_number(std::string& text, char mark, const std::string& spec) {
    const std::size_t at = text.rfind(mark);
    const std::string digits = at == std::string::npos ? "" : text.substr(at + 1);
    if (digits.size() != 1 || digits[0] < '0' || digits[0] > '9') {
        throw Error(ErrorKind::Usage, fmt::format("scene '{}': expected a number from 0 to 9; "
                                                  "scenes are {}",
                                                  spec, kSceneSpecs));
    }
    text.resize(at);
    return digits[0] - '0';
}

}  // namespace

Box3 KernelScene::box() const {
    Box3 box = mesh.box();
    for (const Sphere& s : spheres) box.include(s.box());
    for (Cylinder c : cylinders) {
        c.prepare();
        box.include(c.box());
    }
    return box;
}

std::string KernelScene::contents() const {
    std::string text;
    const auto add = [&](std::size_t count, const char* what) {
        if (count == 0) return;
        if (!text.empty()) text += ", ";
        const std::string digits = fmt::format("{}", count);
        for (std::size_t i = 0; i < digits.size(); ++i) {
            if (i > 0 && (digits.size() - i) % 3 == 0) text += ' ';
            text += digits[i];
        }
        text += fmt::format(" {}", what);
    };
    add(mesh.triangles.size(), "triangles");
    add(spheres.size(), "spheres");
    add(cylinders.size(), "cylinders");
    return text;
}

KernelScene make_scene(const std::string& spec) {
    std::string rest = spec;
    if (spec.starts_with("interior:")) return read_scene(spec.substr(9), 0, true);
    if (spec.starts_with("balls:")) {
        const int splits = cut_number(rest, ':', spec);
        return tessellated_balls(spec, cut_number(rest, ':', spec), icosphere(splits));
    }
    if (spec.starts_with("spheres:")) return exact_balls(spec, cut_number(rest, ':', spec));
    if (spec.starts_with("mixed:")) return mixed(spec, cut_number(rest, ':', spec));
    if (spec.find('@') == std::string::npos) return read_scene(spec, 0, false);
    const int splits = cut_number(rest, '@', spec);
    return read_scene(rest, splits, false);
}

KernelScene mesh_scene(const std::string& name, const std::filesystem::path& file) {
    KernelScene scene = read_scene(file, 0, false);
    scene.name = name;
    return scene;
}

KernelScene growing_balls(std::size_t triangles) {
    constexpr int kDepth = 3;
    constexpr double kBalls = 820;
    const double rings = std::sqrt(static_cast<double>(triangles) / kBalls / 4.0);
    const auto n = static_cast<std::uint32_t>(std::max(2.0, std::round(rings)));
    KernelScene scene = tessellated_balls("growing", kDepth, latitude_ball(n, 2 * n, 0.0));
    // Removes the floor, which most random lines would intersect first.
    scene.mesh.triangles.erase(scene.mesh.triangles.begin(), scene.mesh.triangles.begin() + 2);
    scene.mesh.positions.erase(scene.mesh.positions.begin(), scene.mesh.positions.begin() + 4);
    for (auto& triangle : scene.mesh.triangles) {
        for (std::uint32_t& vertex : triangle) vertex -= 4;
    }
    return scene;
}

}  // namespace alhazen::bench

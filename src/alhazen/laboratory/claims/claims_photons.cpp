/// Experiments G2 and G3 of claims.h: convergence of photon renderers, and conservation of power.

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/laboratory/claims/claim_run.h"
#include "alhazen/laboratory/claims/sampled_pictures.h"
#include "alhazen/math/constants.h"
#include "alhazen/renderers/photons/photon_passes.h"
#include "alhazen/renderers/photons/photon_shooting.h"
#include "alhazen/session/load.h"

namespace alhazen {
namespace {

constexpr double kFloor = 0.01;  ///< albedo; low: the floor returns little light to the glass
constexpr double kHigh = 2.0;    ///< height of the light over the floor

/// A description under construction, without a camera.
struct PhotonScene {
    SceneDescription d;

    PhotonScene() { d.objects.push_back({"root", {}, {}}); }
    std::uint32_t material(const Rgb& diffuse, const Rgb& emission = {}) {
        Material m;
        m.diffuse.color = diffuse;
        m.emission.color = emission;
        d.materials.push_back({m, {}});
        return static_cast<std::uint32_t>(d.materials.size() - 1);
    }
    std::uint32_t glass() {
        Material m;
        m.dielectric = Dielectric{};
        m.index.value = 1.5;
        d.materials.push_back({m, {}});
        return static_cast<std::uint32_t>(d.materials.size() - 1);
    }
    void add(AnyShape shape, std::uint32_t of_material) {
        Part part;
        part.what = std::move(shape);
        part.material = MaterialId{of_material};
        d.objects[0].parts.push_back(std::move(part));
    }
    void camera(const Camera& camera) {
        CameraDescription described;
        described.camera = camera;
        d.cameras.push_back(described);
    }
    void point(const Vec3& at, const Rgb& color) {
        PointLight light{.position = at, .color = color};
        light.attenuation = {0, 0, 1};
        d.lights.push_back({"", light, {}});
    }
};

/// A point light in the middle of a glass ball over a floor. The ball does not refract its light
/// and eventually emits all of it; only photons find the light. The radiance below it is 1.
PhotonScene light_in_glass(double side) {
    PhotonScene scene;
    scene.camera(OrthographicCamera{{0, 0, 0.3}, {0, 0, -1}, {side, 0, 0}, {0, side, 0}});
    scene.add(Rectangle{.corner = {-40, -40, 0}, .edge_u = {80, 0, 0}, .edge_v = {0, 80, 0}},
              scene.material({0, kFloor, 0}));
    scene.add(Sphere{{0, 0, kHigh}, 1.2}, scene.glass());
    const double color = kHigh * kHigh / kFloor;
    scene.point({0, 0, kHigh}, {color, color, color});
    return scene;
}
/// Radiance of the floor at a distance from the point below the light, and its mean over a disc.
double lit(double distance) {
    return std::pow(1.0 + distance * distance / (kHigh * kHigh), -1.5);
}
double lit_disc(double radius) {
    const double share = radius * radius / (kHigh * kHigh);
    return 2.0 / share * (1.0 - 1.0 / std::sqrt(1.0 + share));
}

/// Error of the green channel relative to the exact radiance of each pixel.
struct ErrorOfPicture {
    double rmse = 0, bias = 0;
};
ErrorOfPicture error_of(const Film& film, double side) {
    const int n = film.frame_width();
    ErrorOfPicture error;
    for (int i = 0; i < n * n; ++i) {
        const double x = side * ((i % n + 0.5) / n - 0.5), y = side * ((i / n + 0.5) / n - 0.5);
        const double off = film.at(i % n, i / n).g - lit(std::hypot(x, y));
        error.rmse += off * off / (n * n);
        error.bias += off / (n * n);
    }
    error.rmse = std::sqrt(error.rmse);
    return error;
}

/// Tests the exponent of the RMSE, for discs so small that bias is negligible.
void expect_slope(ClaimRun& run, const Scene& scene, double side, const std::string& renderer,
                  const std::vector<double>& passes, double expected) {
    constexpr int kSide = 24;
    std::vector<double> errors;
    for (const double n : passes) {
        run.step(fmt::format("{}: {} passes", renderer, n));
        const auto made = make_renderer(renderer);
        const Film film = sampled(scene, *made, kSide, static_cast<int>(n)).film;
        errors.push_back(error_of(film, side).rmse);
    }
    const double slope = log_log_slope(passes, errors);
    run.expect(fmt::format("{}: exponent of the RMSE", renderer),
               fmt::format("{:.3f} (RMSE {:.4f} with {} passes, {:.4f} with {})", slope,
                           errors.front(), passes.front(), errors.back(), passes.back()),
               fmt::format("{:.3f} +- 0.05", expected), std::abs(slope - expected) <= 0.05);
}

/// Tests the power that arrives from a light in a black room, relative to its description.
void expect_power(ClaimRun& run, const std::string& what, const PhotonScene& described,
                  PhotonKinds kinds, double power, double tolerance) {
    run.step(what);
    const Scene scene = compile(described.d);
    const Illumination lights(scene);
    const RenderJob job{.scene = scene, .camera = scene.cameras[0].camera, .control = {1}};
    const PhotonShot shot{.count = 100000, .kinds = kinds, .depth = 1000, .seed = 5};
    double sum = 0.0;
    for (const Photon& photon : shoot_photons(job, lights, shot, 1u << 24, "photons").photons) {
        sum += photon.light().b;
    }
    run.expect(what + ": power that arrives over what was sent", fmt::format("{:.5f}", sum / power),
               fmt::format("1 +- {}", tolerance), std::abs(sum / power - 1.0) <= tolerance);
}

PhotonScene black_room() {
    PhotonScene scene;
    scene.camera(look_along({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 1.0, 1.0));
    scene.add(Sphere{{0, 0, 0}, 3}, scene.material({0, 0, 0}));
    // A surface that is black in all channels scatters nothing and keeps no photons.
    scene.d.materials[0].material.diffuse.color = {0, 0, 1e-6};
    return scene;
}

}  // namespace

void claim_g2(ClaimRun& run) {
    constexpr double kSide = 2.0;
    const Scene spread = compile(light_in_glass(kSide).d);
    const std::vector<double> passes{4, 16, 64, 256};
    // The variance of pass i grows as i^(1 - alpha), that of the mean of n passes falls as
    // n^-alpha.
    expect_slope(run, spread, kSide, "sppm:photons=20000,radius=0.04", passes, -1.0 / 3.0);
    expect_slope(run, spread, kSide, "sppm:photons=20000,radius=0.04,alpha=1", passes, -0.5);
    expect_slope(run, spread, kSide, "vcm:photons=20000,radius=0.04,pilot=off", passes, -0.375);
    PhotonScene lamp;
    lamp.camera(OrthographicCamera{{0, 0, 0.3}, {0, 0, -1}, {kSide, 0, 0}, {0, kSide, 0}});
    lamp.add(Rectangle{.corner = {-40, -40, 0}, .edge_u = {80, 0, 0}, .edge_v = {0, 80, 0}},
             lamp.material({0, 1, 0}));
    // A small emitting ball approximates a point light.
    lamp.add(Sphere{{0, 0, kHigh}, 0.02}, lamp.material({}, {0, 1e4, 0}));
    expect_slope(run, compile(lamp.d), kSide, "vcm:photons=500,radius=0.04,pilot=off", passes,
                 -0.5);

    constexpr double kSmall = 0.02, kRadius = 1.0, kAlpha = 0.5;
    const Scene below = compile(light_in_glass(kSmall).d);
    for (const int n : {16, 256}) {
        double expected = 0.0, squared = kRadius * kRadius;
        for (int pass = 1; pass <= n; ++pass) {
            expected += (lit_disc(std::sqrt(squared)) - 1.0) / n;
            squared *= squared_radius_step(kAlpha, pass);
        }
        for (const std::string name : {"sppm", "vcm"}) {
            run.step(fmt::format("bias of {}: {} passes", name, n));
            const std::string more = name == "vcm" ? ",pilot=off" : "";
            const auto made = make_renderer(
                fmt::format("{}:photons=40000,radius={},alpha={}{}", name, kRadius, kAlpha, more));
            const double bias = error_of(sampled(below, *made, 2, n).film, kSmall).bias;
            run.expect(fmt::format("{}: bias after {} passes, alpha {}", name, n, kAlpha),
                       fmt::format("{:.4f}", bias), fmt::format("{:.4f} +- 0.005", expected),
                       std::abs(bias - expected) <= 0.005);
        }
    }
    run.note(
        "A point of light in a ball of glass over a floor, of which only photons know: "
        "brightness in closed form. The bias is that of a disc of the radius of each pass.");
}

void claim_g3(ClaimRun& run) {
    const double per_color = 4.0 * kPi * kPi;  // intensities are multiplied by pi
    PhotonScene point = black_room();
    point.point({0.5, 0.2, 0}, {1, 1, 1});
    expect_power(run, "point", point, {PhotonKind::Direct}, per_color, 1e-4);
    PhotonScene ball = black_room();
    ball.add(Sphere{{0, 0, 1}, 0.5}, ball.material({}, {1, 1, 1}));
    expect_power(run, "ball", ball, {PhotonKind::Direct}, kPi * kPi, 1e-4);
    PhotonScene sheet = black_room();
    sheet.add(Rectangle{.corner = {-1, -1, 1}, .edge_u = {2, 0, 0}, .edge_v = {0, 1, 0}},
              sheet.material({}, {1, 1, 1}));
    expect_power(run, "rectangle of two sides", sheet, {PhotonKind::Direct}, 4.0 * kPi, 1e-4);
    PhotonScene lens = black_room();
    lens.add(Sphere{{0, 0, 1}, 0.9}, lens.glass());
    lens.point({0, 0, -1}, {1, 1, 1});
    expect_power(run, "point beside a ball of glass", lens,
                 {PhotonKind::Direct, PhotonKind::Caustic}, per_color, 0.002);
    PhotonScene inside = black_room();
    // Nearer than 1 the falloff of the light is capped, which would not conserve power.
    inside.add(Sphere{{0, 0, 0}, 1.6}, inside.glass());
    inside.point({0.3, 0, 0}, {1, 1, 1});
    expect_power(run, "point in a ball of glass", inside, {PhotonKind::Direct, PhotonKind::Caustic},
                 per_color, 0.005);

    PhotonScene series;
    series.camera(look_along({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 0.7, 1.0));
    series.add(Sphere{{0, 0, 0}, 3}, series.material({0, 0.5, 0}, {0, 0.5, 0}));
    const Scene sphere = compile(series.d);
    for (const char* name :
         {"path_tracing", "bidirectional", "photon_mapping:photons=50000",
          "sppm:photons=20000,radius=0.3", "vcm:photons=20000,radius=0.3,pilot=off"}) {
        run.step(name);
        const Film film = sampled(sphere, *make_renderer(name), 16, 64).film;
        double sum = 0.0;
        for (int i = 0; i < 256; ++i) sum += film.at(i % 16, i / 16).g / 256;
        run.expect(fmt::format("{}: a sphere that glows with 0.5, of albedo 0.5", name),
                   fmt::format("{:.4f}", sum), "1 +- 0.01", std::abs(sum - 1.0) <= 0.01);
    }
}

}  // namespace alhazen

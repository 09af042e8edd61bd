#include "alhazen/shading/lights/studio.h"

#include <algorithm>
#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/math/vec.h"

namespace alhazen {

namespace {

/// A softbox: a rectangle perpendicular to the direction to its centre.
struct SoftBox {
    double azimuth, elevation;  ///< degrees; azimuth from the front to the right
    double width, height;       ///< degrees
    double radiance;
};

constexpr SoftBox kSoftBoxes[] = {
    {-140, 42, 46, 46, 6.4},                        // main, over the left shoulder
    {120, 18, 30, 60, 2.3},                         // fill, to the right
    {55, 25, 12, 70, 4.4},                          // rims, from behind the subject
    {-50, 22, 9, 64, 3.6},   {0, 88, 52, 34, 1.5},  // above
};
constexpr double kSoftEdge = 0.12;  ///< fraction of half the size

double smooth(double x) {
    const double t = std::clamp(x, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

double brightness_of(const SoftBox& box, const Vec3& d) {
    const double a = box.azimuth * kRadiansPerDegree, e = box.elevation * kRadiansPerDegree;
    const Vec3 z{std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
    const Vec3 x{std::cos(a), -std::sin(a), 0}, y = cross(x, z);
    const double forward = dot(d, z);
    if (!(forward > 0.0)) return 0.0;
    const auto inside = [&](double along, double degrees) {
        const double half = std::tan(0.5 * degrees * kRadiansPerDegree);
        return smooth((1.0 - std::abs(along / forward) / half) / kSoftEdge);
    };
    return box.radiance * inside(dot(d, x), box.width) * inside(dot(d, y), box.height);
}

double studio_brightness(const Vec3& d) {
    // Walls brighten towards the horizon; the floor is darker, with a smooth transition.
    const double wall = 0.22 + 0.22 * (1.0 - smooth(std::abs(d.z) / 0.9));
    const double floor = 0.12 + 0.17 * (1.0 - smooth(-d.z / 0.7));
    const double turn = smooth((d.z + 0.12) / 0.24);
    double sum = turn * wall + (1.0 - turn) * floor;
    for (const SoftBox& box : kSoftBoxes) sum += brightness_of(box, d);
    return sum;
}

}  // namespace

Image studio_picture() {
    constexpr int kWidth = 1024, kHeight = 512, kGrid = 2;
    Image picture(kWidth, kHeight, 3);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            double sum = 0.0;
            for (int n = 0; n < kGrid * kGrid; ++n) {
                const double u = (x + (n % kGrid + 0.5) / kGrid) / kWidth;
                const double v = (y + (n / kGrid + 0.5) / kGrid) / kHeight;
                const double angle = 2.0 * kPi * (u - 0.5), polar = kPi * v;
                sum += studio_brightness({std::sin(polar) * std::sin(angle),
                                          std::sin(polar) * std::cos(angle), std::cos(polar)});
            }
            std::fill_n(picture.pixel(x, y), 3, static_cast<float>(sum / (kGrid * kGrid)));
        }
    }
    return picture;
}

}  // namespace alhazen

#include "alhazen/cameras/eye_rays.h"

#include <gtest/gtest.h>

#include <random>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(EyeRays, AreThoseOfTheFormulaOfTheirCamera) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-2.0, 2.0);
    const auto vec = [&] { return Vec3{number(random), number(random), number(random)}; };
    for (int i = 0; i < 200; ++i) {
        const PerspectiveCamera p{vec(), vec(), vec(), vec()};
        const OrthographicCamera o{vec(), vec(), vec(), vec()};
        const double x = number(random), y = number(random);
        const EyeRays a{Camera(p)}, b{Camera(o)};
        const Ray ray = a.ray(a.column(x) + a.row(y));
        EXPECT_EQ(ray.origin, p.eye);
        EXPECT_EQ(ray.direction, normalize(p.look + (x - 0.5) * p.right + (y - 0.5) * p.up));
        const Ray parallel = b.ray(b.column(x) + b.row(y));
        EXPECT_EQ(parallel.origin, o.origin + (x - 0.5) * o.right + (y - 0.5) * o.up);
        EXPECT_EQ(parallel.direction, normalize(o.direction));
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE

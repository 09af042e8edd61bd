// Packets whose rays all begin in one point and have one range are made from their directions. A
// ray that differs in one number makes its packet another.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "unit/aggregates/coherent_rays.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

TEST(CoherentStarts, ARayThatDiffersInOneNumberKeepsIt) {
    constexpr int kBegin = 3, kEnd = 4;
    const PrimitiveTable table = random_triangles(800, 1, 0.1, 31);
    const auto list = make_aggregate("list", table);
    for (int number = 0; number <= kEnd; ++number) {
        for (const std::size_t place : {0u, 1u, 17u, 30u, 31u}) {
            Rays rays = eye_rays({0.1, 0.2, 3}, {0, 0, -1}, 0.7, 16);
            for (std::size_t i = place; i < rays.size(); i += 32) {
                Hit hit;
                if (number < kBegin) rays[i].origin[number] += 0.05;
                if (number < kBegin || !list->closest(rays[i], hit, nullptr)) continue;
                if (number == kBegin) rays[i].t_min = 1.001 * hit.t;
                if (number == kEnd) rays[i].t_max = 0.999 * hit.t;
            }
            compare(fmt::format("number {} of ray {} of 32", number, place), table, rays);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE

// Samples that contribute to all pixels within the radius of a filter.

#include "alhazen/imaging/film/shared_film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

constexpr int kSide = 24;
const PixelBox kCrop{0, 0, kSide, kSide};

/// A film of `per_pixel` samples of `value(place)` in each pixel, places in pixels, y down.
template <class Value>
Film film_of(const FilterEntry& filter, double radius, int per_pixel, Value&& value) {
    Film film(kSide, kSide, kCrop);
    SharedFilm shared(filter, radius, kCrop);
    SharedFilm::Spread spread(shared);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-0.5, 0.5);
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            for (int s = 0; s < per_pixel; ++s) {
                const Vec2 offset{uniform(random), uniform(random)};
                spread.add(offset, value(Vec2{x + 0.5 + offset.x, y + 0.5 - offset.y}, random));
            }
            EXPECT_TRUE(shared.add(x, y, spread));
        }
    }
    shared.write(film);
    return film;
}

TEST(SharedFilm, AnEvenPictureStaysEven) {
    for (const FilterEntry& filter : filters()) {
        if (FilterKernel(filter, filter.radius).has_negative_lobes()) continue;
        const Film film = film_of(filter, filter.radius, 3, [](const Vec2&, auto&) {
            return Rgb{0.25, 0.5, 1};
        });
        for (int i = 0; i < kSide; ++i) {
            EXPECT_NEAR(film.at(i, kSide - 1 - i).r, 0.25, 1e-14) << filter.name;
            EXPECT_NEAR(film.at(i, 0).b, 1.0, 1e-14) << filter.name;
        }
    }
}

TEST(SharedFilm, AnEdgeIsTheFiltersIntegral) {
    const FilterEntry& tent = *find_filter("tent");
    // White above y = 11.25 and to the left of x = 8.5.
    const Film film = film_of(tent, 1.0, 20000, [](const Vec2& p, auto&) {
        return Rgb{p.x < 8.5 ? 1.0 : 0.0, p.y < 11.25 ? 1.0 : 0.0, 0};
    });
    const auto below = [](double x) {
        return x < 0 ? 0.5 * (1 + x) * (1 + x) : 1 - 0.5 * (1 - x) * (1 - x);
    };
    EXPECT_NEAR(film.at(8, 5).r, 0.5, 0.01);
    EXPECT_NEAR(film.at(7, 5).r, 1.0, 0.01);
    EXPECT_NEAR(film.at(9, 5).r, 0.0, 0.01);
    EXPECT_NEAR(film.at(5, 10).g, below(0.75), 0.01);
    EXPECT_NEAR(film.at(5, 11).g, below(-0.25), 0.01);
}

TEST(SharedFilm, TheVarianceIsThatOfASampleTimesTheFiltersSquare) {
    const FilterEntry& tent = *find_filter("tent");
    const auto noise = [](const Vec2&, std::mt19937& random) {
        const double v = std::uniform_real_distribution<double>(0, std::sqrt(12.0))(random);
        return Rgb{v, v, v};
    };
    constexpr int kSamples = 256;
    const Film film = film_of(tent, 1.0, kSamples, noise);
    double squares = 0;
    int count = 0;
    for (int y = 2; y < kSide - 2; ++y) {
        for (int x = 2; x < kSide - 2; ++x, ++count) {
            const double d = film.at(x, y).g - std::sqrt(3.0);
            squares += d * d;
        }
    }
    // The tent's square has the integral 2/3 in one dimension. Neighbours depend on each other: of
    // 400 pixels some 180 count, so that the estimate is off by a tenth (one standard deviation).
    const double expected = 4.0 / 9.0 / kSamples;
    EXPECT_NEAR(squares / count, expected, 0.35 * expected);
    EXPECT_LT(squares / count, 0.7 / kSamples);
}

TEST(SharedFilm, WhatIsNotFiniteIsLeftOut) {
    Film film(kSide, kSide, kCrop);
    SharedFilm shared(*find_filter("tent"), 1.0, kCrop);
    SharedFilm::Spread spread(shared);
    spread.add({0, 0}, {std::numeric_limits<double>::infinity(), 0, 0});
    EXPECT_FALSE(shared.add(4, 4, spread));
    spread.add({0, 0}, {0.5, 0.5, 0.5});
    EXPECT_TRUE(shared.add(4, 4, spread));
    shared.write(film);
    EXPECT_EQ(film.at(4, 4), (Rgb{0.5, 0.5, 0.5}));
    EXPECT_EQ(film.at(9, 9), Rgb{});
}

TEST(SharedFilm, SamplesMayBeOfAnySize) {
    for (const double size : {0x1p-300, 0x1p50, 0x1p300}) {
        Film film(kSide, kSide, kCrop);
        SharedFilm shared(*find_filter("tent"), 1.0, kCrop);
        SharedFilm::Spread spread(shared);
        for (const double times : {1.0, 3.0}) {
            spread.add({0, 0}, {times * size, 0, -times * size});
            EXPECT_TRUE(shared.add(4, 4, spread));
        }
        shared.write(film);
        EXPECT_EQ(film.at(4, 4), (Rgb{2 * size, 0, -2 * size}));
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE

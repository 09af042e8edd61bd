#include "alhazen/solids/solid_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/solids/solid_queries_json.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

/// root: a ball, a plane, two cars with two wheels each (one stored), a trailer used once.
SceneMaker cars() {
    SceneMaker maker;
    Material rubber;
    rubber.name = "rubber";
    rubber.density = 1.5;
    const MaterialId grey = maker.material({}), black = maker.material(rubber);
    const ObjectIndex car = maker.object("car"), trailer = maker.object("trailer");
    maker.add(Sphere{{0, 0, 5}, 1}, grey);
    maker.add(Plane{}, grey);
    maker.add(Cylinder{{0, 0, 0}, {0, 1, 0}, 0.5}, black, {}, car);
    maker.description().objects[1].parts.back().name = "front";
    maker.add(Cylinder{{0, 0, 0}, {0, 1, 0}, 0.5}, black, Affine::translate({2, 0, 0}), car);
    maker.description().objects[1].parts.back().name = "rear";
    maker.add(BoxShape{}, grey, {}, trailer);
    maker.add(car);
    maker.description().objects[0].parts.back().name = "taxi";
    maker.add(car, MaterialId{0}, Affine::translate({10, 0, 0}));
    maker.add(trailer, MaterialId{0}, Affine::translate({20, 0, 0}));
    return maker;
}

TEST(SolidScene, SolidsAreCalledByThePartsThatLeadToThem) {
    SceneMaker maker = cars();
    const Scene scene = maker.compile();
    const SolidScene solids(maker.description(), scene);
    ASSERT_EQ(solids.solids().count(), 6u);
    std::vector<std::string> names;
    for (std::uint64_t i = 0; i < 6; ++i) names.push_back(solids.name(SolidId{i}));
    EXPECT_EQ(names, (std::vector<std::string>{"sphere", "trailer/box", "taxi/front", "taxi/rear",
                                               "car/front", "car/rear"}));
    using Densities = std::vector<std::optional<double>>;
    EXPECT_EQ(solids.densities(SolidId{2}), (Densities{1.5}));
    EXPECT_EQ(solids.densities(SolidId{0}), (Densities{std::nullopt}));
}

/// The names of all solids, and those that a word selects.
struct Names {
    std::vector<std::string> all, chosen;
};
Names names_of(SceneMaker& maker, const std::string& word) {
    const Scene scene = maker.compile();
    const SolidScene solids(maker.description(), scene);
    Names names;
    for (std::uint64_t i = 0; i < solids.solids().count(); ++i) {
        names.all.push_back(solids.name(SolidId{i}));
    }
    for (const SolidId id : solids.select(std::vector<std::string>{word})) {
        names.chosen.push_back(solids.name(id));
    }
    std::sort(names.all.begin(), names.all.end());
    return names;
}

/// The last part of an object.
Part& last_part(SceneMaker& maker, ObjectIndex object) {
    return maker.description().objects[static_cast<std::size_t>(object)].parts.back();
}
/// Moves it along x while the shutter is open.
void move(Part& part, const Affine& inner = {}) {
    part.motion = std::make_shared<const PartMotion>(
        PartMotion{{}, {{0, Affine{}}, {1, Affine::translate({1, 0, 0})}}, inner});
    part.object_from_part = inner;
}

TEST(SolidScene, WhatMovesOrRestsBesideItHasTheNameOfItsParts) {
    SceneMaker maker;
    const MaterialId grey = maker.material({});
    const ObjectIndex car = maker.object("car"), trailer = maker.object("trailer"),
                      root = maker.description().root;
    maker.add(Sphere{{0, 0, 0}, 0.5}, grey, {}, car);
    last_part(maker, car).name = "wheel";
    maker.add(Sphere{{0, 0, 3}, 0.2}, grey, {}, car);
    last_part(maker, car).name = "spin";
    move(last_part(maker, car), Affine::scale({2, 2, 2}));
    for (const std::string name : {"red", "blue"}) {
        maker.add(car, MaterialId{0}, Affine::translate({name == "red" ? 0.0 : 9.0, 0, 0}));
        last_part(maker, root).name = name;
    }
    maker.add(BoxShape{}, grey, {}, trailer);
    maker.add(trailer);
    move(last_part(maker, root));
    maker.add(Sphere{{0, 0, 50}, 1}, grey);
    const Names names = names_of(maker, "red/wheel");
    EXPECT_EQ(names.all, (std::vector<std::string>{"blue/spin", "blue/wheel", "red/spin",
                                                   "red/wheel", "sphere", "trailer/box"}));
    EXPECT_EQ(names.chosen, (std::vector<std::string>{"red/wheel"}));
}

TEST(SolidScene, AnObjectWithItsOwnAcceleratorNamesItsPartsOnce) {
    SceneMaker maker;
    const MaterialId grey = maker.material({});
    const ObjectIndex inner = maker.object("inner"), outer = maker.object("outer");
    maker.description().objects[static_cast<std::size_t>(inner)].accelerator = "list";
    maker.add(Sphere{}, grey, {}, inner);
    maker.add(BoxShape{}, grey, Affine::translate({4, 0, 0}), inner);
    maker.add(inner, MaterialId{0}, {}, outer);
    maker.add(outer);
    const Names names = names_of(maker, "outer/inner");
    EXPECT_EQ(names.all, (std::vector<std::string>{"outer/inner/box", "outer/inner/sphere"}));
    EXPECT_EQ(names.chosen.size(), 2u);
}

/// (steel - black) + (steel - (black - brass)), and the same with brass as one more operand.
TEST(SolidScene, ToolsOfADifferenceDoNotCountAmongDensities) {
    using Densities = std::vector<std::optional<double>>;
    for (const bool with_brass : {false, true}) {
        SceneMaker maker;
        Material of_steel, of_brass;
        of_steel.density = 7.8;
        of_brass.density = 8.5;
        const MaterialId black = maker.material({}), steel = maker.material(of_steel),
                         brass = maker.material(of_brass);
        const ObjectIndex all = maker.object("all"), drilled = maker.object("drilled"),
                          sleeved = maker.object("sleeved"), sleeve = maker.object("sleeve");
        auto& objects = maker.description().objects;
        objects[static_cast<std::size_t>(all)].combine = Combine::Union;
        for (const ObjectIndex cut : {drilled, sleeved, sleeve}) {
            objects[static_cast<std::size_t>(cut)].combine = Combine::Difference;
        }
        maker.add(Sphere{{0, 0, 0}, 1}, steel, {}, drilled);
        maker.add(Sphere{{1, 0, 0}, 0.5}, black, {}, drilled);
        maker.add(Sphere{{0, 3, 0}, 1}, black, {}, sleeve);
        maker.add(Sphere{{0, 3, 0}, 0.5}, brass, {}, sleeve);
        maker.add(Sphere{{0, 3, 0}, 2}, steel, {}, sleeved);
        maker.add(sleeve, MaterialId{0}, {}, sleeved);
        maker.add(drilled, MaterialId{0}, {}, all);
        maker.add(sleeved, MaterialId{0}, {}, all);
        if (with_brass) maker.add(Sphere{{3, 0, 0}, 1}, brass, {}, all);
        maker.add(all);
        const Scene scene = maker.compile();
        const SolidScene solids(maker.description(), scene);
        ASSERT_EQ(solids.solids().count(), 1u);
        EXPECT_EQ(solids.densities(SolidId{0}),
                  with_brass ? Densities({7.8, 8.5}) : Densities{7.8});
    }
}

TEST(SolidScene, WordsChooseSolids) {
    SceneMaker maker = cars();
    const Scene scene = maker.compile();
    const SolidScene solids(maker.description(), scene);
    const auto chosen = [&](std::vector<std::string> words) {
        std::vector<std::uint64_t> numbers;
        for (const SolidId id : solids.select(words)) {
            numbers.push_back(static_cast<std::uint64_t>(id));
        }
        return numbers;
    };
    EXPECT_EQ(chosen({}).size(), 6u);
    EXPECT_EQ(chosen({"front"}), (std::vector<std::uint64_t>{2, 4}));
    EXPECT_EQ(chosen({"car", "0"}), (std::vector<std::uint64_t>{0, 4, 5}));
    EXPECT_EQ(chosen({"taxi/rear"}), (std::vector<std::uint64_t>{3}));
    EXPECT_THROW((void)chosen({"bus"}), Error);
    EXPECT_THROW((void)chosen({"6"}), Error);
}

TEST(SolidQueriesJson, AnswersHaveWhatWasAskedFor) {
    SceneMaker maker = cars();
    const Scene scene = maker.compile();
    const SolidScene solids(maker.description(), scene);
    const Ray ray = parse_ray("-5, 0.375 0.25 1,0,0");
    SpanList list;
    solids.queries().spans(ray, list);
    const auto spans = spans_json(solids, ray, list.spans);
    ASSERT_EQ(spans["spans"].size(), 5u);
    EXPECT_EQ(spans["spans"][0]["name"], "taxi/front");
    EXPECT_EQ(spans["spans"][0]["entry"]["material"], "rubber");
    EXPECT_NEAR(spans["spans"][0]["entry"]["t"].get<double>(), 5 - std::sqrt(3.0) / 4, 1e-15);
    EXPECT_LT(spans["spans"][0]["entry"]["normal"][0].get<double>(), 0);
    const Vec3 point = parse_point("20,0,0.5");
    const auto inside = inside_json(solids, point, solids.queries().inside(point));
    ASSERT_EQ(inside["inside"].size(), 1u);
    EXPECT_EQ(inside["inside"][0]["name"], "trailer/box");
    EXPECT_EQ(inside["inside"][0]["on_surface"], true);
    const auto thick = thickness_json(solids, ray, solids.queries().thickness(ray, list));
    EXPECT_NEAR(thick["thickness"].get<double>(), 1 + 4 * std::sqrt(3.0) / 2, 1e-14);
}

TEST(SolidQueriesJson, LengthsAndPointsOutliveTheirParameters) {
    SceneMaker maker = cars();
    const Scene scene = maker.compile();
    const SolidScene solids(maker.description(), scene);
    SpanList list;
    const auto spans_of = [&](const Ray& ray) {
        solids.queries().spans(ray, list);
        return spans_json(solids, ray, list.spans)["spans"];
    };
    const auto plain = spans_of(parse_ray("-5, 0.375 0.25 1,0,0"));
    const auto slow = spans_of(parse_ray("-5, 0.375 0.25 1e-310,0,0"));
    ASSERT_EQ(slow.size(), plain.size());
    for (std::size_t i = 0; i < plain.size(); ++i) {
        EXPECT_TRUE(slow[i]["entry"]["t"].is_null());
        EXPECT_NEAR(slow[i]["length"].get<double>(), plain[i]["length"].get<double>(), 1e-14);
        for (const char* end : {"entry", "exit"}) {
            for (int k = 0; k < 3; ++k) {
                EXPECT_NEAR(slow[i][end]["point"][k].get<double>(),
                            plain[i][end]["point"][k].get<double>(), 1e-14);
                EXPECT_NEAR(slow[i][end]["normal"][k].get<double>(),
                            plain[i][end]["normal"][k].get<double>(), 1e-14);
            }
        }
    }
}

TEST(SolidQueriesJson, BadNumbersAreRefusedWithTheirPlace) {
    for (const char* bad : {"", "1,2,3", "1,2,3,4,5,x", "1,2,3,0,0,0", "1,2,3,4,5,6,7",
                            "nan,0,0,1,0,0", "1,2,3,4,5,6,9,8", "1;2;3;4;5;6"}) {
        EXPECT_THROW((void)parse_ray(bad), Error) << bad;
    }
    EXPECT_THROW((void)parse_point("1,2"), Error);
    EXPECT_EQ(parse_ray("0 0 0 1 0 0 -1 inf").t_min, -1);
    std::istringstream text("# rays\n\n0 0 0 1 0 0 # one\r\n  \n1 1 1 0 1\n");
    LineReader reader(text, "rays.txt");
    const auto lines = reader.next(10);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_NO_THROW((void)parse_ray(lines[0].text, lines[0].where));
    try {
        (void)parse_ray(lines[1].text, lines[1].where);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("rays.txt:5"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(reader.next(10).empty());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE

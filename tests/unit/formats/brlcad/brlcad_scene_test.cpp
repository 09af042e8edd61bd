/// Scenes of BRL-CAD databases: which points are solid, and in which colour.

#include <gtest/gtest.h>

#include <array>

#include "alhazen/formats/brlcad/brlcad_importer.h"
#include "alhazen/formats/brlcad/brlcad_shader.h"
#include "alhazen/math/constants.h"
#include "alhazen/scene/scene.h"
#include "alhazen/shading/materials/material.h"
#include "alhazen/solids/spans.h"
#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::mentions;
using testing::text_of;

SceneDescription import(const std::string& text, Diagnostics& found, ImportOptions options = {}) {
    const ImportSource source{text, "a.asc", options};
    const BrlcadImporter importer;
    EXPECT_EQ(importer.recognise(source), 2) << text;
    SceneDescription scene = importer.import(source, found);
    if (found.error_count() == 0) validate(scene, found);
    return scene;
}

/// A compiled scene with point and colour queries.
class Model {
  public:
    explicit Model(const std::string& text, ImportOptions options = {})
        : description_(import(text, found_, std::move(options))) {
        EXPECT_EQ(found_.error_count(), 0u) << text_of(found_);
        scene_ = compile(description_);
    }
    /// Number of solids that contain the point.
    [[nodiscard]] std::size_t at(const Vec3& p) const {
        return SolidQueries(scene_.aggregate).inside(p).size();
    }
    /// Diffuse colour, scaled to full brightness, of the first surface on a ray.
    [[nodiscard]] Rgb color(const Vec3& origin, const Vec3& direction) const {
        Ray ray;
        ray.origin = origin;
        ray.direction = direction;
        Hit hit;
        if (!scene_.aggregate->closest(ray, hit, nullptr)) return {};
        const Surface surface = surface_at(*scene_.aggregate, ray, hit);
        const Rgb c =
            scene_.materials[static_cast<std::size_t>(surface.materials[0])].diffuse.color;
        return c.max() > 0.0 ? (1.0 / c.max()) * c : c;
    }
    [[nodiscard]] const Diagnostics& found() const { return found_; }
    [[nodiscard]] const SceneDescription& description() const { return description_; }
    [[nodiscard]] const Scene& scene() const { return scene_; }

  private:
    Diagnostics found_;
    SceneDescription description_;
    Scene scene_;
};

const std::string kBall = "put ball ell V {0 0 0} A {2 0 0} B {0 2 0} C {0 0 2}\n";
const std::string kMove = " {1 0 0 X  0 1 0 0  0 0 1 0  0 0 0 1}";
std::string moved(double x) {
    std::string text = kMove;
    return text.replace(text.find('X'), 1, std::to_string(x));
}
const std::string kRegions = kBall + "put r comb region yes rgb {255 0 0} tree {l ball}\n" +
                             "put g comb region yes rgb {0 255 0} tree {l ball" + moved(3) + "}\n";

TEST(BrlcadScene, OperatorsWithinARegionMakeOneSolid) {
    const Model model(kBall + "put a comb region yes tree {- {u {l ball} {l ball" + moved(3) +
                      "}} {l ball" + moved(6) + "}}\n");
    EXPECT_EQ(text_of(model.found()), "");
    EXPECT_EQ(model.at({0, 0, 0}), 1u);
    EXPECT_EQ(model.at({1.5, 0, 0}), 1u);  // in both balls
    EXPECT_EQ(model.at({3, 0, 0}), 1u);
    EXPECT_EQ(model.at({4.5, 0, 0}), 0u);
    EXPECT_EQ(model.at({6, 0, 0}), 0u);
}

TEST(BrlcadScene, ExclusiveOrAndIntersectionOfCombinationsAreSolids) {
    const Model model(kBall + "put two comb region no tree {^ {l ball} {l ball" + moved(3) +
                      "}}\n" + "put a comb region yes tree {n {l two} {l two" + moved(1) + "}}\n");
    EXPECT_EQ(model.at({0, 0, 0}), 1u);
    EXPECT_EQ(model.at({1.5, 0, 0}), 0u);
    EXPECT_EQ(model.at({-1.5, 0, 0}), 0u);
    EXPECT_EQ(model.at({4.5, 0, 0}), 1u);
}

TEST(BrlcadScene, EverySolidIsWhereItsDefinitionSays) {
    struct Probe {
        const char* solid;
        Vec3 inside, outside;  ///< on both sides of a surface point
    };
    const Probe probes[] = {
        {"ell V {1 0 0} A {2 0 0} B {0 1 0} C {0 0 3}", {1, 0, 2.99}, {1, 0, 3.01}},
        {"tgc V {0 0 0} H {0 0 2} A {2 0 0} B {0 1 0} C {1 0 0} D {0 2 0}",
         {1.49, 0, 1},
         {1.51, 0, 1}},
        {"tgc V {0 0 0} H {0 0 2} A {2 0 0} B {0 1 0} C {1 0 0} D {0 2 0}",
         {0, 1.49, 1},
         {0, 1.51, 1}},
        {"tor V {0 0 0} H {0 0 3} r_a 3 r_h 1", {0, 2.01, 0}, {0, 1.99, 0}},
        {"half N {0 0 2} d 2", {5, 5, 0.99}, {5, 5, 1.01}},
        {"part V {0 0 0} H {0 0 4} r_v 2 r_h 1", {0, 0, -1.99}, {0, 0, -2.01}},
        {"part V {0 0 0} H {0 0 4} r_v 2 r_h 1", {0, 0, 4.99}, {0, 0, 5.01}},
        // Half way up, the cone tangent to both spheres: 1.5 / cos of its half angle.
        {"part V {0 0 0} H {0 0 4} r_v 2 r_h 1", {1.54, 0, 2}, {1.56, 0, 2}},
        {"part V {0 0 0} H {0 0 1} r_v 3 r_h 1", {0, 0, 2.99}, {0, 0, 3.01}},
        {"rpc V {0 0 0} H {0 0 2} B {0 4 0} r 2", {0.99, 3, 1}, {1.01, 3, 1}},
        // ((B + c - s)^2 - c^2) / ((B + c)^2 - c^2) = 5 / 18 of r^2 at s = 2.
        {"rhc V {0 0 0} H {0 0 2} B {0 4 0} r 2 c 0.25", {1.05, 2, 1}, {1.06, 2, 1}},
        {"epa V {0 0 0} H {0 0 4} A {0 1 0} r_1 2 r_2 1", {0, 0.99, 3}, {0, 1.01, 3}},
        {"epa V {0 0 0} H {0 0 4} A {0 1 0} r_1 2 r_2 1", {0.49, 0, 3}, {0.51, 0, 3}},
        {"ehy V {0 0 0} H {0 0 4} A {0 1 0} r_1 2 r_2 1 c 0.25", {0, 1.05, 2}, {0, 1.06, 2}},
        {"hyp V {0 0 0} H {0 0 4} A {2 0 0} b 1 bnr 0.5", {0.99, 0, 2}, {1.01, 0, 2}},
        {"hyp V {0 0 0} H {0 0 4} A {2 0 0} b 1 bnr 0.5", {0, 0.99, 0.01}, {0, 1.01, 0.01}},
        {"eto V {0 0 0} N {0 0 1} C {1 0 1} r 5 r_d 0.5", {5.99, 0, 0.99}, {6.01, 0, 1.01}},
        {"eto V {0 0 0} N {0 0 1} C {1 0 1} r 5 r_d 0.5", {0, 5.35, -0.35}, {0, 5.36, -0.36}},
        {"superell V {0 0 0} A {1 0 0} B {0 1 0} C {0 0 1} n 2 e 2",
         {0.1, 0.1, 0.79},
         {0.1, 0.1, 0.81}},
        {"arbn N 4 P0 {0 0 1 1} P1 {0 1 -1 1} P2 {1 -1 -1 1} P3 {-1 -1 -1 1}",
         {0, 0, 0.99},
         {0, 0, 1.01}},
        {"arb8 V1 {0 0 0} V2 {2 0 0} V3 {2 2 0} V4 {0 2 0} V5 {1 1 3} V6 {1 1 3} V7 {1 1 3} V8 {1 "
         "1 3}",
         {1, 1, 2.99},
         {1, 1, 3.01}},
        {"ars NC 3 PPC 4 C0 { {0 0 0} {0 0 0} {0 0 0} {0 0 0} } C1 { {1 0 1} {0 1 1} {-1 0 1} {0 "
         "-1 1} } C2 { {0 0 2} {0 0 2} {0 0 2} {0 0 2} }",
         {0.01, 0.01, 1.95},
         {0.01, 0.01, 2.01}},
        {"bot mode volume V {{0 0 0} {1 0 0} {0 1 0} {0 0 1}} F {{0 2 1} {0 1 3} {0 3 2} {1 2 3}}",
         {0.33, 0.33, 0.33},
         {0.34, 0.34, 0.34}},
    };
    for (const Probe& probe : probes) {
        const Model model("put s " + std::string(probe.solid) + "\n");
        EXPECT_EQ(text_of(model.found()), "") << probe.solid;
        EXPECT_EQ(model.at(probe.inside), 1u) << probe.solid;
        EXPECT_EQ(model.at(probe.outside), 0u) << probe.solid;
    }
}

TEST(BrlcadScene, RegionsOfAGroupLieSideBySide) {
    const Model model(kRegions + "put all comb region no tree {u {l r} {l g}}\n");
    EXPECT_EQ(model.at({1.5, 0, 0}), 2u);
    EXPECT_EQ(model.color({-9, 0, 0}, {1, 0, 0}), (Rgb{1, 0, 0}));
    EXPECT_EQ(model.color({9, 0, 0}, {-1, 0, 0}), (Rgb{0, 1, 0}));
}

TEST(BrlcadScene, OperatorsAboveRegionsActOnEachAndKeepTheirMaterials) {
    const Model model(kRegions + "put cut half N {0 0 1} d 0\n" +
                      "put all comb region no tree {- {u {l r} {l g}} {l cut}}\n");
    EXPECT_EQ(model.at({1.5, 0, 0.5}), 2u);
    EXPECT_EQ(model.at({1.5, 0, -0.5}), 0u);
    // The cut faces are visible from below.
    EXPECT_EQ(model.color({-1, 0, -9}, {0, 0, 1}), (Rgb{1, 0, 0}));
    EXPECT_EQ(model.color({4, 0, -9}, {0, 0, 1}), (Rgb{0, 1, 0}));
}

TEST(BrlcadScene, ARegionCutByAnotherRegionIsOfItsOwnMaterialEverywhere) {
    const Model model(kRegions + "put all comb region no tree {- {l r} {l g}}\n");
    EXPECT_EQ(model.at({0, 0, 0}), 1u);
    EXPECT_EQ(model.at({1.5, 0, 0}), 0u);
    EXPECT_EQ(model.at({3, 0, 0}), 0u);
    EXPECT_EQ(model.color({9, 0, 0}, {-1, 0, 0}), (Rgb{1, 0, 0}));
}

TEST(BrlcadScene, ColoursComeFromAboveWhereTheyAreFixedAndFromTheTableOfRegions) {
    const Model model(kRegions + "put up comb rgb {0 0 255} inherit 1 tree {l r}\n" +
                      "put low comb rgb {0 0 255} tree {l g {1 0 0 9 0 1 0 0 0 0 1 0 0 0 0 1}}\n" +
                      "put t comb region yes region_id 7 tree {l ball" + moved(-9) + "}\n" +
                      "color 7 7 255 255 0\n");
    EXPECT_EQ(model.color({0, 0, 9}, {0, 0, -1}), (Rgb{0, 0, 1}));
    EXPECT_EQ(model.color({12, 0, 9}, {0, 0, -1}), (Rgb{0, 1, 0}));
    EXPECT_EQ(model.color({-9, 0, 9}, {0, 0, -1}), (Rgb{1, 1, 0}));
}

TEST(BrlcadScene, TheTableOfColoursIsForRegionsWithoutAColourOfTheirOwn) {
    const std::string table = "color 1 9 255 255 0\n";
    const Model own(kBall + "put a comb region yes region_id 7 rgb {0 0 255} tree {l ball}\n" +
                    table);
    EXPECT_EQ(own.color({9, 0, 0}, {-1, 0, 0}), (Rgb{0, 0, 1}));
    const Model above(kBall + "put a comb region yes region_id 7 tree {l ball}\n" +
                      "put b comb rgb {0 255 0} tree {l a}\n" + table);
    EXPECT_EQ(above.color({9, 0, 0}, {-1, 0, 0}), (Rgb{0, 1, 0}));
    const Model later(kBall + "put a comb region yes region_id 7 tree {l ball}\n" + table +
                      "color 7 20 255 0 0\n");
    EXPECT_EQ(later.color({9, 0, 0}, {-1, 0, 0}), (Rgb{1, 0, 0}));
    const Model zero(kBall + "put a comb region yes region_id 0 tree {l ball}\n" +
                     "color 0 9 255 255 0\n");
    EXPECT_EQ(zero.color({9, 0, 0}, {-1, 0, 0}), (Rgb{1, 1, 0}));
    const Model none(kBall + "put a comb region yes region_id 10 tree {l ball}\n" + table);
    EXPECT_EQ(none.color({9, 0, 0}, {-1, 0, 0}), (Rgb{1, 1, 1}));
}

TEST(BrlcadScene, MatricesFollowEachOtherFromTheInsideOut) {
    const Model model(kBall + "put a comb tree {l ball {1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 4}}\n" +
                      "put b comb region yes tree {l a {0 -1 0 0 1 0 0 10 0 0 1 0 0 0 0 1}}\n" +
                      "put c comb tree {l b" + moved(100) + "}\n");
    EXPECT_EQ(model.at({100, 10, 0}), 1u);
    EXPECT_EQ(model.at({100.4, 10, 0}), 1u);
    EXPECT_EQ(model.at({100.6, 10, 0}), 0u);
}

TEST(BrlcadScene, AllThatNothingElseUsesIsShownOrWhatIsNamed) {
    const std::string text = kRegions + "put all comb tree {l r}\n";
    EXPECT_EQ(Model(text).description().objects.back().parts.size(), 2u);
    ImportOptions options;
    options.objects = {"r"};
    const Model model(text, options);
    EXPECT_EQ(model.at({0, 0, 0}), 1u);
    EXPECT_EQ(model.at({4, 0, 0}), 0u);
    options.objects = {"none"};
    Diagnostics found;
    (void)import(text, found, options);
    EXPECT_TRUE(mentions(found, "there is no object 'none'")) << text_of(found);
}

TEST(BrlcadScene, NothingIsLostInSilence) {
    const std::string dsp = "put d dsp file x\n";
    const Model missing(kBall + "put a comb region yes tree {u {l ball} {l gone}}\n");
    EXPECT_EQ(missing.at({0, 0, 0}), 1u);
    EXPECT_TRUE(mentions(missing.found(), "a.asc:2:41: warning: there is no object 'gone'"));
    const Model unread(kBall + dsp + "put a comb region yes tree {- {l ball} {l d}}\n" +
                       "put b comb region yes tree {l ball}\n" + "put all comb tree {u {l a" +
                       moved(9) + "} {l b}}\n");
    EXPECT_EQ(unread.at({0, 0, 0}), 1u);
    EXPECT_EQ(unread.at({9, 0, 0}), 0u);
    EXPECT_TRUE(mentions(unread.found(), "'a' is left out: solid 'd' (dsp)"))
        << text_of(unread.found());
    const Model air(kBall +
                    "put a comb region yes air 1 tree {l ball}\nput b half N {0 0 1} d -9\n");
    EXPECT_EQ(air.at({0, 0, 0}), 0u);
    EXPECT_TRUE(mentions(air.found(), "1 region of air is not drawn"));
}

TEST(BrlcadScene, OnePartThatCannotBeReadLeavesTheOthers) {
    const std::string b = "put b comb region yes tree {l ball}\n";
    const char* const bad[] = {
        // A perspective matrix, no matrix, an operator that is not read, a number that is none.
        "put a comb region yes tree {l ball {1 0 0 9 0 1 0 0 0 0 1 0 1 0 0 1}}\n",
        "put a comb region yes tree {l ball {0 0 0 9 0 0 0 0 0 0 0 0 0 0 0 1}}\n",
        "put a comb region yes tree {l ball {1 0 0}}\n",
        "put a comb region yes tree {u {l ball} {! {l ball}}}\n",
        ("put s ell V {9 0 0} A {2 0 0} B {0 2 0} C {0 0 nan}\n"
         "put a comb region yes tree {u {l s} {l ball {1 0 0 9 0 1 0 0 0 0 1 0 0 0 0 1}}}\n"),
        "put c comb tree {u {l a} {l ball {1 0 0 9 0 1 0 0 0 0 1 0 0 0 0 1}}}\n"
        "put a comb region yes tree {l c}\nput t comb tree {l a}\n",
    };
    for (const char* text : bad) {
        const Model model(kBall + text + b);
        EXPECT_EQ(model.at({0, 0, 0}), 1u) << text;
        EXPECT_EQ(model.at({9, 0, 0}), 0u) << text;
        EXPECT_GE(model.found().warning_count(), 1u) << text;
        EXPECT_TRUE(mentions(model.found(), "'a'")) << text_of(model.found());
    }
    const Model group(kBall + b +
                      "put a comb tree {u {l b} {l b {1 0 0 9 0 1 0 0 0 0 1 0 1 0 0 1}}}\n");
    EXPECT_EQ(group.at({0, 0, 0}), 1u);
    EXPECT_EQ(text_of(group.found()),
              "a.asc:3:27: warning: the matrix of member 'b' of 'a' is not an affine transform; "
              "the member is left out\n");
    // If nothing is left all findings are errors.
    Diagnostics found;
    (void)import(kBall + "put a comb region yes tree {l ball {1 0 0 9 0 1 0 0 0 0 1 0 1 0 0 1}}\n",
                 found);
    EXPECT_TRUE(mentions(found, "error: no part can be shown"));
    EXPECT_TRUE(mentions(found, "a.asc:2:29: error: the matrix of member 'ball'"))
        << text_of(found);
}

TEST(BrlcadScene, CombinationsThatContainThemselvesAreRefused) {
    Diagnostics found;
    (void)import("put a comb tree {l b}\nput b comb tree {l c}\nput c comb tree {l b}\n", found);
    EXPECT_TRUE(mentions(found, "combination 'b' contains itself")) << text_of(found);
    Diagnostics ring;
    (void)import("put b comb region yes tree {l c}\nput c comb tree {l b}\n", ring);
    EXPECT_TRUE(mentions(ring, "every object is part of another")) << text_of(ring);
    Diagnostics region;
    (void)import(kBall + "put b comb region yes tree {l c}\n" +
                     "put c comb tree {- {l ball} {l b}}\nput t comb tree {l b}\n",
                 region);
    EXPECT_TRUE(mentions(region, "contains itself")) << text_of(region);
}

TEST(BrlcadScene, CombinationsThatNoOtherReachesAreToldOf) {
    for (const char* lost : {"put r comb region yes tree {l r}\n",
                             "put r comb tree {l q}\nput q comb region yes tree {l r}\n"}) {
        const Model model(kBall + lost);
        EXPECT_EQ(model.at({0, 0, 0}), 1u);
        EXPECT_TRUE(mentions(model.found(), "warning: combination 'r' contains itself"))
            << text_of(model.found());
    }
}

TEST(BrlcadScene, AnIntersectionKeepsTheMaterialOfItsLeftOperand) {
    const std::string b = "put b comb region yes rgb {0 0 255} tree {l ball" + moved(0.5) + "}\n";
    for (const char* tree :
         {"{n {l r} {n {l g} {l b}}}", "{n {n {l r} {l g}} {l b}}",
          "{n {l r} {n {l g} {n {l b} {l g}}}}", "{n {n {l r} {l b}} {n {l g} {n {l b} {l g}}}}"}) {
        const Model model(kRegions + b + "put c comb tree " + tree + "\n");
        EXPECT_EQ(model.color({1.2, 0, 9}, {0, 0, -1}), (Rgb{1, 0, 0})) << tree;
        EXPECT_EQ(model.at({1.2, 0, 0}), 1u) << tree;
    }
}

TEST(BrlcadScene, CombinationsThatDoubleAtEachLevelDoNotFillMemory) {
    std::string text = kBall + "put c0 comb region yes tree {l ball}\n";
    for (int i = 1; i < 60; ++i) {
        const std::string below = "{l c" + std::to_string(i - 1) + "}";
        text += "put c" + std::to_string(i) + " comb tree {- {u " + below + " " + below +
                "} {l ball}}\n";
    }
    ImportOptions options;
    options.max_made_bytes = 1 << 20;
    Diagnostics found;
    try {
        (void)import(text, found, options);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Resource);
    }
}

TEST(BrlcadScene, SurfacesAreShownButNotCut) {
    const std::string bot =
        "put s bot mode plate V {{0 0 0} {1 0 0} {0 1 0}} F {{0 1 2}}\n"
        "put o bot mode volume V {{0 0 0} {1 0 0} {0 1 0}} F {{0 1 2}}\n";
    const Model model(kBall + bot + "put a comb region yes tree {u {l s} {l o}}\n" +
                      "put b comb region yes tree {- {l ball} {l s}}\n");
    EXPECT_TRUE(mentions(model.found(), "without thickness"));
    EXPECT_TRUE(mentions(model.found(),
                         "'o' is not closed; it is shown as a surface: 3 of 3 edges are open: (0, "
                         "0, 0) to (1, 0, 0), "));
    EXPECT_TRUE(mentions(model.found(), "'b' is left out: 's' is a surface"));
}

TEST(BrlcadScene, LightsShineFromTheMiddleOfTheirRegions) {
    const Model model(kBall +
                      "put l comb region yes rgb {255 255 0} shader {light {f 1}} tree {l "
                      "ball" +
                      moved(3) + "}\nput all comb tree {l l" + moved(10) + "}\n");
    ASSERT_EQ(model.description().lights.size(), 2u);
    const auto& light = std::get<PointLight>(model.description().lights[0].light);
    EXPECT_NEAR(light.position.x, 13.0, 1e-12);
    EXPECT_EQ(light.color.b, 0.0);
}

std::string light(const std::string& options, const std::string& name = "l") {
    return "put " + name + " comb region yes rgb {255 255 255} shader {light {" + options +
           "}} tree {l ball" + moved(3) + "}\n";
}

TEST(BrlcadScene, ALightIsInNoShadowOfItsSolid) {
    for (const std::string options : {"f 1", "f 1 v 0"}) {
        const Model model(kBall + light(options));
        ASSERT_EQ(model.description().lights.size(), 2u);
        int found = 0;
        for (const ObjectDescription& object : model.description().objects) {
            for (const Part& part : object.parts) {
                if (part.name != model.description().lights[0].name) continue;
                ++found;
                EXPECT_EQ(part.visible_to, kRaysOfAllKinds & ~mask_of(RayKind::Shadow)) << options;
            }
        }
        EXPECT_EQ(found, 1) << options;
    }
}

TEST(BrlcadScene, LightsHaveTheirFractionAndOthersGoByTheirIntensity) {
    const Model model(kBall + light("inten 50", "a") + light("b 100", "b") + light("f .25", "c"));
    const auto& lights = model.description().lights;
    ASSERT_EQ(lights.size(), 4u);
    const auto strength = [&](std::size_t i) {
        return std::get<PointLight>(lights[i].light).color.r;
    };
    EXPECT_NEAR(strength(0), 2.5 / 6, 1e-12);
    EXPECT_NEAR(strength(1), 5.0 / 6, 1e-12);
    EXPECT_NEAR(strength(2), 0.25, 1e-12);
    EXPECT_EQ(std::get<AmbientLight>(lights[3].light).ambient, (Rgb{0.4, 0.4, 0.4}));
    EXPECT_TRUE(model.description().conventions.shading.ambient_from_eye);
    EXPECT_EQ(text_of(model.found()), "");
}

TEST(BrlcadScene, ALightWithAnAngleShinesIntoACone) {
    const Model down(kBall + light("angle 30"));
    const auto& spot = std::get<SpotLight>(down.description().lights.at(0).light);
    EXPECT_NEAR(spot.outer_angle, kPi / 6, 1e-12);
    EXPECT_EQ(spot.direction, (Vec3{0, 0, -1}));
    const Model aimed(kBall + light("a 30 target {3 0 9}"));
    const auto& up = std::get<SpotLight>(aimed.description().lights.at(0).light);
    EXPECT_NEAR(length(up.direction - Vec3{0, 0, 1}), 0.0, 1e-12);
}

TEST(BrlcadScene, OptionsOfAShaderThatAreNotReadAreTold) {
    const Model model(kBall + light("pt {1 2 3} s 9") + light("sh 2 s 0", "m"));
    const auto has = [&](const char* part) {
        EXPECT_TRUE(mentions(model.found(), part)) << part << text_of(model.found());
    };
    has("a.asc:2:1: warning: the option 'pt' of the shader 'light' is not read");
    has("a.asc:3:1: warning: the option 'sh' of the shader 'light' is not read");
    has("soft shadows are not supported");
    has("lights without shadows are not supported");
}

TEST(BrlcadScene, ShadersOfAStackAreReadInBothForms) {
    for (const char* text : {"stack checker a=255,0,0 b=0/0/9 s=4;plastic sh=4",
                             "stack {{checker {a {255 0 0} b {0 0 9} s 4}} {plastic {sh 4}}}",
                             "stack;checker a 255 0 0 b 0 0 9 s 4; plastic {sh 4}"}) {
        const auto shaders = read_brlcad_shaders(text);
        ASSERT_EQ(shaders.size(), 3u) << text;
        EXPECT_EQ(shaders[1].name, "checker");
        EXPECT_EQ(shaders[1].three("a"), (Rgb{255, 0, 0})) << text;
        EXPECT_EQ(shaders[1].three("b"), (Rgb{0, 0, 9})) << text;
        EXPECT_EQ(shaders[1].number("s"), 4.0) << text;
        EXPECT_EQ(shaders[2].name, "plastic");
        EXPECT_EQ(shaders[2].number("shine", "sh"), 4.0) << text;
    }
    EXPECT_TRUE(read_brlcad_shaders("").empty());
}

/// The ambient or else emitted colour, white, of the first surface on a ray.
Rgb pattern_at(const Model& model, const Vec3& origin, const Vec3& direction) {
    const Scene& scene = model.scene();
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    Hit hit;
    if (!scene.aggregate->closest(ray, hit, nullptr)) return {};
    const Surface surface = surface_at(*scene.aggregate, ray, hit);
    const MaterialSample sample =
        evaluate(scene.materials[static_cast<std::size_t>(surface.materials[0])], scene.textures,
                 {{surface.uv, surface.uv2}, {}, {1, 1, 1, 1}});
    return sample.emission.is_black() ? sample.ambient : sample.emission;
}

TEST(BrlcadScene, ACheckerHasItsColoursOnTheFacesOfABox) {
    const std::string box =
        "put box arb8 V1 {0 0 0} V2 {8 0 0} V3 {8 8 0} V4 {0 8 0} V5 {0 0 8} V6 {8 0 8} V7 {8 8 8} "
        "V8 {0 8 8}\n";
    for (const char* shader : {"checker {a {255 0 0} b {0 255 0} s 4}",
                               "stack {{checker {a {255 0 0} b {0 255 0} s 4}} {plastic {}}}"}) {
        const Model model(box + "put r comb region yes shader {" + shader + "} tree {l box}\n");
        EXPECT_EQ(text_of(model.found()), "");
        std::array<int, 2> seen{};
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j < 4; ++j) {
                const auto at = [&](int x, int y) {
                    return pattern_at(model, {2.0 * x + 1, 2.0 * y + 1, 20}, {0, 0, -1});
                };
                const Rgb c = at(i, j);
                EXPECT_TRUE(c == (Rgb{1, 0, 0}) || c == (Rgb{0, 1, 0})) << i << j << ' ' << c.r;
                ++seen[c.r > 0.0 ? 0 : 1];
                if (i > 0) {
                    EXPECT_NE(c, at(i - 1, j));
                }
                if (j > 0) {
                    EXPECT_NE(c, at(i, j - 1));
                }
            }
        }
        EXPECT_EQ(seen[0], 8);
    }
}

TEST(BrlcadScene, AnEnvironmentIsTheBackgroundAndNoSolid) {
    const Model model(kBall + "put sky comb region yes shader {envmap cloud} tree {l ball}\n" +
                      "put r comb region yes tree {l ball" + moved(9) + "}\n");
    EXPECT_EQ(model.at({0, 0, 0}), 0u);
    EXPECT_EQ(model.at({9, 0, 0}), 1u);
    const Rgb sky = model.description().picture.background.value_or(Rgb{});
    EXPECT_GT(sky.b, sky.r);
    EXPECT_GT(sky.r, 0.3);
    EXPECT_TRUE(mentions(model.found(), "mean colour of 'cloud'"));
}

TEST(BrlcadScene, AModelWithoutLightsHasOneBesideTheEye) {
    const Model model(kRegions);
    ASSERT_EQ(model.description().lights.size(), 2u);
    EXPECT_EQ(model.description().conventions.shading.shadow_tint,
              ShadingConventions::ShadowTint::None);
}

TEST(BrlcadScene, IfNothingIsLeftWhatIsLeftOutIsAnError) {
    Diagnostics found;
    (void)import(
        "title t\nunits mm\nput a tor V {0 0 0} H {0 0 1} r_a 3 r_h 5\n"
        "put p pipe V0 {0 0 0} O0 1 I0 0 R0 1\n",
        found);
    EXPECT_EQ(found.error_count(), 3u) << text_of(found);
    EXPECT_TRUE(mentions(found, "no part can be shown")) << text_of(found);
}

TEST(BrlcadScene, ObliqueAxesAreADoubt) {
    for (const char* solid :
         {"epa V {0 0 0} H {0 0 2} A {1 0 .1} r_1 1 r_2 1",
          "ehy V {0 0 0} H {0 0 2} A {1 0 .1} r_1 1 r_2 1 c 1",
          "tgc V {0 0 0} H {0 0 2} A {1 0 0} B {.1 1 0} C {1 0 0} D {.1 1 0}"}) {
        const Model model("put a " + std::string(solid) + "\n");
        EXPECT_TRUE(mentions(model.found(), "not perpendicular")) << text_of(model.found());
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE

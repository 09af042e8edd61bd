#include <gtest/gtest.h>

#include "alhazen/shading/bsdf/bsdf_of.h"
#include "support/bsdf_checks.h"
#include "support/thorough.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

const std::vector<double> kRoughnesses = {0.05, 0.1, 0.2, 0.4, 0.7, 1.0};
constexpr double kViews[] = {1.0, 0.9, 0.6, 0.3, 0.1};

/// The views to test: all, or every day one or two.
std::vector<double> views_of(const std::string& name) {
    std::vector<double> views;
    for (std::size_t i = 0; i < std::size(kViews); ++i) {
        if (is_tried(i, 3, number_of(name))) views.push_back(kViews[i]);
    }
    return views;
}

void expect_furnace(const NamedBsdf& b, double expected, double turn = 0.4) {
    for (const double cosine : views_of(b.name + std::to_string(turn))) {
        const Vec3 view = view_at(cosine, turn);
        // More samples if these are too few to decide.
        const double bound = b.error * expected;
        Spectrum sum = furnace(b.bsdf, view, thorough() ? 1 << 14 : 1 << 12);
        if (!thorough() && std::abs(sum.a - expected) > 0.3 * bound) {
            sum = furnace(b.bsdf, view, 1 << 14);
        }
        if (std::abs(sum.a - expected) > 0.7 * bound) sum = furnace(b.bsdf, view, 1 << 18);
        EXPECT_NEAR(sum.a, expected, b.error * expected)
            << b.name << ", view " << cosine << ", turn " << turn;
    }
}

TEST(Furnace, EveryWhiteLobeGivesBackAllLight) {
    for (const NamedBsdf& b : lobes_with_density(kRoughnesses)) expect_furnace(b, 1.0);
}

TEST(Furnace, EveryLobeOfWeightOneHalfGivesBackHalf) {
    for (const NamedBsdf& b : lobes_with_density({0.05, 0.3, 1.0})) {
        Bsdf half;
        half.add(b.bsdf, 0.5);
        expect_furnace({b.name, half, b.error}, 0.5);
    }
}

TEST(Furnace, AlbedoIsWhatTheFurnaceShows) {
    const Spectrum grey = Spectrum::all(0.5);
    for (const double r : {0.05, 0.2, 0.5, 0.8, 1.0}) {
        const double alpha = r * r;
        const std::vector<NamedBsdf> list = {
            {"Oren-Nayar", bsdf_of_lobe(OrenNayar{grey, r})},
            {"rough mirror of 0.5",
             bsdf_of_lobe(RoughReflection({alpha, alpha}, SchlickTerm{grey, grey}))},
            {"rough plastic face",
             bsdf_of_lobe(RoughReflection({alpha, alpha},
                                          SchlickTerm{Spectrum::all(0.04), Spectrum::all(1)}))},
            {"face with grooves",
             bsdf_of_lobe(RoughReflection({0.1 + 0.9 * alpha, alpha},
                                          SchlickTerm{Spectrum::all(0.04), Spectrum::all(1)}))},
            {"rough tinted glass", bsdf_of_lobe(RoughDielectric(alpha, 1 / 1.5, grey, grey))},
        };
        for (const NamedBsdf& b : list) {
            for (const double cosine : views_of(b.name + std::to_string(r))) {
                const Vec3 view = view_at(cosine);
                EXPECT_NEAR(furnace(b.bsdf, view).a, b.bsdf.albedo(view).a, 1e-3)
                    << b.name << ", roughness " << r << ", view " << cosine;
            }
        }
    }
}

Bsdf bsdf_of_parameters(const MetallicRoughness& p, double index = 1.5, bool inside = false) {
    Material m;
    m.index.value = index;
    m.metallic_roughness = p;
    return bsdf_of(m, {}, {}, {.from_inside = inside});
}

/// White materials of the glTF model, whose layers lose no energy.
std::vector<NamedBsdf> white_materials(double roughness) {
    std::vector<NamedBsdf> list;
    const auto add = [&](std::string name, const auto& change, bool inside = false) {
        MetallicRoughness p;
        p.roughness.value = roughness;
        p.metallic.value = 0;
        change(p);
        list.push_back({name + ", roughness " + std::to_string(roughness),
                        bsdf_of_parameters(p, 1.5, inside), inside ? 5e-3 : 1e-3});
    };
    add("metal", [](auto& p) { p.metallic.value = 1; });
    add("plastic", [](auto&) {});
    add("half metal", [](auto& p) { p.metallic.value = 0.5; });
    add("thin glass", [](auto& p) { p.transmission.value = 1; });
    add("leaf", [](auto& p) { p.diffuse_transmission.share.value = 0.7; });
    add("coated leaf over thin glass", [](auto& p) {
        p.diffuse_transmission.share.value = 0.5, p.transmission.value = 0.3;
        p.coat.strength.value = 0.5;
    });
    add("frosted volume", [](auto& p) { p.transmission.value = 1, p.thickness.value = 1; });
    add(
        "frosted volume from inside",
        [](auto& p) { p.transmission.value = 1, p.thickness.value = 1; }, true);
    add("coated plastic", [](auto& p) { p.coat.strength.value = 1; });
    add("rough coat over metal", [](auto& p) {
        p.metallic.value = 1, p.coat.strength.value = 0.7, p.coat.roughness.value = 0.4;
    });
    add("velvet", [](auto& p) {
        p.sheen.color.color = {0.6, 0.6, 0.6}, p.sheen.roughness.value = 0.5;
    });
    add("coated velvet metal", [](auto& p) {
        p.metallic.value = 1, p.coat.strength.value = 0.5, p.sheen.color.color = {1, 1, 1};
        p.sheen.roughness.value = 0.3;
    });
    return list;
}

TEST(Furnace, WhiteMaterialsOfManyLayersGiveBackAllLight) {
    for (const double r : {0.0, 0.1, 0.4, 1.0}) {
        for (const NamedBsdf& b : white_materials(r)) expect_furnace(b, 1.0);
    }
}

TEST(Furnace, GroovesGiveBackAllLightSeenAlongAndAcross) {
    for (const double r : {0.05, 0.1, 0.3, 0.6, 1.0}) {
        for (const double strength : {0.1, 0.3, 0.6, 0.9, 1.0}) {
            MetallicRoughness p;
            p.roughness.value = r;
            p.anisotropy.strength = strength;
            const std::string name =
                "roughness " + std::to_string(r) + ", strength " + std::to_string(strength);
            for (const double turn : {0.0, 0.8, 0.5 * kPi}) {
                expect_furnace({name, bsdf_of_parameters(p)}, 1.0, turn);
            }
        }
    }
}

TEST(Furnace, LayersOverAndUnderGroovesGiveBackAllLight) {
    const auto add = [](std::vector<NamedBsdf>& list, std::string name, double roughness,
                        double strength, const auto& change) {
        MetallicRoughness p;
        p.roughness.value = roughness;
        p.metallic.value = 0;
        p.anisotropy.strength = strength;
        p.anisotropy.rotation = 0.4;
        change(p);
        name += ", roughness " + std::to_string(roughness);
        list.push_back({name, bsdf_of_parameters(p)});
    };
    std::vector<NamedBsdf> list;
    for (const auto& [r, strength] : {std::pair{0.1, 1.0}, {0.4, 0.5}}) {
        add(list, "plastic", r, strength, [](auto&) {});
        add(list, "thin glass", r, strength, [](auto& p) { p.transmission.value = 1; });
    }
    add(list, "half metal, polished along its grooves", 0.0, 0.6,
        [](auto& p) { p.metallic.value = 0.5; });
    add(list, "coated leaf", 0.3, 0.7,
        [](auto& p) { p.diffuse_transmission.share.value = 0.6, p.coat.strength.value = 0.5; });
    for (const NamedBsdf& b : list) {
        for (const double turn : {0.4, 0.9 + 0.5 * kPi}) expect_furnace(b, 1.0, turn);
    }
}

TEST(Furnace, SheenOfEveryRoughnessGivesBackAllLight) {
    for (const double r : {0.0, 0.001, 0.03, 0.05, 0.1, 0.15, 0.3, 0.6, 1.0}) {
        MetallicRoughness p;
        p.metallic.value = 0;
        p.roughness.value = 0.5;
        p.sheen.color.color = {1, 1, 1};
        p.sheen.roughness.value = r;
        const Bsdf white = bsdf_of_parameters(p);
        const Bsdf sheen = bsdf_of_lobe(Sheen{{1, 1, 1, 1}, r});
        for (const double cosine : {0.01, 0.05, 0.06, 0.08, 0.1, 0.2, 0.5, 1.0}) {
            const Vec3 view = view_at(cosine);
            const std::string what =
                "roughness " + std::to_string(r) + ", view " + std::to_string(cosine);
            EXPECT_LE(furnace(sheen, view, 1 << 14).max(), 1.002) << what;
            const double error = cosine < 0.1 ? 5e-3 : 1e-3;
            EXPECT_NEAR(furnace(white, view, 1 << 14).a, 1.0, error) << what;
        }
    }
}

TEST(Furnace, NoMaterialGivesBackMoreThanItGets) {
    for (const double r : {0.0, 0.2, 0.5, 1.0}) {
        MetallicRoughness p;
        p.roughness.value = r;
        p.film.strength.value = 1;
        std::vector<NamedBsdf> list;
        for (const double metallic : {0.0, 1.0}) {
            p.metallic.value = metallic;
            for (const double nm : {100.0, 280.0, 400.0, 550.0}) {
                p.film.thickest_nm = nm;
                list.push_back({"film " + std::to_string(nm), bsdf_of_parameters(p)});
            }
        }
        p.film.strength.value = 0;
        p.anisotropy.strength = 1;
        list.push_back({"grooves", bsdf_of_parameters(p)});
        list.push_back({"sheen", bsdf_of_lobe(Sheen{{1, 1, 1, 1}, r})});
        for (const NamedBsdf& b : list) {
            for (const double cosine : views_of(b.name + std::to_string(r))) {
                EXPECT_LE(furnace(b.bsdf, view_at(cosine), 1 << 14).max(), 1.002)
                    << b.name << ", roughness " << r << ", view " << cosine;
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE

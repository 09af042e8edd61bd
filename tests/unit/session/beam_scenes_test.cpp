/// Beams in whole scenes: the visible pieces add up to the window exactly, and agree with rays.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "alhazen/geometry/polygon_sets/arrangement.h"
#include "alhazen/renderers/beam_tracing/beam_tree.h"
#include "alhazen/session/generators/generate.h"
#include "alhazen/session/load.h"
#include "alhazen/session/render.h"
#include "support/test_data.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

constexpr int kWidth = 160, kHeight = 120;

struct BeamScenery {
    LoadedScene loaded;
    int depth = 0;
};

BeamScenery with_depth(LoadedScene loaded, int depth) {
    loaded.scene.conventions.shading.max_depth = depth;
    return {std::move(loaded), depth};
}
BeamScenery from_file(const char* name, int depth) {
    return with_depth(load(testing::source_folder() / "scenes" / name), depth);
}
BeamScenery generated(const char* name, std::uint64_t size, int depth) {
    return with_depth(load(generate(name, size), {}), depth);
}
/// Cornell's box of the scenes without its ball of glass.
BeamScenery box_without_ball() {
    Diagnostics diagnostics;
    SceneDescription d =
        load_description(testing::source_folder() / "scenes/cornell.alhazen", {}, diagnostics);
    for (ObjectDescription& object : d.objects) {
        std::erase_if(object.parts, [](const Part& part) {
            const auto* shape = std::get_if<AnyShape>(&part.what);
            return shape != nullptr && std::holds_alternative<Sphere>(*shape);
        });
    }
    return with_depth(load(std::move(d), {}), 5);
}
/// The gears of glass are mirrors: refraction by beams is linear.
BeamScenery mirror_gears() {
    SceneDescription d = generate("gears", 1);
    for (MaterialDescription& m : d.materials) {
        Material& material = m.material;
        if (!material.transmissive.color.is_black()) {
            material.reflective.color = material.transmissive.color;
            material.transmissive.color = {};
        }
    }
    return with_depth(load(std::move(d), {}), 3);
}

BeamTree tree_of(const LoadedScene& loaded, const PolygonSet& window) {
    const Scene& scene = loaded.scene;
    const RenderJob job{
        .scene = scene,
        .camera = with_aspect(scene.cameras[0].camera, scene.cameras[0].aspect, 4.0 / 3.0),
        .description = &loaded.description};
    return beam_tree(job, beam_scene(loaded.description, scene), window, {});
}

bool overlap(const PolygonSet& a, const PolygonSet& b) {
    for (const SubEdge& e : exact_arrangement(a, b).sub_edges) {
        if (e.below == (kInFirst | kInSecond) || e.above == (kInFirst | kInSecond)) return true;
    }
    return false;
}

/// Expects that the visible pieces and the background make up the window exactly, in integers.
void expect_exact_areas(const BeamTree& tree, const PolygonSet& window) {
    std::vector<const PolygonSet*> regions;
    Int128 sum = 0;
    for (const BeamPiece& piece : tree.pieces) {
        if (piece.beam != 0) continue;
        regions.push_back(&piece.seen.region);
        sum += twice_area(piece.seen.region);
    }
    EXPECT_TRUE(sum == twice_area(window)) << static_cast<double>(sum - twice_area(window));
    std::ranges::sort(regions, {}, [](const PolygonSet* r) { return r->bounds().lo.x; });
    int overlaps = 0;
    for (std::size_t i = 0; i < regions.size(); ++i) {
        const LatticeBox& box = regions[i]->bounds();
        for (std::size_t k = i + 1; k < regions.size() && regions[k]->bounds().lo.x < box.hi.x;
             ++k) {
            const LatticeBox& other = regions[k]->bounds();
            if (other.lo.y >= box.hi.y || other.hi.y <= box.lo.y) continue;
            overlaps += overlap(*regions[i], *regions[k]);
        }
    }
    EXPECT_EQ(overlaps, 0);
}

double distance_to_edge(const Vec2& p, LatticePoint a, LatticePoint b) {
    const Vec2 d{double(b.x) - a.x, double(b.y) - a.y}, q{p.x - a.x, p.y - a.y};
    const double t = std::clamp((q.x * d.x + q.y * d.y) / (d.x * d.x + d.y * d.y), 0.0, 1.0);
    return std::hypot(q.x - t * d.x, q.y - t * d.y);
}
/// Whether an edge of a piece or of a shadow is within 1e-6 of the picture's width.
bool near_an_edge(const BeamTree& tree, const Vec2& p) {
    const double least = 2e-6 * kBeamFilm;
    const auto near = [&](const PolygonSet& region) {
        const LatticeBox& box = region.bounds();
        if (p.x < box.lo.x - least || p.x > box.hi.x + least || p.y < box.lo.y - least ||
            p.y > box.hi.y + least) {
            return false;
        }
        for (std::size_t l = 0; l < region.loop_count(); ++l) {
            const std::span<const LatticePoint> loop = region.loop(l);
            for (std::size_t k = 0; k < loop.size(); ++k) {
                if (distance_to_edge(p, loop[k], loop[(k + 1) % loop.size()]) < least) return true;
            }
        }
        return false;
    };
    return std::ranges::any_of(tree.pieces, [&](const BeamPiece& piece) {
        return near(piece.seen.region) || std::ranges::any_of(piece.lights, [&](const auto& light) {
                   return near(light.part.region);
               });
    });
}

RenderResult picture_of(const BeamScenery& s, const char* renderer) {
    RenderOptions options;
    options.renderer = renderer;
    options.width = kWidth;
    options.height = kHeight;
    options.max_depth = s.depth;
    options.aovs = parse_aovs("id.object,P");
    return render(s.loaded, options);
}

/// Pixels whose centres rays see otherwise, further than 1e-6 from all edges; all that differ go to
/// `near`.
int wrong_pixels(const BeamScenery& s, const BeamTree& tree, int& near) {
    const RenderResult beams = picture_of(s, "beam_tracing"), rays = picture_of(s, "whitted");
    const auto value = [&](const RenderResult& r, const char* name, std::size_t k) {
        const LayerChannel& channel = *r.layers.find(name);
        return channel.type == SampleType::Uint ? double(channel.whole[k])
                                                : double(channel.values[k]);
    };
    int wrong = 0;
    for (int j = 0; j < kHeight; ++j) {
        for (int i = 0; i < kWidth; ++i) {
            const auto k = static_cast<std::size_t>(j * kWidth + i);
            const Rgb d = beams.film.at(i, j) - rays.film.at(i, j);
            bool same = std::max({std::abs(d.r), std::abs(d.g), std::abs(d.b)}) < 1.0 / 255 &&
                        value(beams, "id.object", k) == value(rays, "id.object", k);
            for (const char* axis : {"P.X", "P.Y", "P.Z"}) {
                const double at = value(rays, axis, k);
                same = same && std::abs(value(beams, axis, k) - at) <= 1e-4 * (1 + std::abs(at));
            }
            if (same) continue;
            const Vec2 p{((i + 0.5) / kWidth * 2 - 1) * kBeamFilm,
                         (1 - (j + 0.5) / kHeight * 2) * kBeamFilm};
            if (near_an_edge(tree, p)) {
                ++near;
            } else {
                ++wrong;
            }
        }
    }
    return wrong;
}

void expect_as_rays(const BeamScenery& s, int most_near) {
    const auto limit = static_cast<std::int32_t>(kBeamFilm);
    const PolygonSet window = lattice_rectangle({-limit, -limit}, {limit, limit});
    const BeamTree tree = tree_of(s.loaded, window);
    expect_exact_areas(tree, window);
    int near = 0;
    EXPECT_EQ(wrong_pixels(s, tree, near), 0);
    EXPECT_LE(near, most_near);
}

TEST(BeamScenes, TwoCornellBoxesAddUpExactlyAndAreAsRaysSeeThem) {
    expect_as_rays(from_file("beams/cornell_boxes.alhazen", 5), 20);
    expect_as_rays(box_without_ball(), 20);
}

TEST(BeamScenes, TheHallOfMirrorsAddsUpExactlyAndIsAsRaysSeeIt) {
    expect_as_rays(from_file("beams/mirror_hall.alhazen", 5), 0);
}

TEST(BeamScenes, TheTetrahedraAddUpExactlyAndAreAsRaysSeeThem) {
    expect_as_rays(generated("tetra", 6, 5), 0);
}

TEST(BeamScenes, ACityOfTenThousandPolygonsAddsUpExactlyAndIsAsRaysSeeIt) {
    expect_as_rays(generated("city", 1667, 3), 0);
}

TEST(BeamScenes, GearsAddUpExactlyAndAreAsRaysSeeThem) {
    expect_as_rays(mirror_gears(), 0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE

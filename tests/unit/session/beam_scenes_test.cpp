/// Beams in whole scenes: the visible pieces add up to the window exactly, and agree with rays.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "alhazen/base/file.h"
#include "alhazen/geometry/polygon_sets/arrangement.h"
#include "alhazen/renderers/beam_tracing/beam_cells.h"
#include "alhazen/renderers/beam_tracing/beam_tree.h"
#include "alhazen/renderers/beam_tracing/box_index.h"
#include "alhazen/session/generators/generate.h"
#include "alhazen/session/load.h"
#include "alhazen/session/render.h"
#include "support/random.h"
#include "support/scratch_folder.h"
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

BeamTree tree_of(const LoadedScene& loaded, const PolygonSet& window,
                 const BeamTreeOptions& options = {}) {
    const Scene& scene = loaded.scene;
    const RenderJob job{
        .scene = scene,
        .camera = with_aspect(scene.cameras[0].camera, scene.cameras[0].aspect, 4.0 / 3.0),
        .description = &loaded.description};
    return beam_tree(job, beam_scene(loaded.description, scene), window, options);
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

PolygonSet whole_window() {
    const auto limit = static_cast<std::int32_t>(kBeamFilm);
    return lattice_rectangle({-limit, -limit}, {limit, limit});
}

TEST(BeamScenes, ALimitOfTestsLeavesOutTheSmallestMirrorImages) {
    const BeamScenery hall = from_file("beams/mirror_hall.alhazen", 5);
    const BeamTree all = tree_of(hall.loaded, whole_window());
    EXPECT_EQ(all.left_out, 0u);
    const auto tests = [](const BeamTree& tree) {
        return tree.counts.seen.hulls + tree.counts.shadow.hulls;
    };
    // A limit above the number of tests changes nothing.
    const BeamTree same = tree_of(hall.loaded, whole_window(), {.most_tests = 10 * tests(all)});
    EXPECT_EQ(same.left_out, 0u);
    EXPECT_EQ(same.pieces.size(), all.pieces.size());
    // The beams that remain are the largest of the first generation that loses some.
    const auto weights = [](const BeamTree& tree, int depth) {
        std::vector<double> found;
        for (const BeamNode& node : tree.beams) {
            if (depth == 0 || node.depth != depth) continue;
            found.push_back(double(twice_area(tree.pieces[node.piece].seen.region)) *
                            node.contribution.max());
        }
        std::ranges::sort(found, std::greater{});
        return found;
    };
    int parted = 0;
    for (const double share : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}) {
        const auto most = static_cast<std::uint64_t>(share * double(tests(all)));
        const BeamTree some = tree_of(hall.loaded, whole_window(), {.most_tests = most});
        EXPECT_GT(some.left_out, 0u) << share;
        EXPECT_LT(some.beams.size(), all.beams.size()) << share;
        EXPECT_LT(tests(some), tests(all)) << share;
        int depth = 1;
        while (weights(some, depth).size() == weights(all, depth).size()) ++depth;
        const std::vector<double> kept = weights(some, depth);
        std::vector<double> largest = weights(all, depth);
        ASSERT_LT(kept.size(), largest.size()) << share;
        largest.resize(kept.size());
        EXPECT_EQ(kept, largest) << share;
        parted += !kept.empty();
    }
    EXPECT_GT(parted, 0);
}

/// A floor under `count` x `count` squares of glass, which overlap, in the light of the sun.
LoadedScene floor_under_glass(int count) {
    std::string text =
        "alhazen 1\npicture { width = 64; height = 64; up_axis = z }\n"
        "perspective_camera \"main\" { eye = (0, -9, 1); look_at = (0, 0, 0); up = (0, 0, 1); "
        "fov_deg "
        "= 40 }\n"
        "directional_light { to_light = (0, 0, 1); color = (1, 1, 1) }\n"
        "material \"glass\" { transmissive = (0.5, 0.8, 0.9) }\n"
        "rectangle { corner = (-4, -4, 0); edge_u = (8, 0, 0); edge_v = (0, 8, 0) }\n";
    for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j) {
            text += "rectangle { corner = (" + std::to_string(-3 + 5.0 * i / count) + ", " +
                    std::to_string(-3 + 5.0 * j / count) + ", " +
                    std::to_string(3 + 0.01 * (i * count + j)) + "); edge_u = (" +
                    std::to_string(8.0 / count) + ", 0, 0); edge_v = (0, " +
                    std::to_string(8.0 / count) + ", 0); material = \"glass\" }\n";
        }
    }
    const testing::ScratchFolder folder;
    const std::filesystem::path path = folder.path() / "glass.alhazen";
    write_file_atomically(path, std::as_bytes(std::span(text)));
    return load(path);
}

TEST(BeamScenes, ShadowsOfGlassDivideAPieceUpToALimit) {
    const BeamScenery s = with_depth(floor_under_glass(16), 0);
    const auto parts_of = [](const BeamTree& tree) {
        std::size_t most = 0;
        for (const BeamPiece& piece : tree.pieces) most = std::max(most, piece.lights.size());
        return most;
    };
    const BeamTree all = tree_of(s.loaded, whole_window());
    ASSERT_GT(parts_of(all), 700u);
    const BeamTree same = tree_of(s.loaded, whole_window(), {.cast = {.most_parts = 100'000}});
    EXPECT_EQ(parts_of(same), parts_of(all));
    const BeamTree some = tree_of(s.loaded, whole_window(), {.cast = {.most_parts = 100}});
    EXPECT_GE(parts_of(some), 100u);
    EXPECT_LT(parts_of(some), 110u);
    // The parts still make up the piece; none is behind more glass than there is.
    const auto sums = [](const BeamTree& tree) {
        std::pair<double, double> sum{0, 0};
        for (const BeamPiece& piece : tree.pieces) {
            for (const BeamLight& light : piece.lights) {
                const auto area = static_cast<double>(twice_area(light.part.region));
                sum.first += area;
                sum.second += area * double(light.part.through.size());
            }
        }
        return sum;
    };
    EXPECT_NEAR(sums(some).first / sums(all).first, 1, 1e-6);
    EXPECT_LT(sums(some).second, 1.05 * sums(all).second);
    EXPECT_GT(sums(some).second, 0.1 * sums(all).second);
}

TEST(BeamScenes, SmallCellsAreNotDivided) {
    const BeamScenery s = with_depth(floor_under_glass(4), 0);
    const BeamTree tree = tree_of(s.loaded, whole_window());
    std::uint32_t most = 0;
    for (std::uint32_t p = 0; p < tree.pieces.size(); ++p) {
        if (tree.pieces[p].lights.size() > tree.pieces[most].lights.size()) most = p;
    }
    const auto behind = pieces_behind(tree);
    const std::vector<BeamCell> all = cells_of(tree, behind, most);
    EXPECT_GE(all.size(), tree.pieces[most].lights.size());
    const PolygonSet& region = tree.pieces[most].seen.region;
    const std::vector<BeamCell> one = cells_of(tree, behind, most, {1e9, 1e9});
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(one[0].region, region);
    EXPECT_LT(cells_of(tree, behind, most, {0.9 * kBeamFilm, 0.9 * kBeamFilm}).size(), all.size());
}

TEST(BoxIndex, FindsAllBoxesThatMeet) {
    testing::Random random(5);
    BoxIndex index;
    for (const int count : {0, 1, 512, 513, 2000}) {
        const LatticeBox whole{{-1000, -2000}, {3000, 2000}};
        index.reset(whole);
        std::vector<LatticeBox> boxes;
        const auto box = [&] {
            const LatticePoint lo{-1200 + random.below(4000), -2200 + random.below(4000)};
            return LatticeBox{lo, {lo.x + random.below(300), lo.y + random.below(100)}};
        };
        for (int k = 0; k < count; ++k) {
            boxes.push_back(box());
            index.add(boxes.back());
        }
        for (int k = 0; k < 100; ++k) {
            const LatticeBox query = box();
            const auto found = index.near(query);
            EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
            for (std::uint32_t i = 0; i < boxes.size(); ++i) {
                if (!boxes[i].meets(query)) continue;
                EXPECT_TRUE(std::binary_search(found.begin(), found.end(), i)) << count << ' ' << k;
            }
            if (count == 2000) {
                EXPECT_LT(found.size(), 300u);
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE

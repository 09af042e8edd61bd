#include "alhazen/laboratory/picture_check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "alhazen/sampling/random.h"

namespace alhazen {
namespace {

constexpr int kLargestTile = 16;
/// Largest share of the time per tile, to get enough tiles.
constexpr double kShareOfTile = 1.0 / 32;

bool same_bits(const Rgb& a, const Rgb& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

bool same_rays(const RayCounters& a, const RayCounters& b) {
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        if (a.rays[k].cast != b.rays[k].cast || a.rays[k].hit != b.rays[k].hit) return false;
    }
    return a.total_internal == b.total_internal;
}

/// Tiles that take at most `most` seconds each, in random order.
std::vector<PixelBox> tiles_by_chance(const PixelBox& frame, double seconds_a_pixel, double most) {
    int side = kLargestTile;
    while (side > 1 && side * side * seconds_a_pixel > most) side /= 2;
    std::vector<PixelBox> tiles = tiles_of(frame, side);
    RandomStream random(2);
    for (std::size_t i = tiles.size(); i > 1; --i) {
        std::swap(tiles[i - 1], tiles[random.below(i)]);
    }
    return tiles;
}

}  // namespace

RenderOptions PictureChecker::options_for(const PixelBox* crop) const {
    RenderOptions options = trial_.render_options();
    options.count_tests = true;
    for (const AovKind cost : {AovKind::NodeVisits, AovKind::BoxTests, AovKind::PrimitiveTests}) {
        options.aovs.add(cost);
    }
    if (crop != nullptr) options.crop = *crop;
    return options;
}

void PictureChecker::compare(const RenderResult& found, const RenderResult& expected,
                             std::vector<float>& cost, PictureCheck& check) const {
    const PixelBox& crop = found.film.crop();
    const auto width = static_cast<std::size_t>(found.film.frame_width());
    const std::vector<LayerChannel>& layers = found.layers.channels();
    std::size_t in_layer = 0;
    for (int y = crop.y0; y < crop.y1; ++y) {
        for (int x = crop.x0; x < crop.x1; ++x) {
            check.differing += !same_bits(found.film.at(x, y), trial_.picture().film.at(x, y));
            double sum = 0;
            for (const LayerChannel& layer : layers) {
                sum += layer.type == SampleType::Uint ? layer.whole[in_layer]
                                                      : double{layer.values[in_layer]};
            }
            cost[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] =
                static_cast<float>(sum);
            ++in_layer;
        }
    }
    check.pixels += crop.area();
    check.same_rays = check.same_rays && same_rays(found.counters, expected.counters);
}

std::vector<float> PictureChecker::check(const Scene& scene, const ReplayFigures& figures,
                                         double seconds, PictureCheck& check) const {
    const RenderResult& reference = trial_.picture();
    const PixelBox frame = reference.film.crop();
    const PictureSettings& settings = trial_.picture_settings();
    std::vector<float> cost(frame.area(), std::numeric_limits<float>::quiet_NaN());
    const double seconds_a_pixel = 1e-9 * figures.nanoseconds() *
                                   static_cast<double>(reference.counters.total_cast()) /
                                   static_cast<double>(frame.area());
    if (seconds_a_pixel * static_cast<double>(frame.area()) <= seconds) {
        compare(render(scene, settings, options_for(nullptr)), reference, cost, check);
        return cost;
    }
    check.complete = false;
    for (const PixelBox& tile : tiles_by_chance(frame, seconds_a_pixel, seconds * kShareOfTile)) {
        const RenderOptions options = options_for(&tile);
        compare(render(scene, settings, options), render(trial_.reference(), settings, options),
                cost, check);
        if (static_cast<double>(check.pixels) * seconds_a_pixel >= seconds) break;
    }
    return cost;
}

}  // namespace alhazen

#include "alhazen/illumination/light_draws.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "alhazen/illumination/illumination_data.h"

namespace alhazen {

LightDraws::LightDraws(const Illumination& lights) : lights_(lights) {
    const Illumination::Data& d = *lights.data_;
    if (d.options.choice == LightChoice::Tree && !d.tree.empty() && d.tree.root().is_leaf()) {
        sole_ = d.tree.choose({}, 0.0);
        sole_is_rectangle_ = d.near_share * sole_.probability > 0.0 && d.is_emitter(sole_.light) &&
                             RectangleLanes::takes(d.emitter(sole_.light));
    }
}

void LightDraws::add(const LitPoint& at, double choice, const Vec2& u, const Wavelengths& waves) {
    const std::size_t lane = size_++;
    calls_.at.set(lane, at);
    calls_.choice[lane] = choice;
    calls_.u[0][lane] = u.x;
    calls_.u[1][lane] = u.y;
    waves_[lane] = &waves;
    if (waves.is_spectral()) spectral_ |= 1u << lane;
}

void LightDraws::draw(std::size_t count) {
    size_ = count;
    spectral_ = 0;
    waves_.fill(&kColorChannels);
    draw();
}

void LightDraws::draw() {
    const double near_share = lights_.data_->near_share;
    const std::uint32_t all = (1u << size_) - 1;
    std::uint32_t near = near_share < 1.0 ? 0 : all;
    if (near_share > 0.0 && near_share < 1.0) {
        for (std::size_t lane = 0; lane < size_; ++lane) {
            near |= std::uint32_t{calls_.choice[lane] < near_share} << lane;
        }
    }
    if (near != all) draw_far(all & ~near);
    if (near != 0) draw_near(near);
}

void LightDraws::draw_far(std::uint32_t lanes) {
    const Illumination::Data& d = *lights_.data_;
    std::size_t sky = 0;
    for_each_lane(lanes, [&](std::size_t lane) {
        const ChosenLight chosen = d.choose_far(calls_.choice[lane]);
        const Vec2 u = calls_.u_of(lane);
        if (chosen.probability > 0.0 && d.is_environment(chosen.light) &&
            d.environment->searches(u)) {
            searches_[sky] = d.environment->begin(u);
            sky_draws_[sky++] = {lane, chosen};
        } else {
            results_.set(lane, d.draw_far(chosen, calls_.at[lane], u, *waves_[lane]));
        }
    });
    if (sky > 0) draw_sky(sky);
}

void LightDraws::draw_sky(std::size_t count) {
    const Illumination::Data& d = *lights_.data_;
    const Environment& sky = *d.environment;
    const std::span<Environment::Search> searches = std::span(searches_).first(count);
    for (const Environment::Search& search : searches) sky.approach(search);
    for (Environment::Search& search : searches) sky.find(search);
    std::array<Vec3, kMost> directions;
    sky.find_directions(searches, directions.data());
    // Those that count come first.
    std::size_t counted = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const SkyDraw draw = sky_draws_[i];
        const LitPoint at = calls_.at[draw.lane];
        if (at.both_sides || at.in_volume || dot(directions[i], at.normal) > 0.0) {
            directions[counted] = directions[i];
            sky_draws_[counted++] = draw;
        } else {
            results_.set(draw.lane, {});
        }
    }
    std::array<Environment::Sight, kMost> sights;
    sky.find_sights(std::span(directions).first(counted), sights.data());
    for (std::size_t i = 0; i < counted; ++i) {
        const auto& [lane, chosen] = sky_draws_[i];
        results_.set(lane, {.to_light = directions[i],
                            .distance = std::numeric_limits<double>::infinity(),
                            .radiance = waves_[lane]->emission(sights[i].radiance),
                            .density = chosen.probability * sights[i].density,
                            .place = {d.near_count() + chosen.light, {}}});
    }
}

void LightDraws::choose_near(std::uint32_t lanes, ChosenLight* chosen) {
    const Illumination::Data& d = *lights_.data_;
    ChoiceLanes choices;
    const auto count = static_cast<std::size_t>(std::popcount(lanes));
    if ((lanes & (lanes + 1)) == 0) {
        // No gaps.
        for (std::size_t i = 0; i < count; ++i) choices.of[i] = calls_.choice[i] / d.near_share;
        return d.choose_near(calls_.at, choices, count, chosen);
    }
    LitPointLanes points;
    std::size_t next = 0;
    for_each_lane(lanes, [&](std::size_t lane) {
        points.set(next, calls_.at[lane]);
        choices.of[next++] = calls_.choice[lane] / d.near_share;
    });
    std::array<ChosenLight, kMost> close;
    d.choose_near(points, choices, count, close.data());
    next = 0;
    for_each_lane(lanes, [&](std::size_t lane) { chosen[lane] = close[next++]; });
}

void LightDraws::draw_near(std::uint32_t lanes) {
    const Illumination::Data& d = *lights_.data_;
    if (sole_is_rectangle_) {
        for_each_lane(lanes, [&](std::size_t lane) { set_rectangle(lane, sole_); });
        return draw_rectangles(lanes);
    }
    std::array<ChosenLight, kMost> chosen;
    if (sole_.probability > 0.0) {
        chosen.fill(sole_);
    } else {
        choose_near(lanes, chosen.data());
    }
    const Left left = d.flat.empty() ? Left{0, lanes} : draw_by_area(lanes, chosen.data());
    std::uint32_t rectangles = 0;
    if (left.near_flat != 0) rectangles = draw_near_flat(left.near_flat, chosen.data());
    if (left.others != 0) {
        // Not functions of one lane: they would have no effect, and compilers leave such calls out.
        for (std::uint32_t rest = d.flat.empty() ? 0 : left.others; rest != 0; rest &= rest - 1) {
            const ChosenLight& one = chosen[static_cast<std::size_t>(std::countr_zero(rest))];
            if (one.probability > 0.0 && d.is_emitter(one.light)) fetch(d.emitter(one.light));
        }
        rectangles |= draw_near_part(left.others, chosen.data());
    }
    if (rectangles != 0) draw_rectangles(rectangles);
}

LightDraws::Left LightDraws::draw_by_area(std::uint32_t lanes, const ChosenLight* chosen) {
    const Illumination::Data& d = *lights_.data_;
    // Chosen emitters of the scene with constant radiance.
    std::uint32_t flat = 0;
    for (std::uint32_t left = lanes & ~spectral_; left != 0; left &= left - 1) {
        const ChosenLight& one = chosen[static_cast<std::size_t>(std::countr_zero(left))];
        if (!(one.probability > 0.0) || one.light >= d.flat.size()) continue;
        fetch(d.flat[one.light]);
        flat |= left & (0u - left);
    }
    std::uint32_t set = 0;
    for_each_lane(flat, [&](std::size_t lane) {
        const FlatEmitter& e = d.flat[chosen[lane].light];
        const double probability = d.near_share * chosen[lane].probability;
        if (!e.is_flat || !(probability > 0.0)) return;
        by_area_.set(lane, e, d.flat_radiances[e.radiance], chosen[lane].light, probability);
        set |= 1u << lane;
    });
    if (set == 0) return {0, lanes};
    return {by_area_.draw(set, calls_, results_), lanes & ~set};
}

std::uint32_t LightDraws::draw_near_flat(std::uint32_t lanes, const ChosenLight* chosen) {
    const Illumination::Data& d = *lights_.data_;
    std::uint32_t rectangles = 0;
    for_each_lane(lanes, [&](std::size_t lane) {
        const std::size_t light = chosen[lane].light;
        const FlatEmitter& e = d.flat[light];
        const Spectrum& radiance = d.flat_radiances[e.radiance];
        const double probability = d.near_share * chosen[lane].probability;
        if (e.form == EmitterForm::Rectangle) {
            rectangles_.set(lane, d.emitter(light), e, radiance, probability);
            rectangle_lights_[lane] = light;
            rectangles |= 1u << lane;
            return;
        }
        const EmitterSample s =
            sample_near(e.triangle(), calls_.at.point_of(lane), calls_.u_of(lane));
        LightDraw draw;
        if (s.density > 0.0 && std::isfinite(s.density)) {
            draw = {.to_light = s.to_light,
                    .distance = s.distance,
                    .radiance = radiance,
                    .density = probability * s.density,
                    .place = {light, s.parameters},
                    .facing = s.facing};
        }
        results_.set(lane, draw);
    });
    return rectangles;
}

std::uint32_t LightDraws::draw_near_part(std::uint32_t lanes, const ChosenLight* chosen) {
    const Illumination::Data& d = *lights_.data_;
    std::uint32_t rectangles = 0;
    for_each_lane(lanes, [&](std::size_t lane) {
        const std::size_t light = chosen[lane].light;
        const double probability = d.near_share * chosen[lane].probability;
        if (!(probability > 0.0)) return results_.set(lane, {});
        if (!d.is_emitter(light) || !RectangleLanes::takes(d.emitter(light)) ||
            is_sampled_by_area(d.emitter(light), calls_.at.point_of(lane))) {
            return results_.set(lane, d.draw_near(light, probability, calls_.at[lane],
                                                  calls_.u_of(lane), *waves_[lane]));
        }
        set_rectangle(lane, chosen[lane]);
        rectangles |= 1u << lane;
    });
    return rectangles;
}

void LightDraws::set_rectangle(std::size_t lane, const ChosenLight& chosen) {
    const Illumination::Data& d = *lights_.data_;
    rectangles_.set(lane, d.emitter(chosen.light), d.constant_radiance(chosen.light),
                    d.near_share * chosen.probability);
    rectangle_lights_[lane] = chosen.light;
}

void LightDraws::draw_rectangles(std::uint32_t lanes) {
    const Illumination::Data& d = *lights_.data_;
    const RectangleLanes::Drawn drawn = rectangles_.draw(lanes, calls_, results_);
    for_each_lane(lanes, [&](std::size_t lane) {
        const bool shines = (drawn.shining >> lane & 1u) != 0;
        results_.places[lane] = {shines ? rectangle_lights_[lane] : 0, {}};
    });
    const std::uint32_t rest =
        lanes & (~drawn.sampled | (drawn.shining & (drawn.varying | spectral_)));
    for_each_lane(rest, [&](std::size_t lane) {
        const EmitterSample sample = rectangles_.sampled(lane, calls_, results_);
        results_.set(lane, d.draw_of_emitter(rectangle_lights_[lane], rectangles_.probability(lane),
                                             calls_.at.point_of(lane), sample, *waves_[lane]));
    });
}

}  // namespace alhazen

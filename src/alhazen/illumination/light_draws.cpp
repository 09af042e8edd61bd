#include "alhazen/illumination/light_draws.h"

#include "alhazen/illumination/illumination_data.h"

namespace alhazen {

void LightDraws::add(const LitPoint& at, double choice, const Vec2& u, const Wavelengths& waves) {
    const Illumination::Data& d = *lights_.data_;
    const std::size_t i = size_++;
    if (choice >= d.near_share) {
        drawn_[i] = d.draw_far(at, choice, u, waves);
        return;
    }
    const ChosenLight chosen = d.choose_near(at, choice / d.near_share);
    const double probability = d.near_share * chosen.probability;
    if (!(probability > 0.0)) {
        drawn_[i] = {};
        return;
    }
    if (!d.is_emitter(chosen.light) || !RectangleLanes::takes(d.emitter(chosen.light))) {
        drawn_[i] = d.draw_near(chosen.light, probability, at, u, waves);
        return;
    }
    rectangles_.set(in_lanes_, d.emitter(chosen.light), at.point, u);
    waiting_[in_lanes_++] = {i, chosen.light, probability, at.point, &waves};
}

void LightDraws::draw() {
    if (in_lanes_ == 0) return;
    rectangles_.draw();
    for (std::size_t lane = 0; lane < in_lanes_; ++lane) {
        const Waiting& w = waiting_[lane];
        drawn_[w.draw] = lights_.data_->draw_of_emitter(w.light, w.probability, w.at,
                                                        rectangles_.sampled(lane), *w.waves);
    }
}

}  // namespace alhazen

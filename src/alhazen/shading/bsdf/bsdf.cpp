#include "alhazen/shading/bsdf/bsdf.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "alhazen/shading/microfacets/local_directions.h"

namespace alhazen {

namespace {

template <class L>
inline constexpr bool singular_v = std::remove_cvref_t<L>::kSingular;

bool is_singular(const Lobe& lobe) {
    return std::visit([](const auto& l) { return singular_v<decltype(l)>; }, lobe);
}
Spectrum albedo_of(const Lobe& lobe, const Vec3& view) {
    return std::visit([&](const auto& l) { return l.albedo(view); }, lobe);
}
Spectrum value_of(const Lobe& lobe, const Vec3& view, const Vec3& direction, Transport transport) {
    return std::visit(
        [&]<class L>(const L& l) {
            if constexpr (L::kSingular) {
                return Spectrum{};
            } else {
                return l.value(view, direction, transport);
            }
        },
        lobe);
}
double density_of(const Lobe& lobe, const Vec3& view, const Vec3& direction) {
    return std::visit(
        [&]<class L>(const L& l) {
            if constexpr (L::kSingular) {
                return 0.0;
            } else {
                return l.density(view, direction);
            }
        },
        lobe);
}

bool is_matt(const Lobe& lobe) {
    return std::holds_alternative<Lambert>(lobe) || std::holds_alternative<OrenNayar>(lobe) ||
           std::holds_alternative<CoveredMatt>(lobe) ||
           std::holds_alternative<LambertTransmission>(lobe);
}
/// False for NaN and infinities.
bool is_usable(const Spectrum& weight) {
    return weight.is_finite() && weight.max() > 0.0;
}

}  // namespace

void Bsdf::add(const Spectrum& weight, const Lobe& lobe, CoverSet covers) {
    if (!is_usable(weight)) return;
    const Part part{weight, covers, lobe};
    if (!parts_.full()) {
        parts_.push_back(part);
        set_traits();
        return;
    }
    const auto importance = [](const Part& p) {
        return (p.weight * albedo_of(p.lobe, {0, 0, 1})).max();
    };
    Unmade<Part>* least = std::ranges::min_element(parts_, {}, importance);
    if (importance(*least) < importance(part)) *least = part;
    set_traits();
}

void Bsdf::set_traits() {
    traits_ = {};
    for (const Part& part : parts_) {
        std::visit(
            [&]<class L>(const L&) {
                traits_.has_density |= !L::kSingular;
                traits_.has_singular |= L::kSingular;
                traits_.transmits |= !L::kSingular && L::kTransmits;
                traits_.lets_through |= L::kTransmits;
            },
            part.lobe);
    }
    matt_ = {};
    chosen_alone_ = is_chosen_alone();
    const Part& first = parts_[0];
    const auto* const matt = std::get_if<Lambert>(&first.lobe);
    if (parts_.size() != 1 || matt == nullptr || first.covers != 0) return;
    matt_.is = true;
    const double share = (first.weight * matt->color).max();
    matt_.is_chosen = share > 0.0 && std::isfinite(share);
    const Spectrum value = first.weight * ((1.0 / kPi) * matt->color);
    if (is_usable(value)) matt_.value = value;
}

bool Bsdf::is_chosen_alone() const {
    const Part& first = parts_[0];
    const auto* const rough = std::get_if<RoughReflection>(&first.lobe);
    if (parts_.size() != 1 || rough == nullptr || first.covers != 0) return false;
    const auto* const term = std::get_if<SchlickTerm>(&rough->fresnel());
    if (term == nullptr) return false;
    const Spectrum f0 = first.weight * term->f0, f90 = first.weight * term->f90;
    bool some = false, sane = f0.is_finite() && f90.is_finite();
    for (int i = 0; i < Spectrum::kCount; ++i) {
        sane = sane && f0[i] >= 0.0 && f90[i] >= 0.0;
        some = some || (f0[i] > 0.0 && f90[i] > 0.0);
    }
    // The albedo is above 0 and finite for every view.
    return some && sane;
}

CoverSet Bsdf::add_cover(const Cover& cover) {
    if (covers_.full() || !(cover.share() > 0.0)) return 0;
    covers_.push_back(cover);
    return CoverSet{1} << (covers_.size() - 1);
}

void Bsdf::add(const Bsdf& other, double weight) {
    if (!(weight > 0.0)) return;
    std::array<CoverSet, decltype(covers_)::capacity()> renamed{};
    for (std::size_t i = 0; i < other.covers_.size(); ++i) {
        renamed[i] = add_cover(other.covers_[i]);
    }
    for (const Part& part : other.parts_) {
        CoverSet covers = 0;
        for (std::size_t i = 0; i < other.covers_.size(); ++i) {
            if ((part.covers >> i & 1) != 0) covers |= renamed[i];
        }
        add(weight * part.weight, part.lobe, covers);
    }
}

void Bsdf::tint(const Spectrum& reflected, const Spectrum& transmitted) {
    for (Unmade<Part>& unmade : parts_) {
        Part& part = unmade.value;
        if (auto* const glass = std::get_if<SmoothDielectric>(&part.lobe)) {
            glass->reflection_tint = reflected * glass->reflection_tint;
            glass->transmission_tint = transmitted * glass->transmission_tint;
            continue;
        }
        const bool transmits =
            std::visit([]<class L>(const L&) { return L::kTransmits; }, part.lobe);
        part.weight = (transmits ? transmitted : reflected) * part.weight;
    }
    if (!parts_.empty()) set_traits();
}

double Bsdf::through(CoverSet covers, const Vec3& direction) const {
    double share = 1.0;
    for (std::size_t i = 0; covers >> i != 0; ++i) {
        if ((covers >> i & 1) != 0) share *= covers_[i].value.transmittance(direction);
    }
    return share;
}

Bsdf::Choice Bsdf::choose(const Vec3& view) const {
    Choice choice;
    if (chosen_alone_) {
        choice.share[0] = 1.0;
        choice.any = true;
        return choice;
    }
    double sum = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const Part& part = parts_[i];
        double share = (part.weight * albedo_of(part.lobe, view)).max();
        // Above 0 even below a cover that is opaque to the view: for importance the other direction
        // counts.
        if (part.covers != 0) share *= std::max(0.02, through(part.covers, view));
        choice.share[i] = share > 0.0 ? share : 0.0;
        sum += choice.share[i];
    }
    if (!(sum > 0.0) || !std::isfinite(sum)) return choice;
    choice.any = true;
    for (std::size_t i = 0; i < parts_.size(); ++i) choice.share[i] /= sum;
    return choice;
}

Spectrum Bsdf::value(const Vec3& view, const Vec3& direction, Transport transport) const {
    return value(view, direction, transport, false);
}

Spectrum Bsdf::diffuse_share(const Vec3& view, const Vec3& direction) const {
    const Spectrum all = value(view, direction, Transport::Radiance, false);
    const Spectrum matt = value(view, direction, Transport::Radiance, true);
    const auto share = [](double part, double whole) { return whole > 0.0 ? part / whole : 0.0; };
    Spectrum result;
    for (int i = 0; i < Spectrum::kCount; ++i) result[i] = share(matt[i], all[i]);
    return result;
}

Spectrum Bsdf::value(const Vec3& view, const Vec3& direction, Transport transport,
                     bool only_matt) const {
    if (!(view.z > 0.0) || direction.z == 0.0) return {};
    if (matt_.is) return direction.z > 0.0 ? matt_.value : Spectrum{};
    const Vec3& outer = transport == Transport::Radiance ? view : direction;
    Spectrum sum;
    for (const Part& part : parts_) {
        if (only_matt && !is_matt(part.lobe)) continue;
        const Spectrum value = part.weight * value_of(part.lobe, view, direction, transport);
        if (!is_usable(value)) continue;
        sum += part.covers != 0 ? through(part.covers, outer) * value : value;
    }
    return sum;
}

double Bsdf::density(const Choice& choice, const Vec3& view, const Vec3& direction) const {
    double sum = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        if (!(choice.share[i] > 0.0)) continue;
        const double density = density_of(parts_[i].value.lobe, view, direction);
        if (density > 0.0 && std::isfinite(density)) sum += choice.share[i] * density;
    }
    return sum;
}

double Bsdf::density(const Vec3& view, const Vec3& direction) const {
    if (!(view.z > 0.0) || direction.z == 0.0) return 0.0;
    if (matt_.is) return matt_.is_chosen ? cosine_density(direction) : 0.0;
    const Choice choice = choose(view);
    return choice.any ? density(choice, view, direction) : 0.0;
}

std::optional<BsdfSample> Bsdf::sample(const Vec3& view, double choice, const Vec2& u,
                                       Transport transport) const {
    if (!(view.z > 0.0)) return std::nullopt;
    if (matt_.is) return sample_matt(view, cosine_direction(u));
    const Choice shares = choose(view);
    if (!shares.any) return std::nullopt;
    std::size_t i = 0;
    double below = 0;
    // Rounding may leave `choice` above the sum: the last part with a share is the default.
    for (std::size_t k = 0; k < parts_.size(); ++k) {
        if (!(shares.share[k] > 0.0)) continue;
        if (i != k && choice < below) break;
        i = k;
        below += shares.share[k];
    }
    const double share = shares.share[i];
    const double rest = std::clamp((choice - (below - share)) / share, 0.0, 0x1.fffffffffffffp-1);

    const Part& part = parts_[i];
    // Only the direction of a sample that is not singular is used.
    auto sample = std::visit(
        [&]<class L>(const L& l) -> std::optional<BsdfSample> {
            if constexpr (requires { l.direction(view, rest, u); }) {
                const std::optional<Vec3> direction = l.direction(view, rest, u);
                if (!direction) return std::nullopt;
                return BsdfSample{.direction = *direction};
            } else {
                return l.sample(view, rest, u, transport);
            }
        },
        part.lobe);
    if (!sample || sample->direction.z == 0.0) return std::nullopt;
    if (sample->singular) {
        const Vec3& outer = transport == Transport::Radiance ? view : sample->direction;
        sample->weight = (through(part.covers, outer) / share) * part.weight * sample->weight;
        sample->density *= share;
    } else {
        sample->density = density(shares, view, sample->direction);
        sample->weight = (std::abs(sample->direction.z) / sample->density) *
                         value(view, sample->direction, transport);
    }
    if (!(sample->density > 0.0) || !is_usable(sample->weight)) return std::nullopt;
    return sample;
}

std::optional<BsdfSample> Bsdf::sample_matt(const Vec3& view, const Vec3& direction) const {
    if (!(view.z > 0.0) || !matt_.is_chosen) return std::nullopt;
    const double density = cosine_density(direction);
    if (!(density > 0.0)) return std::nullopt;
    const Spectrum weight = (direction.z / density) * matt_.value;
    if (!is_usable(weight)) return std::nullopt;
    return BsdfSample{direction, weight, density};
}

Bsdf::RoughAlone Bsdf::rough_alone() const {
    if (!chosen_alone_) return {};
    const Part& only = parts_[0];
    return {&std::get<RoughReflection>(only.lobe), only.weight};
}

Spectrum Bsdf::albedo(const Vec3& view) const {
    if (!(view.z > 0.0)) return {};
    Spectrum sum;
    for (const Part& part : parts_) {
        const Spectrum albedo =
            through(part.covers, view) * part.weight * albedo_of(part.lobe, view);
        if (is_usable(albedo)) sum += albedo;
    }
    return sum;
}

std::optional<Spectrum> Bsdf::lambert() const {
    Spectrum sum;
    for (const Part& part : parts_) {
        if (is_singular(part.lobe)) continue;
        const auto* const matt = std::get_if<Lambert>(&part.lobe);
        if (matt == nullptr || part.covers != 0) return std::nullopt;
        sum += part.weight * matt->color;
    }
    return sum;
}

Spectrum Bsdf::straight(const Vec3& view) const {
    Spectrum sum;
    for (const Part& part : parts_) {
        const auto* const sheet = std::get_if<ThinSheet>(&part.lobe);
        if (sheet == nullptr) continue;
        sum += through(part.covers, view) * (part.weight * sheet->albedo(view));
    }
    return sum;
}

double Bsdf::straight_probability(const Vec3& view) const {
    const Choice choice = choose(view);
    double sum = 0;
    for (std::size_t i = 0; choice.any && i < parts_.size(); ++i) {
        if (std::holds_alternative<ThinSheet>(parts_[i].value.lobe)) sum += choice.share[i];
    }
    return sum;
}

/// Refracted from `view`, with this cosine to the normal below.
static Vec3 direction_behind(const Vec3& view, double cosine) {
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const double length = std::sqrt(view.x * view.x + view.y * view.y);
    const double scale = length > 0.0 ? -sine / length : 0.0;
    return {scale * view.x, scale * view.y, -cosine};
}

SingularLight Bsdf::singular(const Vec3& view, Transport transport) const {
    SingularLight light;
    if (!(view.z > 0.0)) return light;
    for (const Part& part : parts_) {
        const auto add = [&](const Spectrum& share, const Vec3& direction, Spectrum& sum) {
            const Vec3& outer = transport == Transport::Radiance ? view : direction;
            const Spectrum own = through(part.covers, outer) * (part.weight * share);
            if (is_usable(own)) sum += own;
        };
        if (const auto* const mirror = std::get_if<Mirror>(&part.lobe)) {
            add(mirror->albedo(view), view, light.reflected);
        } else if (const auto* const glass = std::get_if<SmoothDielectric>(&part.lobe)) {
            const SmoothDielectric::Shares shares = glass->shares(view, transport);
            add(shares.reflected, view, light.reflected);
            add(shares.transmitted, direction_behind(view, shares.cosine_behind),
                light.transmitted);
            light.eta = glass->eta;
        }
    }
    return light;
}

PlaneMueller Bsdf::polarization(const Vec3& view, const Vec3& direction, bool singular) const {
    Spectrum all;
    PlaneMueller sum;
    for (const Part& part : parts_) {
        if (is_singular(part.lobe) != singular) continue;
        const PolarizedValue own = polarized_value(part.lobe, view, direction);
        const Spectrum weight = through(part.covers, view) * part.weight;
        if (!is_usable(weight * own.all)) continue;
        all += weight * own.all;
        const Spectrum share = weight * own.part;
        sum.q += share * own.matrix.q;
        sum.d += share * own.matrix.d;
        sum.c += share * own.matrix.c;
        sum.e += share * own.matrix.e;
    }
    for (int i = 0; i < Spectrum::kCount; ++i) {
        const double scale = all[i] > 0.0 ? 1.0 / all[i] : 0.0;
        sum.set(i, {scale * sum.q[i], scale * sum.d[i], scale * sum.c[i], scale * sum.e[i]});
    }
    return sum;
}

bool Bsdf::has_rough_boundary() const {
    return std::ranges::any_of(
        parts_, [](const Part& p) { return std::holds_alternative<RoughDielectric>(p.lobe); });
}

bool Bsdf::refracts_alone() const {
    return !parts_.empty() && std::ranges::all_of(parts_, [](const Part& p) {
        return std::holds_alternative<SmoothDielectric>(p.lobe);
    });
}

}  // namespace alhazen

#include "alhazen/shading/microfacets/albedo_table.h"

#include <array>
#include <atomic>
#include <bit>
#include <memory>

#include "alhazen/math/constants.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

constexpr int kAlphas = 32, kMeans = 257;

/// A slice of a table at one alpha, made at the second request, and recent results.
struct AlphaSlice {
    std::uint64_t table = 0;  ///< AlbedoTable::id_; 0: none
    double alpha = 0;
    bool is_made = false;
    std::uint32_t next = 0;      ///< the result to be replaced next
    std::array<double, 2> mu{};  ///< 0: none
    std::array<double, 2> answer{};
    std::array<double, AlbedoTable::kCosines> values{};
};

AlphaSlice& slice_of(std::uint64_t table, double alpha) {
    constexpr std::size_t kSlices = 16;
    // Made at first use: as a thread-local value it would be cleared for every thread.
    thread_local const auto slices = std::make_unique<std::array<AlphaSlice, kSlices>>();
    return (*slices)[mix64(std::bit_cast<std::uint64_t>(alpha) ^ table) % kSlices];
}

std::uint64_t new_id() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

}  // namespace

AlbedoTable::AlbedoTable(const Function& albedo, Axis axis) : id_(new_id()), axis_(axis) {
    table_ = CubicTable<2>({int{kCosines}, kAlphas}, [&](const std::array<double, 2>& p) {
        const double alpha = AlbedoAxes::alpha_of(p[1]);
        return albedo(axis == Axis::Shadow ? AlbedoAxes::mu_of(p[0], alpha)
                                           : std::max(p[0] * p[0], AlbedoAxes::kLeastMu),
                      alpha);
    });
    // Integrated from the interpolated table, so that its errors cancel where both are used.
    mean_ = CubicTable<1>({kMeans}, [&](const std::array<double, 1>& p) {
        const double alpha = AlbedoAxes::alpha_of(p[0]);
        return hemispherical_mean([&](double mu) { return at(mu, alpha); });
    });
}

double AlbedoTable::at(double mu, double alpha) const {
    const double a = std::clamp(alpha, AlbedoAxes::kLeastAlpha, 1.0);
    const double m = std::clamp(mu, AlbedoAxes::kLeastMu, 1.0);
    AlphaSlice& slice = slice_of(id_, a);
    if (slice.table != id_ || slice.alpha != a) {
        slice.table = id_;
        slice.alpha = a;
        slice.is_made = false;
        return std::clamp(table_.at({place_of(axis_, m, a), AlbedoAxes::y_of(a)}), 0.0, 1.0);
    }
    if (!slice.is_made) {
        table_.get_slice(AlbedoAxes::y_of(a), slice.values);
        slice.mu = {};
        slice.is_made = true;
    }
    for (std::size_t i = 0; i < slice.mu.size(); ++i) {
        if (slice.mu[i] == m) return slice.answer[i];
    }
    const double found = std::clamp(
        CubicTable<2>::at(std::span<const double>(slice.values), place_of(axis_, m, a)), 0.0, 1.0);
    slice.mu[slice.next] = m;
    slice.answer[slice.next] = found;
    slice.next = 1 - slice.next;
    return found;
}

AlbedoTable::Slice::Slice(const AlbedoTable& table, double alpha)
    : axis_(table.axis_), alpha_(std::clamp(alpha, AlbedoAxes::kLeastAlpha, 1.0)) {
    std::array<double, kCosines> values;
    table.table_.get_slice(AlbedoAxes::y_of(alpha_), values);
    CubicTable<2>::get_pieces(values, pieces_);
}

double AlbedoTable::Slice::at(double mu) const {
    const double m = std::clamp(mu, AlbedoAxes::kLeastMu, 1.0);
    return std::clamp(CubicTable<2>::at(std::span<const CubicTable<2>::Piece>(pieces_),
                                        place_of(axis_, m, alpha_)),
                      0.0, 1.0);
}

double AlbedoTable::mean(double alpha) const {
    const double a = std::clamp(alpha, AlbedoAxes::kLeastAlpha, 1.0);
    return std::clamp(mean_.at({AlbedoAxes::y_of(a)}), 0.0, 1.0);
}

double matt_rest(double missing_at_view, double missing_at_light, double mean_missing) {
    if (!(mean_missing > 0.0)) return 0.0;
    return missing_at_view * missing_at_light / (kPi * mean_missing);
}

}  // namespace alhazen

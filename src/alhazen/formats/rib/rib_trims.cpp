// The trimming loops of NuPatch.

#include <algorithm>

#include "alhazen/formats/rib/rib_geometry.h"
#include "alhazen/shapes/patches/nurbs/trim_curve_part.h"

namespace alhazen {

namespace {

/// The arguments of TrimCurve, read curve by curve.
class RibTrimReader {
  public:
    RibTrimReader(const RibRequest& request, RibScene& scene)
        : request_(request),
          scene_(scene),
          orders_(request.list(1)),
          knots_(request.list(2)),
          least_(request.list(3)),
          most_(request.list(4)),
          counts_(request.list(5)),
          us_(request.list(6)),
          vs_(request.list(7)),
          ws_(request.list(8)) {}

    bool read(std::vector<TrimLoop>& loops) {
        for (const double curves : request_.list(0)) {
            loops.emplace_back();
            for (double k = 0; k < curves; ++k) {
                TrimCurve curve;
                if (!read_curve(curve)) return false;
                loops.back().push_back(std::move(curve));
            }
        }
        return true;
    }

  private:
    bool read_curve(TrimCurve& curve) {
        const std::size_t i = curve_++;
        if (i >= std::min({orders_.size(), counts_.size(), least_.size(), most_.size()})) {
            return fail("there are fewer orders, ranges or numbers of points than curves");
        }
        if (!(orders_[i] >= 2) || !(orders_[i] <= 33) || !(counts_[i] >= orders_[i]) ||
            !(counts_[i] <= 1e6)) {
            return fail("expected an order from 2 to 33, and as many points or more");
        }
        const auto order = std::size_t(orders_[i]), n = std::size_t(counts_[i]);
        if (n + order > knots_.size() || n > std::min({us_.size(), vs_.size(), ws_.size()})) {
            return fail("there are too few knots or points");
        }
        curve.degree = std::uint32_t(order - 1);
        curve.knots.assign(knots_.begin(), knots_.begin() + std::ptrdiff_t(n + order));
        if (!(least_[i] >= curve.knots[order - 1] && least_[i] < most_[i] &&
              most_[i] <= curve.knots[n])) {
            return fail("the range of the parameter must be within that of the knots");
        }
        knots_ = knots_.subspan(n + order);
        if (!read_points(n, curve)) return false;
        curve = trim_curve_part(std::move(curve), least_[i], most_[i]);
        return true;
    }
    bool read_points(std::size_t n, TrimCurve& curve) {
        bool rational = false;
        for (std::size_t k = 0; k < n; ++k) {
            const double w = ws_[k];
            if (!(w > 0.0)) return fail("weights must be positive");
            rational = rational || w != 1.0;
            curve.points.push_back({us_[k] / w, vs_[k] / w});
            curve.weights.push_back(w);
        }
        if (!rational) curve.weights.clear();
        us_ = us_.subspan(n);
        vs_ = vs_.subspan(n);
        ws_ = ws_.subspan(n);
        return true;
    }
    bool fail(const std::string& what) {
        scene_.error(request_.place, "TrimCurve: curve " + std::to_string(curve_) + ": " + what);
        return false;
    }

    const RibRequest& request_;
    RibScene& scene_;
    std::span<const double> orders_, knots_, least_, most_, counts_, us_, vs_, ws_;
    std::size_t curve_ = 0;
};

}  // namespace

std::shared_ptr<const std::vector<TrimLoop>> read_rib_trims(const RibRequest& request,
                                                            RibScene& scene) {
    auto loops = std::make_shared<std::vector<TrimLoop>>();
    if (!RibTrimReader(request, scene).read(*loops) || loops->empty()) return nullptr;
    return loops;
}

}  // namespace alhazen

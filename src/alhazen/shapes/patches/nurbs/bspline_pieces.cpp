#include "alhazen/shapes/patches/nurbs/bspline_pieces.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

/// Inserts the knot u once into a B-spline curve. Piegl and Tiller, equation 5.15.
/// Preconditions: u is in the domain, its multiplicity is less than the degree.
void insert_knot(std::vector<double>& knots, HomogeneousRow& row, int degree, double u) {
    const auto after = std::upper_bound(knots.begin(), knots.end(), u);
    const auto span = static_cast<int>(after - knots.begin()) - 1;
    const auto before = std::lower_bound(knots.begin(), knots.end(), u);
    const auto multiplicity = static_cast<int>(after - before);
    const HomogeneousRow old = row;
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    row.insert(row.begin() + (span - multiplicity), old[at(span - multiplicity)]);
    for (int i = span - degree + 1; i <= span - multiplicity; ++i) {
        const double share = (u - knots[at(i)]) / (knots[at(i + degree)] - knots[at(i)]);
        row[at(i)] = share * old[at(i)] + (1.0 - share) * old[at(i - 1)];
    }
    knots.insert(knots.begin() + span + 1, u);
}

}  // namespace

void insert_all_knots(std::vector<double>& knots, HomogeneousRow& row, int degree) {
    const auto p = static_cast<std::size_t>(degree);
    std::vector<double> inner(knots.begin() + degree, knots.end() - degree);
    inner.erase(std::unique(inner.begin(), inner.end()), inner.end());
    for (const double u : inner) {
        const auto range = std::equal_range(knots.begin(), knots.end(), u);
        for (auto n = static_cast<std::size_t>(range.second - range.first); n < p; ++n) {
            insert_knot(knots, row, degree, u);
        }
    }
}

std::vector<KnotSpan> knot_spans(const std::vector<double>& knots, int degree, double lo,
                                 double hi) {
    const auto p = static_cast<std::size_t>(degree);
    std::vector<KnotSpan> spans;
    for (std::size_t k = p; k + p + 1 < knots.size(); ++k) {
        if (knots[k] >= lo && knots[k] < knots[k + 1] && knots[k + 1] <= hi) {
            spans.push_back({knots[k], knots[k + 1], k - p});
        }
    }
    return spans;
}

bool check_knots(FieldChecks& checks, const std::string& name, const std::vector<double>& knots,
                 std::uint32_t degree) {
    bool good = true;
    const auto fail = [&](const std::string& what) {
        checks.fail(name + what);
        good = false;
    };
    if (knots.size() < 2 * (std::size_t{degree} + 1)) {
        fail(": degree " + std::to_string(degree) + " needs at least " +
             std::to_string(2 * (std::size_t{degree} + 1)) + " knots, found " +
             std::to_string(knots.size()));
        return false;
    }
    for (std::size_t k = 0; k < knots.size(); ++k) {
        if (!(std::abs(knots[k]) <= kMaxCoordinate)) {
            fail(": knot " + std::to_string(k) + " must be a finite number");
        } else if (k > 0 && knots[k] < knots[k - 1]) {
            fail(": knot " + std::to_string(k) + " is less than the one before it");
        }
    }
    if (!(knots[degree] < knots[knots.size() - degree - 1])) {
        fail(": the domain is empty");
        return false;
    }
    for (std::size_t k = 1; k + degree + 1 < knots.size(); ++k) {
        if (knots[k] == knots[k + degree] && knots[k] > knots[degree] &&
            knots[k] < knots[knots.size() - degree - 1]) {
            fail(": knot " + std::to_string(k) + " repeats more often than the degree, " +
                 std::to_string(degree));
        }
    }
    return good;
}

}  // namespace alhazen

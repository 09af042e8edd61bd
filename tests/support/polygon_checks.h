#pragma once
/// Compares all operations on a pair of sets with exact areas and with each other.

#include <cmath>
#include <optional>
#include <string>

#include "alhazen/geometry/polygon_sets/mending.h"
#include "alhazen/geometry/polygon_sets/set_operations.h"
#include "alhazen/geometry/polygon_sets/weiler_atherton.h"
#include "support/exact_areas.h"
#include "support/random_polygons.h"

namespace alhazen {

struct PolygonChecks {
    long operations = 0;
    long general = 0;  ///< pairs solved by Weiler and Atherton's walk
    long rounded = 0;  ///< pairs whose results were rounded
};

/// True if polygon_set returns the set for its own loops, without mending.
inline bool is_canonical(const PolygonSet& set) {
    Mending mending;
    const PolygonSet again = polygon_set(loops_of(set), &mending);
    return again == set && mending.crossings == 0 && mending.overlaps == 0 &&
           mending.flat_loops == 0 && mending.repeated_points == 0;
}

/// Describes the first error of the operations on a and b; empty: none. Number: exact_areas.h.
template <class Number>
std::string polygon_flaw(const PolygonSet& a, const PolygonSet& b, PolygonChecks& checks) {
    const Arrangement& exact = exact_arrangement(a, b);
    const Number common = common_area<Number>(a, b);
    const Number area_a(twice_area(a));
    const Number area_b(twice_area(b));
    if (!(arrangement_area<Number>(exact, {false, false, false, true}) == common)) {
        return "area of the intersection";
    }
    if (!(arrangement_area<Number>(exact, {false, true, false, false}) == area_a - common)) {
        return "area of the difference";
    }
    if (!(arrangement_area<Number>(exact, {false, true, true, true}) == area_a + area_b - common)) {
        return "area of the union";
    }
    checks.operations += 3;
    checks.rounded += exact.rounds ? 1 : 0;
    const bool rounds = exact.rounds;
    const PolygonCut parts = cut(a, b);
    const PolygonSet all = union_of(a, b);
    const PolygonSet rest = difference(b, a);
    if (twice_area(all) !=
        twice_area(parts.inside) + twice_area(parts.outside) + twice_area(rest)) {
        return "rounded areas do not add up";
    }
    if (twice_area(symmetric_difference(a, b)) != twice_area(parts.outside) + twice_area(rest)) {
        return "area of the symmetric difference";
    }
    const Int128 moved = twice_area(parts.inside) + twice_area(parts.outside) - twice_area(a);
    if (rounds ? std::abs(static_cast<double>(moved)) > 2 * (perimeter(a) + 4) : moved != 0) {
        return "rounding moves too far";
    }
    for (const PolygonSet* set : {&parts.inside, &parts.outside, &all, &rest}) {
        if (!is_canonical(*set)) {
            return "not canonical";
        }
    }
    if (!intersection(parts.inside, parts.outside).empty()) {
        return "parts overlap";
    }
    if (const std::optional<WeilerAtherton> walked = weiler_atherton(a, b)) {
        ++checks.general;
        if (walked->inside != parts.inside || walked->outside != parts.outside ||
            walked->merged != all) {
            return "Weiler and Atherton's walk differs";
        }
    }
    return {};
}

/// Alternately subtracts pieces from a polygon and adds pieces. Describes an error; empty: none.
inline std::string chain_flaw(int operations) {
    RandomPolygons random(24);
    PolygonSet set = lattice_rectangle({-1000000, -1000000}, {1000000, 1000000});
    double moved = 0;
    for (int i = 0; i < operations; ++i) {
        LatticeLoop loop = random.star(200000 + random.below(1000000), 9);
        const LatticePoint shift = random.point(1000000);
        for (LatticePoint& p : loop) {
            p = {p.x + shift.x, p.y + shift.y};
        }
        const PolygonSet piece = polygon_set(loop);
        PolygonCut parts = cut(set, piece);
        const Int128 both = twice_area(parts.inside) + twice_area(parts.outside);
        moved += std::abs(static_cast<double>(both - twice_area(set)));
        if (i % 2 == 0) {
            set = std::move(parts.outside);
        } else {
            PolygonSet merged = union_of(set, piece);
            if (twice_area(merged) != both + twice_area(difference(piece, set))) {
                return "areas at operation " + std::to_string(i);
            }
            set = std::move(merged);
        }
        if (i % 100 == 0 && !is_canonical(set)) {
            return "form at operation " + std::to_string(i);
        }
    }
    return moved < operations * 1e-6 * 8e12 ? "" : "the outline wanders";
}

}  // namespace alhazen

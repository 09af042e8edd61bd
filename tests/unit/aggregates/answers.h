#pragma once
/// Comparison of two aggregates by the same queries.

#include <algorithm>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "alhazen/primitives/aggregate.h"

namespace alhazen::testing {

inline std::string show(const Vec3& v) {
    std::ostringstream out;
    out << std::hexfloat << "{" << v.x << ", " << v.y << ", " << v.z << "}";
    return out.str();
}
inline std::string show(const Ray& ray) {
    std::ostringstream out;
    out << "origin " << show(ray.origin) << " direction " << show(ray.direction) << " t "
        << std::hexfloat << ray.t_min << " to " << ray.t_max;
    return out.str();
}
inline std::string show(const Hit& hit) {
    std::ostringstream out;
    out << "primitive " << static_cast<std::uint32_t>(hit.primitive) << " t " << std::hexfloat
        << hit.t << " u " << hit.u << " v " << hit.v << " part " << hit.part;
    return out.str();
}
inline bool same_bits(double a, double b) {
    return std::memcmp(&a, &b, sizeof(a)) == 0;
}
inline bool same(const Hit& a, const Hit& b) {
    return a.primitive == b.primitive && same_bits(a.t, b.t) && same_bits(a.u, b.u) &&
           same_bits(a.v, b.v) && a.part == b.part && a.path == b.path;
}

/// All query results of an aggregate for a ray.
struct Answer {
    Hit closest;
    bool found = false, occluded = false, shadowed = false;
    std::vector<Hit> all, crossings;
};

/// The nearest hit is asked for with a record that holds another one: every query sets all of it.
inline Answer ask(const Aggregate& aggregate, const Ray& ray, RayMask mask = kAllRays) {
    Answer answer;
    answer.closest.t = answer.closest.u = answer.closest.v = -1;
    answer.closest.part = 3;
    answer.closest.primitive = PrimitiveId{4};
    answer.closest.path.push_back(PrimitiveId{5});
    const RayQuery query{nullptr, mask};
    answer.found = aggregate.closest(ray, answer.closest, query);
    answer.occluded = aggregate.occluded(ray, query);
    aggregate.all_hits(ray, answer.all, query);
    answer.shadowed = aggregate.shadowed(ray, answer.crossings, query);
    if (answer.shadowed) answer.crossings.clear();  // crossings are meaningless then
    return answer;
}

/// Describes the first difference; empty if there is none.
inline std::string difference(const Answer& list, const Answer& tested) {
    const auto same_all = [](const std::vector<Hit>& a, const std::vector<Hit>& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
    };
    if (tested.found != list.found || !same(list.closest, tested.closest)) {
        return "closest: " + show(list.closest) + " became " + show(tested.closest);
    }
    if (tested.occluded != list.occluded || list.occluded != list.found) return "occluded";
    if (!same_all(list.all, tested.all)) {
        return "all hits: " + std::to_string(list.all.size()) + " became " +
               std::to_string(tested.all.size());
    }
    if (list.shadowed != tested.shadowed) return "shadowed";
    if (!same_all(list.crossings, tested.crossings)) return "crossings of a shadow ray";
    return "";
}

}  // namespace alhazen::testing

#include "alhazen/formats/brlcad/brlcad_v4_solids.h"

namespace alhazen {

namespace {

/// Numbers of the solid types.
enum Type : std::int64_t {
    kTorus = 16,
    kTgc = 18,
    kEllipsoid = 19,
    kArb8 = 20,
    kHalf = 24,
    kRpc = 26,
    kRhc = 27,
    kEpa = 28,
    kEhy = 29,
    kEto = 30,
    kSuperell = 35,
    kHyp = 38,
};

BrlcadSolid conic_cylinder(const std::array<double, 24>& s, const Vec3* v, bool hyperbolic) {
    return {hyperbolic ? "rhc" : "rpc",
            BrlcadConicCylinder{v[0], v[1], v[2], s[9], hyperbolic ? s[10] : 0.0, hyperbolic}};
}

BrlcadSolid conic_dome(const std::array<double, 24>& s, const Vec3* v, bool hyperbolic) {
    return {hyperbolic ? "ehy" : "epa",
            BrlcadConicDome{v[0], v[1], v[2], s[9], s[10], hyperbolic ? s[11] : 0.0, hyperbolic}};
}

}  // namespace

BrlcadSolid brlcad_v4_solid(std::int64_t type, const std::array<double, 24>& s) {
    std::array<Vec3, 8> v;
    for (std::size_t i = 0; i < 8; ++i) v[i] = {s[3 * i], s[3 * i + 1], s[3 * i + 2]};
    switch (type) {
        case kTorus: {
            // A horn torus, in float: the tube's radius may exceed the other by rounding.
            constexpr double kRounding = 1e-6;
            const double major = length(v[2]), minor = length(v[1]);
            const bool rounded = minor > major && minor <= (1.0 + kRounding) * major;
            return {"tor", BrlcadTorus{v[0], v[1], major, rounded ? major : minor}};
        }
        case kTgc:
            return {"tgc", BrlcadTgc{v[0], v[1], v[2], v[3], v[4], v[5]}};
        case kEllipsoid:
            return {"ell", BrlcadEllipsoid{v[0], v[1], v[2], v[3]}};
        case kArb8: {
            // All corners except the first are relative to the first.
            for (std::size_t i = 1; i < 8; ++i) v[i] = v[0] + v[i];
            return {"arb8", BrlcadArb8{v}};
        }
        case kHalf:
            return {"half", BrlcadHalfSpace{v[0], s[3]}};
        case kRpc:
            return conic_cylinder(s, v.data(), false);
        case kRhc:
            return conic_cylinder(s, v.data(), true);
        case kEpa:
            return conic_dome(s, v.data(), false);
        case kEhy:
            return conic_dome(s, v.data(), true);
        case kEto:
            return {"eto", BrlcadEllipticTorus{v[0], v[1], v[2], s[9], s[10]}};
        case kSuperell:
            return {"superell", BrlcadSuperellipsoid{v[0], v[1], v[2], v[3], s[12], s[13]}};
        case kHyp:
            return {"hyp", BrlcadHyperboloid{v[0], v[1], v[2], s[9], s[10]}};
        default:
            return {"solid of type " + std::to_string(type), BrlcadUnsupported{}};
    }
}

BrlcadMesh brlcad_ars(const std::vector<Vec3>& points, std::size_t curves,
                      std::size_t points_per_curve) {
    BrlcadMesh ars;
    ars.mesh = std::make_shared<TriangleMesh>();
    ars.mesh->positions = points;
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
        if (points[a] == points[b] || points[b] == points[c] || points[c] == points[a]) return;
        ars.mesh->triangles.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                                       static_cast<std::uint32_t>(c)});
    };
    for (std::size_t i = 0; i + 1 < curves; ++i) {
        for (std::size_t j = 0; j < points_per_curve; ++j) {
            const std::size_t next = j + 1 == points_per_curve ? 0 : j + 1;
            const std::size_t here = i * points_per_curve;
            const std::size_t above = here + points_per_curve;
            add(here + j, above + next, here + next);
            add(above + j, above + next, here + j);
        }
    }
    return ars;
}

}  // namespace alhazen

#include "alhazen/formats/rib/rib_geometry.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace alhazen {

namespace {

/// Reads an argument that is an integer in [least, most].
bool read_rib_count(const RibRequest& request, std::size_t argument, const char* what, int least,
                    int most, int& out, RibScene& scene) {
    const std::optional<double> number = request.number(argument);
    const bool good =
        number && *number >= least && *number <= most && *number == std::floor(*number);
    if (good) {
        out = int(*number);
        return true;
    }
    scene.error(
        argument < request.arguments.size() ? request.arguments[argument].place : request.place,
        std::string(request.name) + ": " + what + " must be a whole number from " +
            std::to_string(least) + " to " + std::to_string(most));
    return false;
}

struct RibPoints {
    std::vector<HomogeneousPoint> points;
    bool rational = false;  ///< "Pw"
};

/// Reads the control points "P" or "Pw" from the parameters from `first` on.
bool read_rib_points(const RibRequest& request, std::size_t first, RibPoints& read,
                     RibScene& scene) {
    for (std::size_t k = first; k + 1 < request.arguments.size(); k += 2) {
        const std::string* declared = request.string(k);
        if (declared == nullptr) break;
        const std::string name = declared->substr(declared->find_last_of(' ') + 1);
        const std::size_t width = name == "P" ? 3 : name == "Pw" ? 4 : 0;
        if (width == 0) continue;
        const std::span<const double> n = request.list(k + 1);
        if (n.empty() || n.size() % width != 0) {
            scene.error(request.arguments[k + 1].place,
                        "\"" + name + "\" has " + std::to_string(n.size()) + " numbers; expected " +
                            std::to_string(width) + " for each point");
            return false;
        }
        read.rational = width == 4;
        for (std::size_t i = 0; i < n.size(); i += width) {
            read.points.push_back({n[i], n[i + 1], n[i + 2], read.rational ? n[i + 3] : 1.0});
        }
        return true;
    }
    scene.error(request.place, std::string(request.name) + ": expected \"P\" or \"Pw\"");
    return false;
}

bool has_rib_points(const RibRequest& request, std::size_t found, std::uint64_t wanted,
                    RibScene& scene) {
    if (found == wanted) return true;
    scene.error(request.place, std::string(request.name) + " has " + std::to_string(found) +
                                   " points; expected " + std::to_string(wanted));
    return false;
}

/// True for "bicubic", false for "bilinear"; none after an error.
std::optional<bool> is_rib_bicubic(const RibRequest& request, RibScene& scene) {
    const std::string* type = request.string(0);
    if (type != nullptr && (*type == "bicubic" || *type == "bilinear")) return *type == "bicubic";
    scene.error(request.place,
                std::string(request.name) + ": expected \"bicubic\" or \"bilinear\"");
    return std::nullopt;
}

/// The patch whose first control point is (u, v) of a net of nu * nv points, which wraps around.
BezierNet rib_net(const RibState& state, bool bicubic, const RibPoints& read, std::size_t nu,
                  std::size_t nv, std::size_t u, std::size_t v) {
    const auto point = [&](std::size_t i, std::size_t j) {
        return read.points[(v + j) % nv * nu + (u + i) % nu];
    };
    BezierNet net;
    if (bicubic) {
        std::array<HomogeneousPoint, 16> p;
        for (std::size_t k = 0; k < 16; ++k) p[k] = point(k / 4, k % 4);
        net = bezier_of(state.basis_u, state.basis_v, p);
        // Control vectors of a basis may be tangents, which have no weight.
        if (!read.rational) {
            for (HomogeneousPoint& q : net.points) q.w = 1.0;
        }
        return net;
    }
    net.degree_u = net.degree_v = 1;
    for (std::size_t k = 0; k < 4; ++k) net.points[k] = point(k / 2, k % 2);
    return net;
}

void read_rib_patch(const RibRequest& request, const RibState& state, RibScene& scene) {
    const std::optional<bool> bicubic = is_rib_bicubic(request, scene);
    RibPoints points;
    if (!bicubic || !read_rib_points(request, 1, points, scene)) return;
    const std::size_t side = *bicubic ? 4 : 2;
    if (!has_rib_points(request, points.points.size(), side * side, scene)) return;
    scene.add_patch(state, rib_net(state, *bicubic, points, side, side, 0, 0), request.place);
}

/// One direction of a patch mesh.
struct RibSpan {
    int points = 0, patches = 0, step = 1;
};

bool read_rib_span(const RibRequest& request, std::size_t argument, bool bicubic, int step,
                   RibSpan& span, RibScene& scene) {
    constexpr int kMostPoints = 100'000'000;
    const int order = bicubic ? 4 : 2;
    if (!read_rib_count(request, argument, "the number of points", 2, kMostPoints, span.points,
                        scene)) {
        return false;
    }
    const std::string* wrap = request.string(argument + 1);
    if (wrap == nullptr || (*wrap != "periodic" && *wrap != "nonperiodic")) {
        scene.error(request.place, "PatchMesh: expected \"periodic\" or \"nonperiodic\"");
        return false;
    }
    span.step = bicubic ? step : 1;
    const bool periodic = *wrap == "periodic";
    const int rest = periodic ? span.points : span.points - order;
    if (rest < 0 || rest % span.step != 0) {
        scene.error(request.arguments[argument].place,
                    "PatchMesh: " + std::to_string(span.points) + " points with the step " +
                        std::to_string(span.step) + " make no whole number of patches");
        return false;
    }
    span.patches = periodic ? rest / span.step : rest / span.step + 1;
    return true;
}

void read_rib_patch_mesh(const RibRequest& request, const RibState& state, RibScene& scene) {
    const std::optional<bool> bicubic = is_rib_bicubic(request, scene);
    RibSpan u, v;
    RibPoints points;
    if (!bicubic || !read_rib_span(request, 1, *bicubic, state.step_u, u, scene) ||
        !read_rib_span(request, 3, *bicubic, state.step_v, v, scene) ||
        !read_rib_points(request, 5, points, scene) ||
        !has_rib_points(request, points.points.size(),
                        std::uint64_t(u.points) * std::uint64_t(v.points), scene)) {
        return;
    }
    const int before = scene.errors();
    for (int j = 0; j < v.patches && scene.errors() == before; ++j) {
        for (int i = 0; i < u.patches && scene.errors() == before; ++i) {
            scene.add_patch(
                state,
                rib_net(state, *bicubic, points, std::size_t(u.points), std::size_t(v.points),
                        std::size_t(i) * std::size_t(u.step), std::size_t(j) * std::size_t(v.step)),
                request.place);
        }
    }
}

// --- NURBS.

/// The arguments n, order, knots, least and greatest parameter of one direction.
struct RibKnots {
    int points = 0, order = 0;
    std::vector<double> knots;
    double least = 0, most = 0;
};

bool check_rib_knots(const RibKnots& k, const RibPlace& place, RibScene& scene) {
    if (k.knots.size() != std::size_t(k.points) + std::size_t(k.order)) {
        scene.error(place, "expected " + std::to_string(k.points + k.order) + " knots for " +
                               std::to_string(k.points) + " points of order " +
                               std::to_string(k.order) + ", found " +
                               std::to_string(k.knots.size()));
        return false;
    }
    for (std::size_t i = 1; i < k.knots.size(); ++i) {
        if (k.knots[i] >= k.knots[i - 1]) continue;
        scene.error(place, "knot " + std::to_string(i) + " falls below the one before");
        return false;
    }
    const double lo = k.knots[std::size_t(k.order) - 1], hi = k.knots[std::size_t(k.points)];
    if (k.least >= lo && k.least < k.most && k.most <= hi) return true;
    scene.error(place, "the range of the parameter must be within that of the knots");
    return false;
}

bool read_rib_knots(const RibRequest& request, std::size_t first, RibKnots& out, RibScene& scene) {
    constexpr int kMostPoints = 1'000'000;
    if (!read_rib_count(request, first, "the number of points", 2, kMostPoints, out.points,
                        scene) ||
        !read_rib_count(request, first + 1, "the order", 2, kMaxPatchOrder, out.order, scene)) {
        return false;
    }
    const std::span<const double> knots = request.list(first + 2);
    out.knots.assign(knots.begin(), knots.end());
    const std::optional<double> least = request.number(first + 3), most = request.number(first + 4);
    if (!least || !most) {
        scene.error(request.place, "NuPatch: expected a range of the parameter after the knots");
        return false;
    }
    out.least = *least;
    out.most = *most;
    return check_rib_knots(out, request.arguments[first + 2].place, scene);
}

/// True if the parameter range is that of the knots.
bool is_whole(const RibKnots& k) {
    return k.least == k.knots[std::size_t(k.order) - 1] && k.most == k.knots[std::size_t(k.points)];
}

void set_rib_trims(const RibState& state, const RibKnots& u, const RibKnots& v, NurbsSurface& s) {
    if (state.trims != nullptr) s.trims = *state.trims;
    const bool trimmed = !s.trims.empty();
    if (trimmed ? state.keeps_inside : is_whole(u) && is_whole(v)) return;
    // By the odd-even rule: the parameter range without the loops.
    s.trims.insert(s.trims.begin(), TrimLoop{TrimCurve{.points = {{u.least, v.least},
                                                                  {u.most, v.least},
                                                                  {u.most, v.most},
                                                                  {u.least, v.most},
                                                                  {u.least, v.least}}}});
}

void read_rib_nu_patch(const RibRequest& request, const RibState& state, RibScene& scene) {
    RibKnots u, v;
    RibPoints points;
    const bool knots = read_rib_knots(request, 0, u, scene);
    if (!read_rib_knots(request, 5, v, scene) || !knots ||
        !read_rib_points(request, 10, points, scene) ||
        !has_rib_points(request, points.points.size(),
                        std::uint64_t(u.points) * std::uint64_t(v.points), scene)) {
        return;
    }
    NurbsSurface s;
    s.degree_u = std::uint32_t(u.order - 1);
    s.degree_v = std::uint32_t(v.order - 1);
    set_rib_trims(state, u, v, s);
    bool rational = false;
    for (std::size_t i = 0; i < std::size_t(u.points); ++i) {
        for (std::size_t j = 0; j < std::size_t(v.points); ++j) {
            const HomogeneousPoint& p = points.points[j * std::size_t(u.points) + i];
            if (!(p.w > 0.0)) {
                scene.error(request.place, "the weights of a surface must be positive, not " +
                                               std::to_string(p.w));
                return;
            }
            rational = rational || p.w != 1.0;
            s.points.push_back(projected(p));
            s.weights.push_back(p.w);
        }
    }
    if (!rational) s.weights.clear();
    s.knots_u = std::move(u.knots);
    s.knots_v = std::move(v.knots);
    scene.add_shape(state, AnyShape{std::move(s)}, request.place);
}

// --- Quadrics.

/// The numbers of a quadric, given one by one or as one array; parameters after them are no part.
std::vector<double> numbers_of_rib_quadric(const RibRequest& request) {
    std::vector<double> n;
    for (std::size_t k = 0; k < request.arguments.size() && request.is_numbers(k); ++k) {
        const std::span<const double> more = request.list(k);
        n.insert(n.end(), more.begin(), more.end());
        if (request.arguments[k].kind == RibArgument::Kind::Numbers) break;
    }
    return n;
}

using RibNumbers = std::span<const double>;

std::optional<AnyShape> whole_rib_sphere(RibNumbers n) {
    const double r = std::fabs(n[0]);
    if (n[1] > -r || n[2] < r) return std::nullopt;
    return Sphere{{0, 0, 0}, r};
}
std::optional<AnyShape> whole_rib_cone(RibNumbers n) {
    if (n[0] == 0.0) return Disc{{0, 0, 0}, {0, 0, 1}, std::fabs(n[1]), 0.0};
    return Cone{{0, 0, 0}, {0, 0, n[0]}, std::fabs(n[1]), 0.0, false};
}
std::optional<AnyShape> whole_rib_cylinder(RibNumbers n) {
    return Cylinder{{0, 0, n[1]}, {0, 0, n[2]}, std::fabs(n[0]), false};
}
std::optional<AnyShape> whole_rib_disk(RibNumbers n) {
    return Disc{{0, 0, n[0]}, {0, 0, 1}, std::fabs(n[1]), 0.0};
}
std::optional<AnyShape> whole_rib_torus(RibNumbers n) {
    if (std::fabs(n[3] - n[2]) < 360.0) return std::nullopt;
    return Torus{{0, 0, 0}, {0, 0, 1}, n[0], n[1]};
}
std::optional<AnyShape> whole_rib_paraboloid(RibNumbers n) {
    if (n[1] != 0.0) return std::nullopt;
    return Paraboloid{{0, 0, 0}, {0, 0, n[2]}, {n[0], 0, 0}, {0, n[0], 0}, false};
}

/// A quadric of the interface; the last of its numbers is the angle of the sweep in degrees.
struct RibQuadric {
    std::string_view name;
    std::size_t count;  ///< of its numbers
    bool (*has_extent)(RibNumbers);
    /// None for a part of the shape.
    std::optional<AnyShape> (*whole)(RibNumbers);
};
constexpr std::array kRibQuadrics{
    RibQuadric{"Sphere", 4, [](RibNumbers n) { return n[0] != 0.0 && n[1] < n[2]; },
               whole_rib_sphere},
    RibQuadric{"Cone", 3, [](RibNumbers n) { return n[1] != 0.0; }, whole_rib_cone},
    RibQuadric{"Cylinder", 4, [](RibNumbers n) { return n[0] != 0.0 && n[1] != n[2]; },
               whole_rib_cylinder},
    RibQuadric{"Disk", 3, [](RibNumbers n) { return n[1] != 0.0; }, whole_rib_disk},
    RibQuadric{"Torus", 5, [](RibNumbers n) { return n[0] != 0.0 && n[1] != 0.0; },
               whole_rib_torus},
    RibQuadric{"Paraboloid", 4, [](RibNumbers n) { return n[0] != 0.0 && n[1] != n[2]; },
               whole_rib_paraboloid},
};

void read_rib_quadric(const RibQuadric& quadric, const RibRequest& request, const RibState& state,
                      RibScene& scene) {
    const std::vector<double> n = numbers_of_rib_quadric(request);
    const std::string name(quadric.name);
    if (n.size() != quadric.count) {
        return scene.error(request.place, name + ": expected " + std::to_string(quadric.count) +
                                              " numbers, found " + std::to_string(n.size()));
    }
    const double sweep = n.back();
    if (sweep == 0.0 || !quadric.has_extent(n)) {
        return scene.leave_out(name + " without extent", request.place);
    }
    std::optional<AnyShape> shape;
    if (std::fabs(sweep) >= 360.0) shape = quadric.whole(n);
    if (!shape) return scene.leave_out("partial " + name, request.place);
    if (const auto* torus = std::get_if<Torus>(&*shape);
        torus != nullptr && torus->minor_radius > torus->major_radius) {
        return scene.leave_out("Torus that penetrates itself", request.place);
    }
    scene.add_shape(state, std::move(*shape), request.place);
}

/// Geometry of the interface that has no shape here.
constexpr std::array<std::string_view, 14> kLeftOut{"Polygon",        "GeneralPolygon",
                                                    "PointsPolygons", "PointsGeneralPolygons",
                                                    "Curves",         "Points",
                                                    "Hyperboloid",    "SubdivisionMesh",
                                                    "Blobby",         "HierarchicalSubdivisionMesh",
                                                    "Geometry",       "Procedural",
                                                    "Procedural2",    "ReadArchive"};

}  // namespace

bool read_rib_geometry(const RibRequest& request, const RibState& state, RibScene& scene) {
    if (request.name == "Patch") {
        read_rib_patch(request, state, scene);
    } else if (request.name == "PatchMesh") {
        read_rib_patch_mesh(request, state, scene);
    } else if (request.name == "NuPatch") {
        read_rib_nu_patch(request, state, scene);
    } else if (std::find(kLeftOut.begin(), kLeftOut.end(), request.name) != kLeftOut.end()) {
        scene.leave_out(std::string(request.name), request.place);
    } else {
        const auto* quadric =
            std::find_if(kRibQuadrics.begin(), kRibQuadrics.end(),
                         [&](const RibQuadric& entry) { return entry.name == request.name; });
        if (quadric == kRibQuadrics.end()) return false;
        read_rib_quadric(*quadric, request, state, scene);
    }
    return true;
}

}  // namespace alhazen

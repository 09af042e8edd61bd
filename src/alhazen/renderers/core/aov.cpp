#include "alhazen/renderers/core/aov.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "alhazen/base/error.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/renderers/core/aov_geometry.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

void write_geometry(AovFilm& film, int i, int j, const PixelGeometry& g) {
    const double share = g.hits > 0 ? 1.0 / g.hits : 0.0;
    const auto set = [&](AovKind kind, std::initializer_list<double> values) {
        film.set(kind, i, j, {values.begin(), values.size()});
    };
    const auto set_vector = [&](AovKind kind, const Vec3& v) { set(kind, {v.x, v.y, v.z}); };
    set(AovKind::Alpha, {static_cast<double>(g.hits) / g.samples});
    set(AovKind::Depth, {g.hits > 0 ? share * g.depth : std::numeric_limits<double>::infinity()});
    set_vector(AovKind::Normal, unit_or(g.normal, {}));
    set_vector(AovKind::GeometricNormal, unit_or(g.geometric, {}));
    set_vector(AovKind::Position, share * g.position);
    set(AovKind::Uv, {share * g.uv.x, share * g.uv.y});
    const Rgb albedo = share * g.albedo;
    set(AovKind::Albedo, {albedo.r, albedo.g, albedo.b});
    set(AovKind::ErrorBound, {g.error});
    film.set_whole(AovKind::ObjectId, i, j, g.object);
    film.set_whole(AovKind::MaterialId, i, j, g.material);
    film.set_whole(AovKind::InstanceId, i, j, g.instance);
}

std::span<const AovEntry> aov_table() {
    using enum SampleType;
    static const std::vector<AovEntry> table{
        {AovKind::Alpha,
         "alpha",
         "fraction of the pixel's samples that hit a surface",
         {"A"},
         Half},
        {AovKind::Depth, "depth", "distance from the eye along the view axis", {"depth.Z"}, Float},
        {AovKind::Normal,
         "N",
         "shading normal, world space, towards the eye",
         {"N.X", "N.Y", "N.Z"},
         Float},
        {AovKind::GeometricNormal,
         "Ng",
         "geometric normal, world space, towards the eye",
         {"Ng.X", "Ng.Y", "Ng.Z"},
         Float},
        {AovKind::Position, "P", "point, world space", {"P.X", "P.Y", "P.Z"}, Float},
        {AovKind::Uv, "uv", "texture coordinates", {"uv.U", "uv.V"}, Float},
        {AovKind::Albedo,
         "albedo",
         "colour of the surface: base colour or diffuse coefficient",
         {"albedo.R", "albedo.G", "albedo.B"},
         Half},
        {AovKind::ObjectId, "id.object", "1 + number of the visible part", {"id.object"}, Uint},
        {AovKind::MaterialId, "id.material", "1 + number of the material", {"id.material"}, Uint},
        {AovKind::InstanceId,
         "id.instance",
         "1 + number of the part that placed it in the scene",
         {"id.instance"},
         Uint},
        {AovKind::ErrorBound,
         "error_bound",
         "bound of the distance between the computed point and the surface",
         {"error_bound"},
         Float},
        {AovKind::Rays, "count.rays", "rays traced for the pixel", {"count.rays"}, Float},
        {AovKind::NodeVisits,
         "count.node_visits",
         "nodes entered by the pixel's rays",
         {"count.node_visits"},
         Float},
        {AovKind::BoxTests,
         "count.box_tests",
         "bounds tested by the pixel's rays, one for each child of a wide node",
         {"count.box_tests"},
         Float},
        {AovKind::PrimitiveTests,
         "count.primitive_tests",
         "primitives tested by the pixel's rays",
         {"count.primitive_tests"},
         Float},
        {AovKind::Time, "time", "wall time of the pixel, seconds", {"time.seconds"}, Float},
        {AovKind::Unmet,
         "unmet",
         "objects that --antialias searched for and no ray hit",
         {"unmet"},
         Uint},
        {AovKind::RefractionError,
         "refraction_error",
         "beam_tracing: distance between the point shown behind glass and the exact one",
         {"refraction_error"},
         Float},
        {AovKind::Emission,
         "emission",
         "path_tracing: light without a scattering",
         {"emission.R", "emission.G", "emission.B"},
         Half},
        {AovKind::Direct,
         "direct",
         "path_tracing: light after one scattering",
         {"direct.R", "direct.G", "direct.B"},
         Half},
        {AovKind::Indirect,
         "indirect",
         "path_tracing: light after two or more scatterings",
         {"indirect.R", "indirect.G", "indirect.B"},
         Half},
        {AovKind::Diffuse,
         "diffuse",
         "path_tracing: light whose first scattering is diffuse",
         {"diffuse.R", "diffuse.G", "diffuse.B"},
         Half},
        {AovKind::Specular,
         "specular",
         "path_tracing: light whose first scattering is a glossy or mirror reflection",
         {"specular.R", "specular.G", "specular.B"},
         Half},
        {AovKind::Transmission,
         "transmission",
         "path_tracing: light whose first scattering is a transmission",
         {"transmission.R", "transmission.G", "transmission.B"},
         Half},
        {AovKind::LightVariance,
         "variance",
         "path_tracing: variance of the pixel's mean, from its samples",
         {"variance.R", "variance.G", "variance.B"},
         Float},
        {AovKind::Photons, "photons", "photons per area at the visible point", {"photons"}, Float},
        {AovKind::PolarizationDegree,
         "polarization.degree",
         "path_tracing:polarization=on: degree of polarization",
         {"polarization.degree"},
         Float},
        {AovKind::PolarizationAngle,
         "polarization.angle",
         "path_tracing:polarization=on: angle from the horizontal, radians, counter-clockwise",
         {"polarization.angle"},
         Float},
        {AovKind::Stokes,
         "stokes",
         "path_tracing:polarization=on: Q, U and V of the luminance",
         {"stokes.Q", "stokes.U", "stokes.V"},
         Float},
    };
    return table;
}

AovSet parse_aovs(const std::string& list) {
    AovSet set;
    std::size_t begin = 0;
    while (begin <= list.size()) {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        const std::string name = list.substr(begin, end - begin);
        bool known = false;
        for (const AovEntry& entry : aov_table()) {
            const std::string_view entry_name = entry.name;
            if (name == "all" || name == entry_name ||
                (!name.empty() && entry_name.starts_with(name + "."))) {
                set.add(entry.kind);
                known = true;
            }
        }
        if (!known) {
            std::string names = "all";
            for (const AovEntry& entry : aov_table()) names += std::string(", ") + entry.name;
            throw Error(ErrorKind::Usage, "unknown AOV '" + name + "'; known: " + names);
        }
        begin = end + 1;
    }
    return set;
}

AovFilm::AovFilm(const AovSet& wanted, const PixelBox& crop) : wanted_(wanted), layers_(crop) {
    for (const AovEntry& entry : aov_table()) {
        if (!wanted_.has(entry.kind)) continue;
        first_channel_[static_cast<std::size_t>(entry.kind)] = layers_.channels().size();
        for (const char* channel : entry.channels) layers_.add(channel, entry.type);
    }
}

void AovFilm::set(AovKind kind, int x, int y, std::span<const double> values) {
    if (!wanted_.has(kind)) return;
    std::size_t channel = first_channel_[static_cast<std::size_t>(kind)];
    for (const double value : values) layers_.set(channel++, x, y, value);
}

void AovFilm::set_whole(AovKind kind, int x, int y, std::uint64_t value) {
    if (!wanted_.has(kind)) return;
    const std::size_t channel = first_channel_[static_cast<std::size_t>(kind)];
    layers_.set_whole(channel, x, y, static_cast<std::uint32_t>(value));
}

void AovRecorder::begin_pixel() {
    if (job_.aovs == nullptr) return;
    rays_before_ = counters_.total_cast();
    tests_before_ = counters_.tests;
    if (job_.aovs->wanted().has(AovKind::Time)) begin_ = std::chrono::steady_clock::now();
}

void AovRecorder::end_pixel(int i, int j, std::span<const Vec2> places) {
    if (job_.aovs == nullptr) return;
    record_costs(i, j);
    if (job_.aovs->wanted().has_geometry()) record_geometry(i, j, places);
}

void AovRecorder::record_costs(int i, int j) {
    AovFilm& film = *job_.aovs;
    const auto set = [&](AovKind kind, double value) { film.set(kind, i, j, {&value, 1}); };
    if (film.wanted().has(AovKind::Time)) {
        const auto now = std::chrono::steady_clock::now();
        set(AovKind::Time, std::chrono::duration<double>(now - begin_).count());
    }
    const auto grown = [](std::uint64_t now, std::uint64_t before) {
        return static_cast<double>(now - before);
    };
    set(AovKind::Rays, grown(counters_.total_cast(), rays_before_));
    set(AovKind::NodeVisits, grown(counters_.tests.node_visits, tests_before_.node_visits));
    set(AovKind::BoxTests, grown(counters_.tests.box_tests, tests_before_.box_tests));
    set(AovKind::PrimitiveTests,
        grown(counters_.tests.primitive_tests, tests_before_.primitive_tests));
}

void AovRecorder::record_geometry(int i, int j, std::span<const Vec2> places) {
    const DepthScale scale(job_.camera);
    PixelGeometry geometry;
    geometry.samples = static_cast<int>(places.size());
    bool first = true;
    for (const Vec2& p : places) {
        const bool names_ids = std::exchange(first, false);
        const Ray ray = eye_ray(job_.camera, p.x, p.y);
        ++counters_.aov_rays;
        VisibleHit seen;
        if (!first_visible_hit(job_.scene, ray, job_.cone, false, nullptr, seen)) continue;
        if (names_ids) geometry.add_ids(seen.point.surface);
        geometry.add(seen.point, scale);
    }
    write_geometry(*job_.aovs, i, j, geometry);
}

}  // namespace alhazen

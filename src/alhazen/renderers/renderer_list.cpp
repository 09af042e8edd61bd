#include "alhazen/renderers/core/renderer.h"

#include <algorithm>
#include <array>

#include "alhazen/base/error.h"
#include "alhazen/renderers/ambient_occlusion/ambient_occlusion.h"
#include "alhazen/renderers/beam_tracing/beam_tracing.h"
#include "alhazen/renderers/bidirectional/bidirectional.h"
#include "alhazen/renderers/cone_tracing/cone_tracing.h"
#include "alhazen/renderers/distributed/distributed.h"
#include "alhazen/renderers/lane_carpenter/lane_carpenter.h"
#include "alhazen/renderers/light_tracing/light_tracing.h"
#include "alhazen/renderers/path_tracing/path_tracing.h"
#include "alhazen/renderers/photon_mapping/photon_mapping.h"
#include "alhazen/renderers/ray_casting/ray_casting.h"
#include "alhazen/renderers/sppm/sppm.h"
#include "alhazen/renderers/vcm/vcm.h"
#include "alhazen/renderers/whitted/whitted.h"

namespace alhazen {

namespace {

std::unique_ptr<Renderer> make_scan_lines(RendererSettings& settings, bool all_first) {
    static constexpr const char* kCracks[] = {"show", "tighter", "clark"};
    static constexpr const char* kSplits[] = {"one", "both"};
    ScanLineOptions options;
    options.all_first = all_first;
    options.flatness = settings.number("flatness", options.flatness, 1e-3, 100.0);
    options.cracks = static_cast<Cracks>(
        settings.choice("cracks", static_cast<std::size_t>(options.cracks), kCracks));
    options.find_cracks = options.cracks == Cracks::Show;
    options.split = static_cast<SplitRule>(settings.choice("split", 0, kSplits));
    return std::make_unique<LaneCarpenter>(options);
}

std::unique_ptr<Renderer> make_cone_tracing(RendererSettings& settings) {
    static constexpr const char* kCoverage[] = {"formulas", "tables"};
    return std::make_unique<ConeTracing>(
        ConeTracingOptions{.tables = settings.choice("coverage", 0, kCoverage) == 1});
}

OpticsSettings optics_settings(RendererSettings& settings) {
    static constexpr const char* kChoices[] = {"off", "on", "scene"};
    const auto read = [&](const char* name) -> std::optional<bool> {
        const std::size_t chosen = settings.choice(name, 2, kChoices);
        return chosen == 2 ? std::nullopt : std::optional(chosen == 1);
    };
    OpticsSettings optics;
    optics.fresnel = read("fresnel");
    optics.beer = read("beer");
    return optics;
}

PathSettings path_settings(RendererSettings& settings) {
    PathSettings paths;
    paths.depth = settings.whole("depth", paths.depth, 0, PathSettings::kMostDepth);
    paths.roulette = settings.whole("roulette", paths.roulette, 0, PathSettings::kMostDepth);
    return paths;
}

std::unique_ptr<Renderer> make_whitted(RendererSettings& settings) {
    const OpticsSettings optics = optics_settings(settings);
    const int waves = settings.whole("dispersion", 0, 0, WaveSplit::kMost);
    if (waves > 0 && waves < WaveSplit::kFewest) {
        throw Error(ErrorKind::Usage, "renderer 'whitted': dispersion=" + std::to_string(waves) +
                                          ", expected 0 (none) or 3 to 64 wavelengths");
    }
    return std::make_unique<Whitted>(optics, waves);
}

std::unique_ptr<Renderer> make_ambient_occlusion(RendererSettings& settings) {
    static constexpr const char* kColors[] = {"white", "albedo"};
    OcclusionSettings occlusion;
    occlusion.distance = settings.number("distance", 0.0, 0.0, 1e300);
    occlusion.albedo = settings.choice("color", 0, kColors) == 1;
    return std::make_unique<AmbientOcclusion>(occlusion);
}

std::unique_ptr<Renderer> make_path_tracing(RendererSettings& settings) {
    PathSettings paths = path_settings(settings);
    paths.clamp = settings.number("clamp", paths.clamp, 0.0, 1e30);
    static constexpr const char* kOffOn[] = {"off", "on"};
    paths.manifold = settings.choice("manifold", 0, kOffOn) == 1;
    paths.polarization = settings.choice("polarization", 0, kOffOn) == 1;
    if (paths.manifold && paths.polarization) {
        throw Error(ErrorKind::Usage,
                    "renderer 'path_tracing': polarization=on and manifold=on exclude each other: "
                    "chains of mirrors and glass carry no polarisation");
    }
    return std::make_unique<PathTracing>(paths);
}

std::uint64_t photon_count(RendererSettings& settings, const char* name, std::uint64_t fallback,
                           double least) {
    constexpr double kMost = 1e9;
    return static_cast<std::uint64_t>(
        settings.number(name, static_cast<double>(fallback), least, kMost));
}

/// Of an eye that looks at photons.
PathSettings photon_paths(RendererSettings& settings) {
    PathSettings paths = path_settings(settings);
    paths.split = settings.number("split", paths.split, 1e-4, 1.0);
    static constexpr const char* kTurns[] = {"1", "2", "4", "8", "16"};
    paths.turns = 1u << settings.choice("turns", 4, kTurns);
    paths.clamp = settings.number("clamp", paths.clamp, 0.0, 1e30);
    constexpr int kMostShadows = 64;
    paths.shadows = static_cast<std::uint32_t>(settings.whole("shadows", 1, 1, kMostShadows));
    return paths;
}

std::unique_ptr<Renderer> make_photon_mapping(RendererSettings& settings) {
    PhotonMappingSettings photons;
    photons.photons = photon_count(settings, "photons", photons.photons, 1.0);
    photons.caustics = photon_count(settings, "caustics", photons.caustics, 0.0);
    photons.nearest = settings.whole("nearest", photons.nearest, 2, 1 << 20);
    photons.radius = settings.number("radius", photons.radius, 0.0, 1e30);
    photons.filter = static_cast<DensityFilter>(
        settings.choice("filter", static_cast<std::size_t>(photons.filter), kDensityFilterNames));
    photons.gather = settings.whole("gather", photons.gather, 0, 1 << 16);
    photons.cache = settings.number("cache", photons.cache, 0.0, 10.0);
    photons.memory = settings.number("memory", photons.memory, 1.0, 1e6);
    static constexpr const char* kProjection[] = {"off", "on"};
    photons.projection = settings.choice("projection", 1, kProjection) == 1;
    photons.paths = photon_paths(settings);
    static constexpr const char* kIrradiance[] = {"off", "on"};
    photons.irradiance = settings.choice("irradiance", 0, kIrradiance) == 1;
    constexpr int kLeastNearest = 4;  // of which the photon itself and the farthest do not count
    if (photons.irradiance && photons.nearest < kLeastNearest) {
        throw Error(ErrorKind::Usage,
                    "renderer 'photon_mapping': nearest=" + std::to_string(photons.nearest) +
                        ", expected 4 or more with irradiance=on");
    }
    static constexpr const char* kEvery[] = {"1", "2", "4", "8"};
    photons.paths.every = 1u << settings.choice("every", 0, kEvery);
    return std::make_unique<PhotonMapping>(photons);
}

std::unique_ptr<Renderer> make_sppm(RendererSettings& settings) {
    SppmSettings sppm;
    sppm.photons = photon_count(settings, "photons", sppm.photons, 1.0);
    sppm.radius = settings.number("radius", sppm.radius, 0.0, 1e30);
    sppm.alpha = settings.number("alpha", sppm.alpha, 0.01, 1.0);
    sppm.memory = settings.number("memory", sppm.memory, 1.0, 1e6);
    sppm.paths = photon_paths(settings);
    return std::make_unique<Sppm>(sppm);
}

std::unique_ptr<Renderer> make_vcm(RendererSettings& settings) {
    static constexpr const char* kMerge[] = {"off", "on"};
    VcmSettings vcm;
    vcm.merge = settings.choice("merge", 1, kMerge) == 1;
    vcm.pilot = static_cast<Pilot>(
        settings.choice("pilot", static_cast<std::size_t>(vcm.pilot), kPilotNames));
    vcm.photons = photon_count(settings, "photons", vcm.photons, 1.0);
    vcm.radius = settings.number("radius", vcm.radius, 0.0, 1e30);
    vcm.alpha = settings.number("alpha", vcm.alpha, 0.01, 1.0);
    vcm.memory = settings.number("memory", vcm.memory, 1.0, 1e6);
    vcm.paths = path_settings(settings);
    return std::make_unique<Vcm>(vcm);
}

std::unique_ptr<Renderer> make_beam_tracing(RendererSettings& settings) {
    static constexpr const char* kSort[] = {"tree", "list"};
    static constexpr const char* kHulls[] = {"off", "on"};
    BeamTreeOptions options;
    options.cast.tree = settings.choice("sort", 0, kSort) == 0;
    options.cast.hulls = settings.choice("hulls", 1, kHulls) == 1;
    options.least_contribution = settings.number("contribution", 0.0, 0.0, 1.0);
    options.least_area = settings.number("area", 0.0, 0.0, 1.0);
    return std::make_unique<BeamTracing>(options, settings.number("tolerance", 0.0, 0.0, 1e30));
}

}  // namespace

std::span<const RendererEntry> renderers() {
    static constexpr std::array<RendererEntry, 14> table{{
        {"whitted",
         "recursive ray tracing: shadows, reflection, refraction (Whitted 1980); "
         "fresnel=on|off|scene, beer=on|off|scene (exact optics), dispersion=N (wavelengths "
         "per refracted ray, Thomas 1986)",
         [](RendererSettings& settings) { return make_whitted(settings); }},
        {"distributed",
         "distribution ray tracing: lenses, motion, area lights and rough reflections (Cook, "
         "Porter and Carpenter 1984); fresnel=on|off|scene, beer=on|off|scene",
         [](RendererSettings& settings) {
             return std::unique_ptr<Renderer>(
                 std::make_unique<Distributed>(optics_settings(settings)));
         }},
        {"light_tracing",
         "all light by random paths from the lights, joined to the lens at each surface (Arvo "
         "1986); depth=N, roulette=N",
         [](RendererSettings& settings) {
             return std::unique_ptr<Renderer>(
                 std::make_unique<LightTracing>(path_settings(settings)));
         },
         true},
        {"path_tracing",
         "all light by random paths from the eye, lights sampled at each surface (Kajiya 1986, "
         "Veach 1997); depth=N, roulette=N, clamp=X, manifold=on|off (light by way of mirrors and "
         "glass by walks, Hanika 2015, Zeltner 2020), polarization=on|off (Wilkie and Weidlich "
         "2012)",
         [](RendererSettings& settings) { return make_path_tracing(settings); }, true},
        {"photon_mapping",
         "all light by photons from the lights, kept in maps, and shadow rays (Jensen 1996); "
         "photons=N, caustics=N (that leave the lights), nearest=N, radius=DISTANCE, "
         "filter=disc|cone|gauss, gather=N (rays of the final gathering), cache=ERROR (of an "
         "irradiance cache for them), projection=on|off, split=SHARE, "
         "turns=1|2|4|8|16 (one of so many samples follows a dimmer branch), clamp=X, "
         "shadows=N (shadow rays at each surface), every=1|2|4|8 "
         "(one photon lookup per so many samples), irradiance=on|off (of the global "
         "map at its photons, Christensen 1999), memory=MB, depth=N, roulette=N",
         [](RendererSettings& settings) { return make_photon_mapping(settings); }, true},
        {"sppm",
         "all light by passes of photons with shrinking radii, one for each sample of --spp "
         "(Hachisuka and Jensen 2009); photons=N (of a pass), radius=DISTANCE (of the first), "
         "alpha=X, split=SHARE, turns=N, clamp=X, shadows=N, memory=MB, depth=N, roulette=N",
         [](RendererSettings& settings) { return make_sppm(settings); }, true},
        {"vcm",
         "bidirectional and photons together, weighed by what each finds, in passes, one for each "
         "sample of --spp (Georgiev et al. 2012); merge=on|off, pilot=say|choose|off (a run before "
         "that says whether merging pays), photons=N (of a pass), radius=DISTANCE (of the first), "
         "alpha=X, memory=MB, depth=N, roulette=N",
         [](RendererSettings& settings) { return make_vcm(settings); }, true},
        {"ray_casting", "visible surfaces with local shading, no further rays (Appel 1968)",
         [](RendererSettings&) {
             return std::unique_ptr<Renderer>(std::make_unique<RayCasting>());
         }},
        {"ambient_occlusion",
         "the share of a uniform sky that is visible from each point; distance=D (default: a "
         "quarter of the scene's diagonal), color=white|albedo",
         [](RendererSettings& settings) { return make_ambient_occlusion(settings); }},
        {"beam_tracing",
         "visible, mirrored and shadowed surfaces as exact polygons, found once for all "
         "resolutions "
         "(Heckbert and Hanrahan 1984); sort=tree|list, hulls=on|off, contribution=SHARE, "
         "area=SHARE, tolerance=DISTANCE (triangles in place of exact shapes)",
         [](RendererSettings& settings) { return make_beam_tracing(settings); }},
        {"bidirectional",
         "all light by random paths from the eye and from the lights, each vertex of one joined "
         "to each of the other (Veach 1997); depth=N, roulette=N",
         [](RendererSettings& settings) {
             return std::unique_ptr<Renderer>(
                 std::make_unique<Bidirectional>(path_settings(settings)));
         },
         true},
        {"cone_tracing",
         "a cone a pixel: covered areas in closed form, reflected, refracted and shadow cones "
         "(Amanatides 1984); coverage=formulas|tables",
         [](RendererSettings& settings) { return make_cone_tracing(settings); }},
        {"lane_carpenter",
         "the picture of ray_casting by scan lines, patches split where these meet them (Lane and "
         "Carpenter 1980); flatness=PIXELS, cracks=show|tighter|clark, split=one|both",
         [](RendererSettings& settings) { return make_scan_lines(settings, false); }},
        {"clark",
         "lane_carpenter with all patches split before the first scan line (Clark 1979); its "
         "settings",
         [](RendererSettings& settings) { return make_scan_lines(settings, true); }},
    }};
    return table;
}

std::string with_depth(const std::string& text, int depth) {
    const std::size_t colon = text.find(':');
    const std::string name = text.substr(0, colon), settings = text.substr(name.size());
    const auto follows = [&](const RendererEntry& entry) {
        return entry.name == name && entry.follows_paths;
    };
    if (std::none_of(renderers().begin(), renderers().end(), follows)) return text;
    if (settings.find(":depth=") != std::string::npos ||
        settings.find(",depth=") != std::string::npos) {
        return text;
    }
    return text + (settings.empty() ? ":" : ",") + "depth=" + std::to_string(depth + 1);
}

std::unique_ptr<Renderer> make_renderer(const std::string& text) {
    RendererSettings settings(text);
    std::string known;
    for (const RendererEntry& entry : renderers()) {
        if (settings.name() == entry.name) {
            std::unique_ptr<Renderer> renderer = entry.make(settings);
            settings.finish();
            return renderer;
        }
        known += known.empty() ? "" : ", ";
        known += entry.name;
    }
    throw Error(ErrorKind::Usage, "unknown renderer '" + settings.name() + "'; known: " + known);
}

}  // namespace alhazen

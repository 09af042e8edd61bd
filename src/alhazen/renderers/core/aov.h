#pragma once
/// Arbitrary output variables (AOVs): geometry and cost of each pixel, written as layers of the
/// picture (docs/reference/layers.md).
///
/// Source: the channel names are those of OpenEXR's layer convention and of compositing programs.
/// Differs: the geometry is found by casting the pixel's eye rays again, so that every renderer has
/// the same layers and no count of a renderer changes.
/// Conventions: geometry is the mean over the samples that hit something (N and Ng normalised); ids
/// are those of the first sample. Where nothing is hit, depth is infinite and all else 0. Values
/// depend on the pixel alone, except times.
/// To add one: an entry of AovKind, a line of the table in aov.cpp and its value there.

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "alhazen/imaging/film/film_layers.h"
#include "alhazen/math/vec.h"
#include "alhazen/renderers/core/ray_counters.h"

namespace alhazen {

struct RenderJob;

enum class AovKind {
    Alpha,
    Depth,
    Normal,
    GeometricNormal,
    Position,
    Uv,
    Albedo,
    ObjectId,
    MaterialId,
    InstanceId,
    ErrorBound,
    Rays,
    NodeVisits,
    BoxTests,
    PrimitiveTests,
    Time,
    Unmet,
    RefractionError,
    Emission,
    Direct,
    Indirect,
    Diffuse,
    Specular,
    Transmission,
    LightVariance,
    Photons,
    PolarizationDegree,
    PolarizationAngle,
    Stokes,
};

struct AovEntry {
    AovKind kind;
    const char* name;  ///< as in `--aov`; prefix of the channels
    const char* description;
    std::vector<const char*> channels;
    SampleType type;
};

/// In the order of AovKind.
[[nodiscard]] std::span<const AovEntry> aov_table();

/// A set of layers.
class AovSet {
  public:
    void add(AovKind kind) { bits_ |= bit(kind); }
    [[nodiscard]] bool has(AovKind kind) const { return (bits_ & bit(kind)) != 0; }
    [[nodiscard]] bool empty() const { return bits_ == 0; }
    /// True if a layer needs the hits of the eye rays.
    [[nodiscard]] bool has_geometry() const { return (bits_ & (bit(AovKind::Rays) - 1)) != 0; }
    /// True if a layer needs RenderJob::count_tests.
    [[nodiscard]] bool has_tests() const {
        return has(AovKind::NodeVisits) || has(AovKind::BoxTests) || has(AovKind::PrimitiveTests);
    }
    /// True if a layer needs the cost of each pixel.
    [[nodiscard]] bool has_costs() const {
        return has_tests() || has(AovKind::Rays) || has(AovKind::Time);
    }
    friend bool operator==(const AovSet&, const AovSet&) = default;

  private:
    static constexpr std::uint32_t bit(AovKind kind) {
        return std::uint32_t{1} << static_cast<std::uint32_t>(kind);
    }
    std::uint32_t bits_ = 0;
};

/// Names separated by commas: `all`, a layer, or the part before the dot for all layers that begin
/// with it (`id`, `count`). Throws Error (Usage) listing the names for an unknown one.
[[nodiscard]] AovSet parse_aovs(const std::string& list);

/// The layers of a film while it is rendered.
class AovFilm {
  public:
    AovFilm(const AovSet& wanted, const PixelBox& crop);

    [[nodiscard]] const AovSet& wanted() const { return wanted_; }
    [[nodiscard]] FilmLayers& layers() { return layers_; }
    [[nodiscard]] const FilmLayers& layers() const { return layers_; }

    /// Sets the channels of a layer, one number each; does nothing for an unselected layer.
    void set(AovKind kind, int x, int y, std::span<const double> values);
    void set_whole(AovKind kind, int x, int y, std::uint64_t value);

  private:
    AovSet wanted_;
    FilmLayers layers_;
    std::array<std::size_t, 32> first_channel_{};
};

/// Records the AOVs of pixels: `begin_pixel` before the work of each, `end_pixel` after it. Does
/// nothing when the job has no AovFilm.
class AovRecorder {
  public:
    AovRecorder(const RenderJob& job, RayCounters& counters) : job_(job), counters_(counters) {}

    void begin_pixel();
    /// Pixel (i, j) has been rendered; `places`: film coordinates of its samples.
    void end_pixel(int i, int j, std::span<const Vec2> places);

  private:
    void record_costs(int i, int j);
    void record_geometry(int i, int j, std::span<const Vec2> places);

    const RenderJob& job_;
    RayCounters& counters_;
    std::uint64_t rays_before_ = 0;
    TraversalStats tests_before_;
    std::chrono::steady_clock::time_point begin_;
};

}  // namespace alhazen

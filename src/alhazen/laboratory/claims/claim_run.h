#pragma once
/// The context of an experiment of claims.h: the standard scenes and the list of findings.

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "alhazen/geometry/bounds_source.h"
#include "alhazen/laboratory/claims/claims.h"
#include "alhazen/laboratory/replay.h"
#include "alhazen/laboratory/scene_trial.h"

namespace alhazen {

/// Thrown when a scene or an accelerator that an experiment needs does not exist.
class ClaimUnavailable : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A database of Haines at its published size.
struct SpdScene {
    const char* name;
    std::uint64_t size;
};
/// The databases of the 1987 paper, in its order.
inline constexpr std::array<SpdScene, 7> kSpdScenes{{{"balls", 4},
                                                     {"gears", 4},
                                                     {"mount", 6},
                                                     {"rings", 7},
                                                     {"teapot", 12},
                                                     {"tetra", 6},
                                                     {"tree", 11}}};

/// Trials cached for later experiments.
using TrialCache = std::map<std::string, std::unique_ptr<SceneTrial>>;

class ClaimRun {
  public:
    ClaimRun(ClaimReport& report, const ClaimOptions& options, TrialCache& trials)
        : report_(report), options_(options), trials_(trials) {}

    [[nodiscard]] double time_limit() const { return options_.time_limit; }

    /// The trial of a database, with rays by the published protocol, of which at most `most_rays`
    /// are recorded. Throws ClaimUnavailable without the generator.
    [[nodiscard]] SceneTrial& spd(const SpdScene& scene);
    /// A trial with every ray of the picture, not cached.
    [[nodiscard]] std::unique_ptr<SceneTrial> spd_with_all_rays(const SpdScene& scene) const;
    /// A scene of another generator at a given size.
    [[nodiscard]] SceneDescription generated(const std::string& name, std::uint64_t size) const;
    /// Throws ClaimUnavailable without the accelerator.
    void need_accelerator(const std::string& accelerator) const;

    /// Records a finding that must hold, or one for information.
    void expect(const std::string& what, const std::string& ours, const std::string& reference,
                bool holds);
    void tell(const std::string& what, const std::string& ours, const std::string& reference = "");
    void note(const std::string& text);
    /// Reports the current step as progress; throws Error (Render) when stopped.
    void step(const std::string& what) const;

  private:
    [[nodiscard]] std::unique_ptr<SceneTrial> trial_of(const SpdScene& scene,
                                                       std::size_t most_rays) const;

    ClaimReport& report_;
    const ClaimOptions& options_;
    TrialCache& trials_;
};

/// Boxes of spheres.
class SphereBoxes final : public BoundsSource {
  public:
    SphereBoxes(std::size_t count, std::uint64_t seed);
    [[nodiscard]] std::size_t size() const override { return centers_.size(); }
    [[nodiscard]] Box3 box(std::size_t i) const override {
        const Vec3 r{radius_, radius_, radius_};
        return {centers_[i] - r, centers_[i] + r};
    }

  private:
    std::vector<Vec3> centers_;
    double radius_;
};

/// The exponent of the power of n that best fits the points (n, value).
[[nodiscard]] double log_log_slope(std::span<const double> n, std::span<const double> value);

// ---- Experiments.
void claim_a1(ClaimRun& run);
void claim_a2(ClaimRun& run);
void claim_a3(ClaimRun& run);
void claim_a4(ClaimRun& run);
void claim_a5(ClaimRun& run);
void claim_a6(ClaimRun& run);
void claim_b1(ClaimRun& run);
void claim_b2(ClaimRun& run);
void claim_b3(ClaimRun& run);
void claim_b4(ClaimRun& run);
void claim_b5(ClaimRun& run);
void claim_b6(ClaimRun& run);
void claim_b7(ClaimRun& run);
void claim_b8(ClaimRun& run);
void claim_b9(ClaimRun& run);
void claim_b10(ClaimRun& run);
void claim_b11(ClaimRun& run);
void claim_b12(ClaimRun& run);
void claim_b13(ClaimRun& run);
void claim_b14(ClaimRun& run);
void claim_c1(ClaimRun& run);
void claim_c2(ClaimRun& run);
void claim_c3(ClaimRun& run);
void claim_c4(ClaimRun& run);
void claim_e1(ClaimRun& run);
void claim_e2(ClaimRun& run);
void claim_e3(ClaimRun& run);
void claim_e4(ClaimRun& run);
void claim_f1(ClaimRun& run);
void claim_f2(ClaimRun& run);
void claim_f3(ClaimRun& run);
void claim_f4(ClaimRun& run);
void claim_f5(ClaimRun& run);
void claim_g2(ClaimRun& run);
void claim_g3(ClaimRun& run);
void claim_h1(ClaimRun& run);

/// Counters that claims use.
inline constexpr auto kPrimitiveTests = &TraversalStats::primitive_tests;
inline constexpr auto kBoxTests = &TraversalStats::box_tests;
inline constexpr auto kNodeVisits = &TraversalStats::node_visits;

/// Replay options: one counting pass; three timed passes.
[[nodiscard]] inline ReplayOptions counting(const ClaimRun& run) {
    return {.seconds = run.time_limit(), .repetitions = 0, .in_batches = false};
}
[[nodiscard]] inline ReplayOptions timing(const ClaimRun& run) {
    return {.seconds = run.time_limit(), .repetitions = 3, .in_batches = false};
}

}  // namespace alhazen

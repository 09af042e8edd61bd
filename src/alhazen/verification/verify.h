#pragma once
/// Traces rays with an accelerator, by every call that renderers use, and by brute force. Every
/// disagreement is reported with its ray.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/accel/wide_bvh/build/build_options.h"
#include "alhazen/base/progress.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

struct VerifyOptions {
    std::string accelerator = "wide_bvh";
    BuildOptions build{};
    std::string csg = "event_heap";  ///< evaluator of solids; compared with `roth`
    std::uint64_t rays = 20000;      ///< in total, over all kinds
    std::uint64_t seed = 1;
    std::string camera;
    ProgressSink* progress = nullptr;
    /// Limit of the primitive tests of a query of accelerator `list`; further rays are left out.
    std::uint64_t most_list_tests = 100'000'000;
};

/// The calls that trace a ray. The accelerator chooses the schedule.
enum class QueryPath : std::uint8_t {
    Single,    ///< `closest`, `occluded`, `all_hits`, `shadowed`
    Stream,    ///< batches with Coherence::Any
    Coherent,  ///< batches with Coherence::Coherent
};
inline constexpr std::size_t kQueryPathCount = 3;
inline constexpr std::array<const char*, kQueryPathCount> kQueryPathNames{"single", "stream",
                                                                          "coherent"};

struct QueryPathCounts {
    std::uint64_t rays = 0;           ///< traced, per query
    std::uint64_t disagreements = 0;  ///< number of its queries that disagree
};

/// A ray for which the two results differ. Coordinates are printed with 17 digits and reproduce it
/// exactly.
struct Disagreement {
    /// "random", "lattice", "eye", "aimed", "tile", "converging", "parallel"; "random for shadow"
    /// if parts are masked.
    std::string kind;
    std::string query;  ///< "closest", "occluded", "all_hits", "shadowed", "parity"
    Ray ray;
    std::string found, expected;
    std::string query_path{};  ///< one of kQueryPathNames; empty if no aggregates are compared
};

/// Disagreements of a report at most; the others are counted.
inline constexpr std::size_t kMostReported = 20;

struct VerifyReport {
    std::string accelerator;
    std::uint64_t rays = 0;           ///< traced, per query
    std::uint64_t rays_left_out = 0;  ///< rays not traced because `list` tests every primitive
    /// Shapes and CSG solids that brute force tested only with rays that meet their boxes.
    std::uint64_t believed_boxes = 0;
    std::uint64_t hits = 0;           ///< of the closest-hit query
    std::uint64_t disagreements = 0;  ///< over all query_paths
    std::array<QueryPathCounts, kQueryPathCount> query_paths{};
    std::uint64_t closed_surfaces = 0;   ///< meshes and shapes whose crossings were counted
    std::uint64_t open_meshes = 0;       ///< meshes that bound no volume; not checked
    std::uint64_t shapes_left_out = 0;   ///< shapes whose crossings were not counted
    std::uint64_t parity_lines = 0;      ///< lines through closed surfaces
    std::uint64_t odd_crossings = 0;     ///< of those, lines with an odd number of crossings
    std::vector<Disagreement> reported;  ///< the first ones

    [[nodiscard]] bool holds() const { return disagreements == 0 && odd_crossings == 0; }
};

/// Verifies a description that has passed `validate`. Throws Error.
[[nodiscard]] VerifyReport verify(const SceneDescription& description,
                                  const VerifyOptions& options);

}  // namespace alhazen

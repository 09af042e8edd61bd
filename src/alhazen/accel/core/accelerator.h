#pragma once
/// What every accelerator offers. To add one: CONTRIBUTING.md.
///
/// An accelerator knows bounds and ids, nothing of shapes: the visitor tests the primitives. It may
/// only skip what a ray cannot hit, so every accelerator gives the same hits. Visitor: `double
/// t_max()` is how far the ray still needs to go (it shrinks as hits are found; primitives at
/// exactly t_max must still be visited), `bool visit(std::uint32_t primitive)` tests one primitive
/// and returns true to stop. An accelerator that may visit a primitive more than once for a ray
/// says so: `kVisitsRepeatedly = true`. A visitor may say what its rays ask for (`kAsksFor`).

#include <concepts>
#include <cstddef>
#include <cstdint>

#include "alhazen/accel/core/accelerator_settings.h"
#include "alhazen/accel/core/traversal_stats.h"
#include "alhazen/geometry/bounds_source.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

/// What a ray wants to know: an accelerator that knows may leave out more.
enum class AsksFor {
    AllHits,    ///< every primitive that is hit
    Closest,    ///< the nearest hit
    AnyHit,     ///< whether there is any
    AnyBlocker  ///< whether light is blocked, or else every primitive that is hit
};

/// A visitor to check the concept with.
struct ArchetypeVisitor {
    [[nodiscard]] double t_max() const;
    bool visit(std::uint32_t primitive);
};

template <class A>
concept Accelerator = requires(const A& accelerator, const BoundsSource& source,
                               const typename A::Config& config, const Ray& ray,
                               ArchetypeVisitor& visitor, NoStats stats, SettingsReader& reader) {
    { A::kName } -> std::convertible_to<const char*>;         // as on the command line
    { A::kDescription } -> std::convertible_to<const char*>;  // one line for the user
    /// Reads every setting it has.
    { A::configure(reader) } -> std::same_as<typename A::Config>;
    { A::build(source, config) } -> std::same_as<A>;
    { accelerator.traverse(ray, visitor, stats) } -> std::same_as<void>;
    { accelerator.memory_bytes() } -> std::same_as<std::size_t>;
};

template <class Visitor>
consteval AsksFor asks_for() {
    if constexpr (requires { Visitor::kAsksFor; }) {
        return Visitor::kAsksFor;
    } else {
        return AsksFor::AllHits;
    }
}

template <class A>
consteval bool visits_repeatedly() {
    if constexpr (requires { A::kVisitsRepeatedly; }) {
        return A::kVisitsRepeatedly;
    } else {
        return false;
    }
}

}  // namespace alhazen

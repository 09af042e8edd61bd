#pragma once
/// The interface of all accelerators. To add one: CONTRIBUTING.md.
///
/// An accelerator knows bounds and ids only, no shapes: the visitor tests the primitives. It may
/// only skip primitives that a ray cannot hit, so that every accelerator gives the same hits.
/// Visitor: `double t_max()` is the remaining length of the ray (it shrinks as hits are found;
/// primitives at exactly t_max must still be visited), `bool visit(std::uint32_t primitive)` tests
/// one primitive and returns true to stop. An accelerator that may visit a primitive more than once
/// per ray declares `kVisitsRepeatedly = true`. A visitor may declare the kind of its query
/// (`asks_for()`).

#include <concepts>
#include <cstddef>
#include <cstdint>

#include "alhazen/accel/core/accelerator_settings.h"
#include "alhazen/accel/core/traversal_stats.h"
#include "alhazen/geometry/bounds_source.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

/// The kind of a query: an accelerator may use it to skip more.
enum class AsksFor {
    AllHits,    ///< every primitive that is hit
    Closest,    ///< the nearest hit
    AnyHit,     ///< whether there is a hit
    AnyBlocker  ///< whether light is blocked; else every primitive that is hit
};

/// An archetype of a visitor, to check the concept.
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
    /// Reads all settings.
    { A::configure(reader) } -> std::same_as<typename A::Config>;
    { A::build(source, config) } -> std::same_as<A>;
    { accelerator.traverse(ray, visitor, stats) } -> std::same_as<void>;
    { accelerator.memory_bytes() } -> std::same_as<std::size_t>;
};

template <class Visitor>
[[nodiscard]] constexpr AsksFor asks_for(const Visitor& visitor) {
    if constexpr (requires { visitor.asks_for(); }) {
        return visitor.asks_for();
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

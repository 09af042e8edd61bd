#pragma once
/// The fallback accelerator: traces the rays for which a structure has no lists.
///
/// Conventions: visitors are called through a pointer, so that the traversals are compiled once,
/// not for each structure and query.

#include <utility>
#include <variant>

#include "alhazen/accel/bounds/hierarchy.h"
#include "alhazen/accel/bounds/list.h"
#include "alhazen/accel/cells/kd_tree.h"
#include "alhazen/accel/core/accelerator.h"

namespace alhazen {

/// A visitor of any type.
class AnyVisitor {
  public:
    template <class Visitor>
    explicit AnyVisitor(Visitor& visitor)
        : visitor_(&visitor), t_max_(visitor.t_max()), visit_([](AnyVisitor& to, std::uint32_t i) {
              Visitor& v = *static_cast<Visitor*>(to.visitor_);
              const bool stops = v.visit(i);
              to.t_max_ = v.t_max();
              return stops;
          }) {}

    [[nodiscard]] double t_max() const { return t_max_; }
    bool visit(std::uint32_t primitive) { return visit_(*this, primitive); }

  private:
    void* visitor_;
    double t_max_;  ///< changes with visits only
    bool (*visit_)(AnyVisitor&, std::uint32_t);
};

class FallbackAccelerator {
  public:
    enum class Kind { Hierarchy, KdTree, List };
    [[nodiscard]] static Kind configure(SettingsReader& reader) {
        static constexpr const char* kNames[] = {Hierarchy::kName, KdTree::kName, List::kName};
        return static_cast<Kind>(
            reader.choice("others", "fallback accelerator for other rays", 0, kNames));
    }

    FallbackAccelerator() : accelerator_(List{}) {}
    FallbackAccelerator(const BoundsSource& source, Kind kind) : accelerator_(make(source, kind)) {}

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
        AnyVisitor any(visitor);
        traverse_any(ray, any, stats);
    }
    [[nodiscard]] std::size_t memory_bytes() const {
        return std::visit([](const auto& a) { return a.memory_bytes(); }, accelerator_);
    }

  private:
    using Any = std::variant<Hierarchy, KdTree, List>;
    static Any make(const BoundsSource& source, Kind kind);

    void traverse_any(const Ray& ray, AnyVisitor& visitor, NoStats stats) const;
    void traverse_any(const Ray& ray, AnyVisitor& visitor, CountingStats stats) const;

    Any accelerator_;
};

}  // namespace alhazen

#pragma once
/// The fallback accelerator: traces the rays for which a structure has no lists.

#include <utility>
#include <variant>

#include "alhazen/accel/bounds/hierarchy.h"
#include "alhazen/accel/bounds/list.h"
#include "alhazen/accel/cells/kd_tree.h"
#include "alhazen/accel/core/accelerator.h"

namespace alhazen {

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
        std::visit([&](const auto& a) { a.traverse(ray, visitor, stats); }, accelerator_);
    }
    [[nodiscard]] std::size_t memory_bytes() const {
        return std::visit([](const auto& a) { return a.memory_bytes(); }, accelerator_);
    }

  private:
    using Any = std::variant<Hierarchy, KdTree, List>;
    static Any make(const BoundsSource& source, Kind kind) {
        switch (kind) {
            case Kind::Hierarchy:
                return Hierarchy::build(source, {});
            case Kind::KdTree:
                return KdTree::build(source, {});
            case Kind::List:
                break;
        }
        return List::build(source, {});
    }

    Any accelerator_;
};

}  // namespace alhazen

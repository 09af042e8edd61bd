#include "alhazen/scene_model/part_traversal.h"

#include <variant>

namespace alhazen {

PartNumbers::PartNumbers(const SceneDescription& description)
    : d_(description), uses_(description.objects.size(), 0) {
    std::uint32_t next = 0;
    for (const ObjectDescription& object : d_.objects) {
        first_.push_back(next);
        next += static_cast<std::uint32_t>(object.parts.size());
        for (const Part& part : object.parts) {
            if (const auto* child = std::get_if<ObjectIndex>(&part.what)) {
                ++uses_[static_cast<std::size_t>(*child)];
            }
        }
    }
}

bool PartNumbers::is_dissolved(std::size_t object) const {
    const ObjectDescription& what = d_.objects[object];
    return uses_[object] == 1 && what.combine == Combine::Group && what.accelerator.empty();
}

namespace {

class PartTraversal {
  public:
    PartTraversal(const SceneDescription& description, RayMask rays,
                  const std::function<void(const WorldPart&)>& each,
                  const std::function<void(const ObjectDescription&)>& solid)
        : d_(description), numbers_(description), rays_(rays), each_(each), solid_(solid) {}

    /// `instance`: of the object that is kept around this one; null if none is.
    void visit(std::size_t index, const Affine& world_from_object, RayMask mask,
               const std::uint32_t* instance) const {
        const ObjectDescription& object = d_.objects[index];
        if (object.combine != Combine::Group) return solid_(object);
        std::uint32_t number = numbers_.first_of(index);
        for (const Part& part : object.parts) {
            visit_part(part, number++, world_from_object * part.object_from_part,
                       mask & part.visible_to, instance);
        }
    }

  private:
    void visit_part(const Part& part, std::uint32_t number, const Affine& world_from_part,
                    RayMask mask, const std::uint32_t* instance) const {
        if ((mask & rays_) == 0) return;
        if (const auto* child = std::get_if<ObjectIndex>(&part.what)) {
            const auto index = static_cast<std::size_t>(*child);
            const bool is_kept = instance == nullptr && !numbers_.is_dissolved(index);
            return visit(index, world_from_part, mask, is_kept ? &number : instance);
        }
        each_({part, world_from_part, number, instance != nullptr ? *instance : number, mask});
    }

    const SceneDescription& d_;
    PartNumbers numbers_;
    RayMask rays_;
    const std::function<void(const WorldPart&)>& each_;
    const std::function<void(const ObjectDescription&)>& solid_;
};

}  // namespace

void visit_parts(const SceneDescription& description, RayMask rays,
                 const std::function<void(const WorldPart&)>& each,
                 const std::function<void(const ObjectDescription&)>& solid) {
    PartTraversal(description, rays, each, solid)
        .visit(static_cast<std::size_t>(description.root), Affine{}, kAllRays, nullptr);
}

}  // namespace alhazen

#include "alhazen/session/conversion/placed_surfaces.h"

#include <optional>

#include "alhazen/base/error.h"

namespace alhazen {

namespace {

class SurfaceCollector {
  public:
    SurfaceCollector(const SceneDescription& description, bool (*fits)(const AnyShape&),
                     const std::vector<std::string>& material_names, PlacedCounts& counts)
        : d_(description),
          fits_(fits),
          material_names_(material_names),
          counts_(counts),
          holds_(description.objects.size()) {}

    void add_object(std::size_t object, const Affine& world_from_object) {
        for (const Part& part : d_.objects[object].parts) {
            const Affine placement = world_from_object * part.object_from_part;
            if (const auto* shape = std::get_if<AnyShape>(&part.what)) {
                if (fits_(*shape)) add(part, *shape, placement);
            } else if (const auto* child = std::get_if<ObjectIndex>(&part.what)) {
                const auto index = static_cast<std::size_t>(*child);
                if (holds(index)) add_object(index, placement);
            }
        }
    }
    std::vector<NamedSurface> take() { return std::move(out_); }

  private:
    void add(const Part& part, const AnyShape& shape, const Affine& placement) {
        points_ += control_points_of(shape) + 1;
        if (points_ > kMaxPlacedControlPoints) {
            throw Error(ErrorKind::Resource, "with its instances the scene has more than " +
                                                 std::to_string(kMaxPlacedControlPoints) +
                                                 " control points");
        }
        --counts_.shapes[shape.index()];
        out_.push_back({part.name, &shape, placement,
                        material_names_[static_cast<std::size_t>(part.material)]});
    }
    /// True if an object has such a shape; the nesting of valid scenes is bounded.
    bool holds(std::size_t object) {
        if (!holds_[object]) {
            bool any = false;
            for (const Part& part : d_.objects[object].parts) {
                const auto* shape = std::get_if<AnyShape>(&part.what);
                const auto* child = std::get_if<ObjectIndex>(&part.what);
                any = any || (shape != nullptr && fits_(*shape)) ||
                      (child != nullptr && holds(static_cast<std::size_t>(*child)));
            }
            holds_[object] = any;
        }
        return *holds_[object];
    }

    const SceneDescription& d_;
    bool (*fits_)(const AnyShape&);
    const std::vector<std::string>& material_names_;
    PlacedCounts& counts_;
    std::vector<std::optional<bool>> holds_;
    std::uint64_t points_ = 0;
    std::vector<NamedSurface> out_;
};

}  // namespace

std::vector<NamedSurface> placed_surfaces(const SceneDescription& description,
                                          bool (*fits)(const AnyShape&),
                                          const std::vector<std::string>& material_names,
                                          PlacedCounts& counts) {
    SurfaceCollector collector(description, fits, material_names, counts);
    collector.add_object(static_cast<std::size_t>(description.root), {});
    return collector.take();
}

}  // namespace alhazen

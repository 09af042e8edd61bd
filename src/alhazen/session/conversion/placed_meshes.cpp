#include "alhazen/session/conversion/placed_meshes.h"

#include <limits>
#include <optional>
#include <utility>

#include "alhazen/scene_model/read_pictures.h"

namespace alhazen {

namespace {

void add_saturating(std::uint64_t& sum, std::uint64_t more) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
    sum = more > kMost - sum ? kMost : sum + more;
}

/// Counts each object once, for any number of placements. The nesting of valid scenes is bounded.
class Counter {
  public:
    explicit Counter(const SceneDescription& description)
        : d_(description), counted_(description.objects.size()) {}

    const PlacedCounts& of(std::size_t object) {
        if (!counted_[object]) {
            PlacedCounts sum;
            for (const Part& part : d_.objects[object].parts) add(part, sum);
            counted_[object] = sum;
        }
        return *counted_[object];
    }

  private:
    void add(const Part& part, PlacedCounts& sum) {
        if (const auto* shape = std::get_if<AnyShape>(&part.what)) {
            add_saturating(sum.shapes[shape->index()], 1);
        } else if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
            const std::size_t n = d_.meshes[static_cast<std::size_t>(*mesh)].mesh->triangles.size();
            add_saturating(sum.triangles, n);
            add_saturating(sum.meshes, n > 0 ? 1 : 0);
        } else {
            const PlacedCounts& inner =
                of(static_cast<std::size_t>(std::get<ObjectIndex>(part.what)));
            add_saturating(sum.triangles, inner.triangles);
            add_saturating(sum.meshes, inner.meshes);
            for (std::size_t i = 0; i < sum.shapes.size(); ++i) {
                add_saturating(sum.shapes[i], inner.shapes[i]);
            }
        }
    }

    const SceneDescription& d_;
    std::vector<std::optional<PlacedCounts>> counted_;
};

class Collector {
  public:
    Collector(const SceneDescription& description, const std::vector<std::string>& material_names)
        : d_(description), material_names_(material_names), counter_(description) {}

    void add_object(std::size_t object, const Affine& world_from_object,
                    std::vector<NamedMesh>& out) {
        for (const Part& part : d_.objects[object].parts) {
            const Affine world_from_part = world_from_object * part.object_from_part;
            if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
                add_mesh(part, d_.meshes[static_cast<std::size_t>(*mesh)], world_from_part, out);
            } else if (const auto* child = std::get_if<ObjectIndex>(&part.what)) {
                // Skips objects without meshes.
                const std::size_t index = static_cast<std::size_t>(*child);
                if (counter_.of(index).meshes > 0) add_object(index, world_from_part, out);
            }
        }
    }

  private:
    void add_mesh(const Part& part, const MeshDescription& mesh, const Affine& placement,
                  std::vector<NamedMesh>& out) const {
        if (mesh.mesh->triangles.empty()) return;
        out.push_back({part.name.empty() ? mesh.name : part.name, mesh.mesh.get(), placement,
                       material_names_[static_cast<std::size_t>(part.material)], material_names_,
                       reads_pictures(d_, part.material, *mesh.mesh)});
    }

    const SceneDescription& d_;
    const std::vector<std::string>& material_names_;
    Counter counter_;
};

template <class... S>
constexpr std::array<const char*, sizeof...(S)> names_of(const ShapeTypes<S...>&) {
    return {S::kName...};
}

std::string plural_of(const std::string& kind) {
    if (kind == "algebraic") return "algebraic surfaces";
    if (kind == "polyhedron") return "polyhedra";
    if (kind == "torus") return "tori";
    return kind + (kind.back() == 'x' || kind.back() == 'h' ? "es" : "s");
}

}  // namespace

PlacedCounts count_placed(const SceneDescription& description) {
    return Counter(description).of(static_cast<std::size_t>(description.root));
}

std::string shapes_in_words(const PlacedCounts& counts) {
    constexpr auto kNames = names_of(AnalyticShapes{});
    std::string words;
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        const std::uint64_t n = counts.shapes[i];
        if (n == 0) continue;
        words += (words.empty() ? "" : ", ") + std::to_string(n) + " " +
                 (n > 1 ? plural_of(kNames[i]) : kNames[i]);
    }
    return words;
}

std::vector<NamedMesh> placed_meshes(const SceneDescription& description,
                                     const std::vector<std::string>& material_names) {
    std::vector<NamedMesh> meshes;
    Collector(description, material_names)
        .add_object(static_cast<std::size_t>(description.root), {}, meshes);
    return meshes;
}

}  // namespace alhazen

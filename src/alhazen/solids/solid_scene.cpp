#include "alhazen/solids/solid_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "alhazen/base/control_characters.h"
#include "alhazen/base/error.h"
#include "alhazen/csg/csg_aggregate.h"
#include "alhazen/scene_model/part_traversal.h"
#include "alhazen/shapes/meshes/mesh_edges.h"

namespace alhazen {

namespace {

/// Scenes with more solids are not searched by name, only by number.
constexpr std::uint64_t kMostNamed = 2'000'000;
constexpr std::uint64_t kMostListed = 30;
constexpr std::size_t kMostOpenMeshes = 5;

std::string own_name(const SceneDescription& description, const Part& part) {
    if (!part.name.empty()) return part.name;
    if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
        const std::string& name = description.meshes[static_cast<std::size_t>(*mesh)].name;
        return name.empty() ? "mesh" : name;
    }
    if (const auto* object = std::get_if<ObjectIndex>(&part.what)) {
        const std::string& name = description.objects[static_cast<std::size_t>(*object)].name;
        return name.empty() ? "object" : name;
    }
    return std::visit([](const auto& shape) { return std::string(shape.kName); },
                      std::get<AnyShape>(part.what));
}

/// True if `word` is the name, or a beginning or end of it delimited by slashes.
bool means(const std::string& word, const std::string& name) {
    if (word == name) return true;
    if (word.empty() || word.size() >= name.size()) return false;
    const std::size_t rest = name.size() - word.size();
    return (name.ends_with(word) && name[rest - 1] == '/') ||
           (name.starts_with(word) && name[word.size()] == '/');
}

std::optional<std::uint64_t> number_in(const std::string& word) {
    std::uint64_t number = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, status] = std::from_chars(word.data(), end, number);
    if (status != std::errc{} || stop != end) return std::nullopt;
    return number;
}

/// The densities of the materials that fill a table's volumes.
class Densities {
  public:
    explicit Densities(const std::vector<Material>& materials) : materials_(materials) {}

    void add(MaterialId material) {
        found_.insert(materials_[static_cast<std::size_t>(material)].density);
    }

    void add(const Aggregate& aggregate) {
        if (const auto* csg = dynamic_cast<const CsgAggregate*>(&aggregate)) {
            add(csg->solid(), CsgOperand::node(0));
            return;
        }
        const PrimitiveTable& table = aggregate.primitives();
        std::apply(
            [&](const auto&... column) {
                (std::for_each(column.materials.begin(), column.materials.end(),
                               [&](MaterialId m) { add(m); }),
                 ...);
            },
            table.columns);
        for (const PlacedMesh& mesh : table.meshes) add(mesh.material);
        for (const Instance& instance : table.instances) add(*instance.aggregate);
    }

    [[nodiscard]] std::vector<std::optional<double>> found() const {
        return {found_.begin(), found_.end()};
    }

  private:
    /// A difference consists of its minuend alone.
    void add(const CsgSolid& solid, CsgOperand operand) {
        if (!operand.is_leaf()) {
            const CsgExpression::Node& node = solid.expression().nodes[operand.index()];
            const std::size_t count =
                node.combine == Combine::Difference ? 1 : node.operands.size();
            for (std::size_t i = 0; i < count; ++i) add(solid, node.operands[i]);
            return;
        }
        const PrimitiveTable& table = solid.table();
        const auto id = static_cast<std::uint32_t>(solid.expression().leaves[operand.index()]);
        const std::uint32_t first_instance = table.first(kInstanceKind);
        if (id < first_instance) {
            add(solid.material(operand.index()));
        } else {
            add(*table.instances[id - first_instance].aggregate);
        }
    }

    const std::vector<Material>& materials_;
    std::set<std::optional<double>> found_;
};

}  // namespace

SolidScene::SolidScene(const SceneDescription& description, const Scene& scene)
    : scene_(scene), queries_(scene.aggregate) {
    name_parts(description);
}

void SolidScene::name_parts(const SceneDescription& description) {
    const PartNumbers numbers(description);
    std::size_t parts = 0;
    for (const ObjectDescription& object : description.objects) parts += object.parts.size();
    part_names_.resize(parts);
    // The names of the parts of an object that the compiler dissolves in the one around it begin
    // with its own name. The path to those of other objects names them itself.
    const auto joins = [&](const Part& part, std::size_t child) {
        if (description.objects[child].combine != Combine::Group) {
            return numbers.uses_of(child) == 1;
        }
        return numbers.is_dissolved(child) && !part.motion;
    };
    struct Waiting {
        std::size_t object;
        std::string prefix;
    };
    std::vector<Waiting> waiting{{static_cast<std::size_t>(description.root), ""}};
    for (std::size_t i = 0; i < description.objects.size(); ++i) {
        if (numbers.uses_of(i) > 1 && i != static_cast<std::size_t>(description.root)) {
            waiting.push_back({i, ""});
        }
    }
    while (!waiting.empty()) {
        const Waiting at = std::move(waiting.back());
        waiting.pop_back();
        const ObjectDescription& object = description.objects[at.object];
        for (std::size_t i = 0; i < object.parts.size(); ++i) {
            const Part& part = object.parts[i];
            std::string name = at.prefix + own_name(description, part);
            if (const auto* child = std::get_if<ObjectIndex>(&part.what)) {
                const auto index = static_cast<std::size_t>(*child);
                if (joins(part, index)) {
                    waiting.push_back({index, name + "/"});
                } else if (numbers.uses_of(index) == 1) {
                    waiting.push_back({index, ""});
                }
            }
            part_names_[numbers.first_of(at.object) + i] = std::move(name);
        }
    }
}

std::string SolidScene::name(SolidId solid) const {
    std::string name;
    for (const std::uint32_t part : solids().place(solid).parts) {
        if (!name.empty()) name += '/';
        name += part_names_[part];
    }
    return name.empty() ? "scene" : name;
}

const std::string& SolidScene::material_name(MaterialId material) const {
    return scene_.materials[static_cast<std::size_t>(material)].name;
}

std::vector<SolidId> SolidScene::select(std::span<const std::string> words) const {
    std::set<SolidId> chosen;
    const std::uint64_t count = solids().count();
    if (words.empty()) {
        for (std::uint64_t i = 0; i < count; ++i) chosen.insert(chosen.end(), SolidId{i});
    }
    std::vector<std::string> names;
    for (const std::string& word : words) {
        const auto number = number_in(word);
        if (number && *number < count) {
            chosen.insert(SolidId{*number});
            continue;
        }
        if (names.empty() && count <= kMostNamed) {
            for (std::uint64_t i = 0; i < count; ++i) names.push_back(name(SolidId{i}));
        }
        bool found = false;
        for (std::uint64_t i = 0; i < names.size(); ++i) {
            if (!means(word, names[i])) continue;
            chosen.insert(SolidId{i});
            found = true;
        }
        if (found) continue;
        std::string known;
        for (std::uint64_t i = 0; i < std::min<std::uint64_t>(names.size(), kMostListed); ++i) {
            known += fmt::format("{}{} '{}'", i == 0 ? "" : ", ", i, escape_controls(names[i]));
        }
        throw Error(ErrorKind::Usage,
                    fmt::format("no solid '{}'; the scene has {} of them: {}{}", word, count, known,
                                names.size() > kMostListed ? ", ..." : ""));
    }
    return {chosen.begin(), chosen.end()};
}

std::vector<std::string> SolidScene::open_meshes() const {
    const std::vector<SolidList::OpenMesh>& open = solids().open_meshes();
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < std::min(open.size(), kMostOpenMeshes); ++i) {
        texts.push_back(fmt::format("mesh '{}': {}", escape_controls(part_names_[open[i].part]),
                                    mesh_edges(*open[i].mesh).description()));
    }
    if (open.size() > kMostOpenMeshes) {
        texts.push_back(fmt::format("and {} more open meshes", open.size() - kMostOpenMeshes));
    }
    return texts;
}

std::vector<std::optional<double>> SolidScene::densities(SolidId solid) const {
    const SolidPlace place = solids().place(solid);
    Densities densities(scene_.materials);
    if (place.kind == SolidPlace::Kind::Csg) {
        densities.add(*place.aggregate);
    } else {
        densities.add(place.material);
    }
    return densities.found();
}

}  // namespace alhazen

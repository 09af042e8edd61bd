#include "alhazen/scene_model/validate_solids.h"

#include "alhazen/shapes/meshes/mesh_edges.h"

#include <fmt/format.h>

namespace alhazen {

namespace {

class SolidValidator {
  public:
    SolidValidator(const SceneDescription& description, Diagnostics& diagnostics)
        : d_(description),
          out_(diagnostics),
          is_operand_(description.objects.size(), false),
          mesh_state_(description.meshes.size(), MeshState::Unknown) {}

    void run() {
        mark_operands();
        for (std::size_t i = 0; i < d_.objects.size(); ++i) {
            if (!is_operand_[i]) continue;
            const ObjectDescription& object = d_.objects[i];
            if (object.parts.empty() && (object.combine == Combine::Intersection ||
                                         object.combine == Combine::Difference)) {
                error(object.location,
                      fmt::format(
                          "{} '{}' has no parts; at least one is needed",
                          object.combine == Combine::Difference ? "difference" : "intersection",
                          object.name));
            }
            if (object.combine == Combine::Group && !object.accelerator.empty()) {
                out_.warning(object.location,
                             fmt::format("object '{}' is part of a solid, which its accelerator "
                                         "has no effect on",
                                         object.name));
            }
            for (const Part& part : object.parts) check_part(part);
        }
    }

  private:
    enum class MeshState : std::uint8_t { Unknown, Open, Closed };

    /// Marks the solids and all objects that they use.
    void mark_operands() {
        std::vector<std::size_t> open;
        const auto mark = [&](std::size_t object) {
            if (is_operand_[object]) return;
            is_operand_[object] = true;
            open.push_back(object);
        };
        for (std::size_t i = 0; i < d_.objects.size(); ++i) {
            if (d_.objects[i].combine != Combine::Group) mark(i);
        }
        while (!open.empty()) {
            const std::size_t object = open.back();
            open.pop_back();
            for (const Part& part : d_.objects[object].parts) {
                const auto* child = std::get_if<ObjectIndex>(&part.what);
                if (child == nullptr) continue;
                const auto c = static_cast<std::size_t>(*child);
                if (c < d_.objects.size()) mark(c);
            }
        }
    }

    void check_part(const Part& part) {
        if (part.visible_to != kAllRays) {
            error(part.location,
                  "part of a solid, so it must be visible to all rays; the solid need not be");
        }
        const auto* of_mesh = std::get_if<MeshIndex>(&part.what);
        const bool deforms = of_mesh != nullptr &&
                             static_cast<std::size_t>(*of_mesh) < d_.meshes.size() &&
                             !d_.meshes[static_cast<std::size_t>(*of_mesh)].keys.empty();
        if (part.motion || deforms) {
            error(part.location, "part of a solid, so it cannot move by itself; the solid can");
        }
        if (const auto* shape = std::get_if<AnyShape>(&part.what)) {
            std::visit(
                [&]<class S>(const S& s) {
                    if (s.closed()) return;
                    const char* hint = S::kClosed ? "; it would when it is closed (capped)" : "";
                    if (std::is_same_v<S, PatchMesh>) {
                        hint =
                            "; each boundary curve must belong to an even number of patches "
                            "(alhazen info names those that do not)";
                    }
                    error(part.location,
                          fmt::format("{} bounds no volume, so it cannot be part of a solid{}",
                                      S::kName, hint));
                },
                *shape);
        } else if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
            const auto i = static_cast<std::size_t>(*mesh);
            if (i >= d_.meshes.size() || !d_.meshes[i].mesh || is_closed(i)) return;
            error(
                part.location,
                fmt::format("{} is not closed, so it cannot be part of a solid: each edge must "
                            "belong to an even number of triangles, but {}",
                            in_words(d_.meshes[i]), mesh_edges(*d_.meshes[i].mesh).description()));
        }
    }

    bool is_closed(std::size_t mesh) {
        MeshState& state = mesh_state_[mesh];
        if (state == MeshState::Unknown) {
            const TriangleMesh& m = *d_.meshes[mesh].mesh;
            // Indices out of range are already reported.
            Diagnostics ignored;
            m.validate({}, ignored);
            state = ignored.error_count() > 0 || m.closed() ? MeshState::Closed : MeshState::Open;
        }
        return state == MeshState::Closed;
    }

    void error(const FileLocation& where, std::string message) {
        out_.error(where.file.empty() ? FileLocation{d_.path.string(), 0, 0} : where,
                   std::move(message));
    }

    const SceneDescription& d_;
    Diagnostics& out_;
    std::vector<bool> is_operand_;
    std::vector<MeshState> mesh_state_;
};

}  // namespace

void validate_solids(const SceneDescription& description, Diagnostics& diagnostics) {
    SolidValidator(description, diagnostics).run();
}

std::string in_words(const MeshDescription& mesh) {
    return mesh.name.empty() ? "a mesh without a name" : fmt::format("mesh '{}'", mesh.name);
}

}  // namespace alhazen

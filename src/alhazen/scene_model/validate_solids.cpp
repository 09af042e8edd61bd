#include "alhazen/scene_model/validate_solids.h"

#include <algorithm>
#include <optional>

#include "alhazen/shading/materials/wall_material.h"
#include "alhazen/shapes/meshes/mesh_edges.h"
#include "alhazen/shapes/meshes/mesh_shells.h"

#include <fmt/format.h>

namespace alhazen {

namespace {

class SolidValidator {
  public:
    SolidValidator(const SceneDescription& description, Diagnostics& diagnostics)
        : d_(description),
          out_(diagnostics),
          is_operand_(description.objects.size(), false),
          stands_alone_(description.objects.size(), false),
          mesh_state_(description.meshes.size(), MeshState::Unknown),
          inward_(description.meshes.size()) {}

    void run() {
        mark_operands();
        mark_standing_alone();
        for (std::size_t i = 0; i < d_.objects.size(); ++i) {
            const ObjectDescription& object = d_.objects[i];
            if (stands_alone_[i]) {
                for (const Part& part : object.parts) warn_of_inward(part);
            }
            if (!is_operand_[i]) continue;
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
        for (std::size_t i = 0; i < d_.objects.size(); ++i) {
            if (d_.objects[i].combine != Combine::Group) mark(i, is_operand_, true);
        }
    }
    /// Marks the groups that the scene shows outside of solids.
    void mark_standing_alone() { mark(static_cast<std::size_t>(d_.root), stands_alone_, false); }

    /// Marks an object and all that it uses; solids, and what they use, only with `also_solids`.
    void mark(std::size_t first, std::vector<bool>& marks, bool also_solids) {
        std::vector<std::size_t> open;
        const auto add = [&](std::size_t object) {
            if (object >= d_.objects.size() || marks[object]) return;
            if (!also_solids && d_.objects[object].combine != Combine::Group) return;
            marks[object] = true;
            open.push_back(object);
        };
        add(first);
        while (!open.empty()) {
            const std::size_t object = open.back();
            open.pop_back();
            for (const Part& part : d_.objects[object].parts) {
                const auto* child = std::get_if<ObjectIndex>(&part.what);
                if (child != nullptr) add(static_cast<std::size_t>(*child));
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
            if (d_.meshes[i].of_polygon) {
                return error(part.location,
                             fmt::format("{} bounds no volume, so it cannot be part of a solid",
                                         Polygon::kName));
            }
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

    /// Outside of solids the winding of a mesh decides on which side its material is.
    void warn_of_inward(const Part& part) {
        const auto* of_mesh = std::get_if<MeshIndex>(&part.what);
        if (of_mesh == nullptr) return;
        const auto i = static_cast<std::size_t>(*of_mesh);
        if (i >= d_.meshes.size() || !d_.meshes[i].mesh) return;
        const std::vector<std::uint32_t>& own = d_.meshes[i].mesh->vertex_materials;
        const bool has_volume =
            own.empty()
                ? has_volume_inside(static_cast<std::size_t>(part.material))
                : std::ranges::any_of(own, [&](std::uint32_t id) { return has_volume_inside(id); });
        if (!has_volume || !faces_inward(i)) return;
        out_.warning(place(part.location),
                     fmt::format("{} is closed and faces inward, or a shell of it does, so its "
                                 "transparent material fills the outside of it, not the inside; "
                                 "reverse its faces, or put it into a union",
                                 in_words(d_.meshes[i])));
    }

    [[nodiscard]] bool has_volume_inside(std::size_t material) const {
        return material < d_.materials.size() && has_inside(d_.materials[material].material);
    }

    bool faces_inward(std::size_t mesh) {
        std::optional<bool>& known = inward_[mesh];
        if (!known) {
            const TriangleMesh& m = *d_.meshes[mesh].mesh;
            Diagnostics ignored;
            m.validate({}, ignored);
            known = ignored.error_count() == 0 && has_inward_shell(m);
        }
        return *known;
    }

    [[nodiscard]] FileLocation place(const FileLocation& where) const {
        return where.file.empty() ? FileLocation{d_.path.string(), 0, 0} : where;
    }
    void error(const FileLocation& where, std::string message) {
        out_.error(place(where), std::move(message));
    }

    const SceneDescription& d_;
    Diagnostics& out_;
    std::vector<bool> is_operand_;    ///< [object] a solid, or used by one
    std::vector<bool> stands_alone_;  ///< [object] a group, shown outside of solids
    std::vector<MeshState> mesh_state_;
    std::vector<std::optional<bool>> inward_;  ///< [mesh] has_inward_shell
};

}  // namespace

void validate_solids(const SceneDescription& description, Diagnostics& diagnostics) {
    SolidValidator(description, diagnostics).run();
}

std::string in_words(const MeshDescription& mesh) {
    const char* const kind = mesh.of_polygon ? "polygon" : "mesh";
    return mesh.name.empty() ? fmt::format("a {} without a name", kind)
                             : fmt::format("{} '{}'", kind, mesh.name);
}

}  // namespace alhazen

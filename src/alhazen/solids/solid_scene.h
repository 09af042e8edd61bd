#pragma once
/// The solids of a loaded scene by name.
///
/// Conventions: the name of a solid joins the names of the parts on the path to it with '/',
/// outermost first; a part without a name is called by its type. Names need not be unique; numbers
/// are.
/// Complexity and threads: as SolidQueries; names are created on request.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "alhazen/scene/scene.h"
#include "alhazen/solids/spans.h"

namespace alhazen {

class SolidScene {
  public:
    /// Both must outlive the object.
    SolidScene(const SceneDescription& description, const Scene& scene);

    [[nodiscard]] const SolidQueries& queries() const { return queries_; }
    [[nodiscard]] const SolidList& solids() const { return queries_.solids(); }
    [[nodiscard]] std::string name(SolidId solid) const;
    [[nodiscard]] const std::string& material_name(MaterialId material) const;

    /// The solids that the words select, in ascending order. A word is a number, a whole name, or
    /// the end or beginning of a name delimited by '/'. No words: all solids. Throws Error (Usage)
    /// with a list of names if a word selects none.
    [[nodiscard]] std::vector<SolidId> select(std::span<const std::string> words) const;

    /// Name and open edges of each mesh that bounds no volume, up to a few.
    [[nodiscard]] std::vector<std::string> open_meshes() const;

    /// The densities of the materials that the solid consists of, each once, ascending; nullopt for
    /// materials without one. What a difference subtracts does not count.
    [[nodiscard]] std::vector<std::optional<double>> densities(SolidId solid) const;

  private:
    void name_parts(const SceneDescription& description);

    const Scene& scene_;
    SolidQueries queries_;
    std::vector<std::string> part_names_;  ///< [part] with names of parents that are placed once
};

}  // namespace alhazen

#pragma once
/// The solids of a loaded scene by the names of the file.
///
/// Conventions: a solid's name joins the names of the parts that lead to it with '/', outermost
/// first; a part without a name is called by its type. Names need not be unique; numbers are.
/// Complexity and threads: as SolidQueries; names are made on request.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "alhazen/scene/scene.h"
#include "alhazen/solids/spans.h"

namespace alhazen {

class SolidScene {
  public:
    /// Both must outlive it.
    SolidScene(const SceneDescription& description, const Scene& scene);

    [[nodiscard]] const SolidQueries& queries() const { return queries_; }
    [[nodiscard]] const SolidList& solids() const { return queries_.solids(); }
    [[nodiscard]] std::string name(SolidId solid) const;
    [[nodiscard]] const std::string& material_name(MaterialId material) const;

    /// The solids that the words select, in ascending order. A word is a number, a whole name, or
    /// the end or beginning of a name up to a '/'. No words: all solids. Throws Error (Usage) with
    /// a list of names if a word selects none.
    [[nodiscard]] std::vector<SolidId> select(std::span<const std::string> words) const;

    /// For each mesh that bounds no volume, up to a few: its name, and which of its edges are open.
    [[nodiscard]] std::vector<std::string> open_meshes() const;

    /// The density of the solid's material; for a CSG object that of its leaves, if they share one.
    [[nodiscard]] std::optional<double> density(SolidId solid) const;

  private:
    void name_parts(const SceneDescription& description);

    const Scene& scene_;
    SolidQueries queries_;
    std::vector<std::string> part_names_;  ///< [part number] with those of objects placed once
};

}  // namespace alhazen

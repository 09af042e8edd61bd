#pragma once
/// A BRL-CAD database as read from text: solids and combinations by name.
///
/// Source: BRL-CAD, "MGED User's Manual", and the text output of its program `g2asc`.
/// Differs: attributes for other programs are dropped (materials of the ballistic codes, lines of
/// sight).
/// Conventions: millimetres. Unreadable content is a warning; its solid or combination is kept as
/// BrlcadUnsupported, so that no object silently lacks it.

#include <optional>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

#include "alhazen/base/diagnostics.h"
#include "alhazen/formats/brlcad/brlcad_solid.h"
#include "alhazen/formats/brlcad/brlcad_tree.h"
#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

struct BrlcadCombination {
    bool region = false;  ///< a solid of one material; false: a group of regions or a part of one
    int region_id = 0;
    int air = 0;               ///< nonzero: filled with air, not drawn
    std::optional<Rgb> color;  ///< 0..1
    std::string shader;        ///< with its parameters; empty if there is none
    bool inherit = false;      ///< colour and shader override those of all members
    BrlcadTree tree;
};

struct BrlcadObject {
    std::string name;
    std::variant<BrlcadSolid, BrlcadCombination> what;
    BrlcadPlace place;
};

/// The colour of the regions whose id is in first..last.
struct BrlcadRegionColor {
    int first = 0, last = 0;
    Rgb color;
};

struct BrlcadDatabase {
    std::string file;  ///< name for messages
    std::string title;
    std::vector<BrlcadObject> objects;
    std::unordered_map<std::string, std::size_t> by_name;
    std::vector<BrlcadRegionColor> region_colors;
    std::size_t faults = 0;          ///< number of items that could not be read
    bool reported_rounding = false;  ///< a warning about a rounded matrix was given

    [[nodiscard]] FileLocation at(const BrlcadPlace& place) const {
        return {file, place.line, place.column};
    }
    [[nodiscard]] const BrlcadObject* find(const std::string& name) const {
        const auto found = by_name.find(name);
        return found == by_name.end() ? nullptr : &objects[found->second];
    }
    [[nodiscard]] BrlcadObject* find(const std::string& name) {
        const auto found = by_name.find(name);
        return found == by_name.end() ? nullptr : &objects[found->second];
    }
    /// Adds an object. Warns of members without a transform, once of rounded matrices, and of a
    /// duplicate name, for which the first object is kept.
    void add(BrlcadObject object, Diagnostics& diagnostics);
    /// Warns of unreadable content.
    void fault(const FileLocation& where, const std::string& message, Diagnostics& diagnostics) {
        ++faults;
        diagnostics.warning(where, message);
    }
};

/// Converts components 0..255, clamped, to a colour 0..1.
[[nodiscard]] inline Rgb brlcad_color(double r, double g, double b) {
    const auto part = [](double c) { return (c < 0.0 ? 0.0 : c > 255.0 ? 255.0 : c) / 255.0; };
    return {part(r), part(g), part(b)};
}

}  // namespace alhazen

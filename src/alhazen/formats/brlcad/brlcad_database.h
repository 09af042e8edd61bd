#pragma once
/// A BRL-CAD database as read from text: solids and combinations by name.
///
/// Source: BRL-CAD, "MGED User's Manual", and the text output of its program `g2asc`.
/// Differs: attributes of other programs are dropped (materials of the ballistic codes, lines of
/// sight).
/// Conventions: millimetres.

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
    bool region = false;  ///< one solid of one material; else a group of regions or a part of one
    int region_id = 0;
    int air = 0;               ///< nonzero: filled with air, not drawn
    std::optional<Rgb> color;  ///< 0..1
    std::string shader;        ///< with its parameters; empty: none
    bool inherit = false;      ///< colour and shader override those of all members
    BrlcadTree tree;
};

struct BrlcadObject {
    std::string name;
    std::variant<BrlcadSolid, BrlcadCombination> what;
    BrlcadPlace place;
};

/// Colour of the regions with an id in first..last.
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
    /// Adds an object. Reports a duplicate name as an error and keeps the first object.
    void add(BrlcadObject object, Diagnostics& diagnostics) {
        const auto [entry, fresh] = by_name.try_emplace(object.name, objects.size());
        if (!fresh) {
            diagnostics.error(at(object.place),
                              "'" + object.name + "' is defined again; first in line " +
                                  std::to_string(objects[entry->second].place.line));
            return;
        }
        objects.push_back(std::move(object));
    }
};

/// Converts components 0..255, clamped, to a colour 0..1.
[[nodiscard]] inline Rgb brlcad_color(double r, double g, double b) {
    const auto part = [](double c) { return (c < 0.0 ? 0.0 : c > 255.0 ? 255.0 : c) / 255.0; };
    return {part(r), part(g), part(b)};
}

/// The transform of a 4 x 4 row-major matrix; the last number divides all others. None if the
/// matrix is not affine.
[[nodiscard]] inline std::optional<Affine> brlcad_transform(const std::array<double, 16>& m) {
    if (m[12] != 0.0 || m[13] != 0.0 || m[14] != 0.0 || m[15] == 0.0) return std::nullopt;
    const double s = 1.0 / m[15];
    return Affine{
        {s * Vec3{m[0], m[4], m[8]}, s * Vec3{m[1], m[5], m[9]}, s * Vec3{m[2], m[6], m[10]}},
        s * Vec3{m[3], m[7], m[11]}};
}

}  // namespace alhazen

#include "alhazen/formats/brlcad/brlcad_database.h"

namespace alhazen {

namespace {

void tell_about_matrices(const BrlcadObject& object, BrlcadDatabase& database,
                         Diagnostics& diagnostics) {
    const auto* comb = std::get_if<BrlcadCombination>(&object.what);
    if (comb == nullptr) return;
    for (const BrlcadNode& node : comb->tree.nodes()) {
        if (node.last_row == LastRow::Perspective) {
            database.fault(database.at(node.place),
                           "the matrix of member '" + node.member + "' of '" + object.name +
                               "' is not an affine transform; the member is left out",
                           diagnostics);
        } else if (node.last_row == LastRow::Rounded && !database.reported_rounding) {
            database.reported_rounding = true;
            diagnostics.warning(database.at(node.place),
                                "the last row of the matrix of member '" + node.member +
                                    "' is rounded; it and others are taken as 0 0 0 1 after "
                                    "division by the last number");
        }
    }
}

}  // namespace

void BrlcadDatabase::add(BrlcadObject object, Diagnostics& diagnostics) {
    const auto [entry, fresh] = by_name.try_emplace(object.name, objects.size());
    if (!fresh) {
        fault(at(object.place),
              "'" + object.name + "' is defined again; the object of line " +
                  std::to_string(objects[entry->second].place.line) + " is kept",
              diagnostics);
        return;
    }
    tell_about_matrices(object, *this, diagnostics);
    objects.push_back(std::move(object));
}

}  // namespace alhazen

#pragma once
/// Reader of the text of version 5: Tcl commands that recreate the database.
///
/// Source: BRL-CAD, the text output of its program `g2asc`, and the documentation of the MGED
/// commands put, attr, title, units and color.
/// Differs: Tcl is not evaluated; other commands are rejected.
/// Conventions: a fault within a command is a warning; reading continues after the command, whose
/// object is unsupported. Invalid Tcl is an error.

#include <map>
#include <span>

#include "alhazen/formats/brlcad/brlcad_database.h"
#include "alhazen/formats/brlcad/brlcad_tcl.h"
#include "alhazen/formats/core/importer.h"

namespace alhazen {

class BrlcadV5Reader {
  public:
    BrlcadV5Reader(const ImportSource& source, BrlcadDatabase& database, Diagnostics& diagnostics);
    void read();

    /// True if the text begins like a version 5 file.
    [[nodiscard]] static bool recognise(std::string_view text);

  private:
    void read_command(std::span<const TclWord> words);
    void read_put(std::span<const TclWord> words);
    void read_attributes(std::span<const TclWord> words);
    void read_region_color(std::span<const TclWord> words);
    void read_color_table(const TclWord& table);
    BrlcadCombination read_combination(std::span<const TclWord> words);
    void set_attribute(BrlcadCombination& comb, const TclWord& key, const TclWord& value);

    /// Reads the words of `put` into `object.what`. Throws Error (Scene).
    void read_form(std::span<const TclWord> words, BrlcadObject& object);
    /// Reports an error at its own place, or at `word`.
    void fault(const Error& error, const TclWord& word);
    void fault(const FileLocation& where, const std::string& message);
    [[nodiscard]] FileLocation location(const TclWord& word);

    std::string_view text_;
    const ImportOptions& options_;
    BrlcadDatabase& database_;
    Diagnostics& diagnostics_;
    TextPlaces places_;
    std::uint64_t elements_ = 0;
};

/// Parses the tree of a combination: nested lists of operators, members and matrices. Throws Error
/// (Scene) with a location in `file`.
[[nodiscard]] BrlcadTree read_brlcad_tree(std::string_view text, TextPlaces& places,
                                          const std::string& file);

/// The solid of a list of parameter names and values; BrlcadUnsupported for unsupported types.
/// `max_elements` limits vertices and faces. Throws Error (Scene or Resource).
[[nodiscard]] BrlcadSolid read_brlcad_v5_solid(const TclWord& type,
                                               std::span<const TclWord> parameters,
                                               TextPlaces& places, const std::string& file,
                                               std::uint64_t max_elements);

/// Reads a list, possibly nested, of at most `most` numbers. Throws Error (Scene) for other
/// content.
[[nodiscard]] std::vector<double> tcl_numbers(std::string_view list, std::size_t most);

}  // namespace alhazen

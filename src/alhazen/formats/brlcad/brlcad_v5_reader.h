#pragma once
/// Reads the text of version 5: Tcl commands that would make the database again.
///
/// Source: BRL-CAD, the text that its program `g2asc` writes, and the documentation of the MGED
/// commands put, attr, title, units and color. Differs: Tcl is not evaluated; other commands are
/// refused. Conventions: a fault within a command is an error, and the reader goes on behind it;
/// text that is no Tcl ends the reading.

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

    /// True when the text begins as such a file does.
    [[nodiscard]] static bool recognise(std::string_view text);

  private:
    void read_command(std::span<const TclWord> words);
    void read_put(std::span<const TclWord> words);
    void read_attributes(std::span<const TclWord> words);
    void read_region_color(std::span<const TclWord> words);
    void read_color_table(const TclWord& table);
    BrlcadCombination read_combination(std::span<const TclWord> words);
    void set_attribute(BrlcadCombination& comb, const TclWord& key, const TclWord& value);

    [[nodiscard]] FileLocation location(const TclWord& word);

    std::string_view text_;
    const ImportOptions& options_;
    BrlcadDatabase& database_;
    Diagnostics& diagnostics_;
    TextPlaces places_;
    std::uint64_t elements_ = 0;
};

/// The tree of a combination: nested lists of operators, members and matrices. Throws Error
/// (Scene), located in the file of that name.
[[nodiscard]] BrlcadTree read_brlcad_tree(std::string_view text, TextPlaces& places,
                                          const std::string& file);

/// The solid that a list of parameter names and values describes; one of a type that is not read is
/// BrlcadUnsupported. `max_elements`: vertices and faces. Throws Error (Scene or Resource).
[[nodiscard]] BrlcadSolid read_brlcad_v5_solid(const TclWord& type,
                                               std::span<const TclWord> parameters,
                                               TextPlaces& places, const std::string& file,
                                               std::uint64_t max_elements);

/// Reads the numbers of a list, which may lie in lists within it; nothing but numbers, at most
/// `most` of them. Throws Error (Scene).
[[nodiscard]] std::vector<double> tcl_numbers(std::string_view list, std::size_t most);

}  // namespace alhazen

#pragma once
/// Reader of the text of version 4: one record per line, its kind given by the first letter.
///
/// Source: BRL-CAD, the text output of its program `g2asc` for databases of version 4.
/// Differs: numbers documented as unused may be missing.
/// Conventions: a fault in a record is a warning; reading continues after the record, whose object
/// is unsupported. A file that ends within a record is an error.

#include <cstdint>
#include <span>
#include <string>

#include "alhazen/formats/brlcad/brlcad_database.h"
#include "alhazen/formats/core/importer.h"
#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

class BrlcadV4Reader {
  public:
    BrlcadV4Reader(const ImportSource& source, BrlcadDatabase& database, Diagnostics& diagnostics);
    void read();

    /// True if the text begins like a version 4 file.
    [[nodiscard]] static bool recognise(std::string_view text);

  private:
    void read_record(bool lost);  ///< lost: the previous record could not be read
    void read_ident();
    void read_solid();
    void read_combination();
    void read_member();
    void read_region_color();
    void read_particle();
    void read_planes();
    void read_ars();
    void read_bot();
    void read_polygons();
    void read_unsupported(const char* type);
    void read_string_solid();
    void read_nmg();
    void read_pipe();
    void skip_spline_surface();
    void read_sketch();

    void finish_combination();
    void add_solid(std::string name, BrlcadSolid solid, const BrlcadPlace& place);
    bool read_ars_points(std::size_t count, std::vector<Vec3>& points);
    bool read_bot_faces(bool thick, std::size_t count, TriangleMesh& mesh);
    /// Moves behind the first word of the next line if it is `kind`; otherwise stays.
    bool go_to_next(std::string_view kind);
    /// Counts `count` elements against the limit of the file.
    void check_room(std::int64_t count);

    bool name(std::string& value);
    bool own_name(std::string& value);  ///< the name of the record's object
    bool numbers(std::span<double> values);
    bool integer(std::int64_t& value, std::int64_t least, std::int64_t most);
    /// The integer at the cursor, or `missing` at the end of the line.
    std::int64_t optional_integer(std::int64_t missing);
    [[nodiscard]] BrlcadPlace place() const;
    bool fail(const std::string& message);
    /// Adds an unsupported object of that name if there is none.
    void keep_unread(const std::string& object_name);

    TextCursor cursor_;
    const ImportOptions& options_;
    BrlcadDatabase& database_;
    Diagnostics& diagnostics_;
    std::uint64_t elements_ = 0;
    BrlcadPlace record_;       ///< start of the current record
    std::string object_name_;  ///< of the current record, if known
    bool record_failed_ = false;
    BrlcadObject combination_;
    BrlcadMemberList members_;
    bool in_combination_ = false;
};

}  // namespace alhazen

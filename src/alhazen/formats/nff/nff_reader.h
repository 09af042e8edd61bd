#pragma once
/// Reads the statements of NFF, and those of its superset AFF that need no animation, into an
/// NffBuilder.
///
/// Source: Haines, the NFF description of the Standard Procedural Databases; Lext, Assarsson and
/// Möller, "A Benchmark for Animated Ray Tracing", IEEE CG&A 21(2), 2001 (AFF).
/// Differs: numbers may span lines; statements may come in any order; # and % start comments.
/// Conventions: an error ends its statement; reading continues at the next known word.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/formats/nff/nff_builder.h"
#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

class NffReader {
  public:
    NffReader(const ImportSource& source, SceneDescription& scene, Diagnostics& diagnostics);

    void read();

  private:
    struct Statement {
        std::string_view name;
        bool (NffReader::*read)();
    };
    static const std::array<Statement, 20> kStatements;

    void read_word();

    bool view();
    bool from();
    bool at();
    bool up();
    bool angle();
    bool hither();
    bool resolution();
    bool background();
    bool light();
    bool animated_light();
    bool ambient();
    bool fill();
    bool fill_of_colors();
    bool cone();
    bool sphere();
    bool polygon();
    bool patch();
    bool textured_triangle();
    bool textured_patch();
    bool animation();

    bool polygon_of(bool with_normals);
    bool triangle_of(int numbers_per_vertex);
    bool vector(Vec3& v);
    bool color(Rgb& c);
    bool numbers(double* values, int count);
    bool at_number();
    void error(const FileLocation& where, const std::string& message);
    /// Warns, once for each statement, if the current one was `given` before.
    void warn_of_two(bool given);
    /// Warns at the first occurrence of `what`.
    void warn_once(const std::string& what, const std::string& message);

    TextCursor cursor_;
    std::string file_;
    SceneDescription& scene_;
    Diagnostics& diagnostics_;
    NffBuilder builder_;
    NffView view_;
    FileLocation statement_;  ///< of the current statement
    std::string statement_name_;
    std::vector<std::string> warned_;
    int errors_ = 0;
    int views_ = 0;  ///< number of `v` read
    bool refused_block_ = false;
    bool recovering_ = false;  ///< after an error, until the next known word
};

}  // namespace alhazen

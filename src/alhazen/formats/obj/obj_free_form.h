#pragma once
/// The free-form statements of an OBJ file: vp, cstype, deg, surf, curv2, parm, trim, hole, end.
///
/// Source: "Object Files (.obj)", Advanced Visualizer manual, appendix B1, Wavefront, 1992.
/// Differs: curv, scrv and sp define no surface: they are skipped with a warning, as are surfaces
/// of the bases bmatrix and taylor.
/// Conventions: indices count from 0 and may refer forward; they are checked when shapes are made
/// (obj_surfaces.h). Lists of all elements are stored one after the other in common arrays.
/// Complexity: linear; about 130 bytes per element besides its lists.

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/formats/text/text_cursor.h"
#include "alhazen/math/vec.h"

namespace alhazen {

enum class ObjBasis : std::uint8_t { Bezier, BSpline, Cardinal, Skipped };

struct ObjSlice {
    std::uint32_t begin = 0, end = 0;
    [[nodiscard]] std::uint32_t size() const { return end - begin; }
};

/// A surf or curv2 with the statements up to its end.
struct ObjElement {
    ObjBasis basis = ObjBasis::Bezier;
    bool rational = false, surface = false;
    std::int64_t degree_u = 0, degree_v = 0;
    std::array<double, 4> range{};  ///< of surf: u0, u1, v0, v1
    ObjSlice points;                ///< in ObjFreeForm::points
    ObjSlice knots_u, knots_v;      ///< in ObjFreeForm::knots; of a Bezier element: break points
    ObjSlice trims;                 ///< in ObjFreeForm::trims
    std::uint32_t name = 0, material = 0;
    int line = 0, column = 0;
};

/// A piece of a loop: a part of a curv2.
struct ObjTrim {
    std::int32_t curve = 0;
    bool hole = false;
    bool first = false;  ///< true for the first piece of its loop
    double from = 0, to = 1;
};

struct ObjFreeForm {
    std::vector<Vec3> parameters;  ///< vp: u, v, weight
    std::vector<std::int32_t> points;
    std::vector<double> knots;
    std::vector<ObjTrim> trims;
    std::vector<ObjElement> surfaces, curves;
};

/// The position of a free-form statement in the file.
struct ObjContext {
    std::size_t positions = 0;  ///< number of v so far
    std::uint32_t name = 0, material = 0;
};

class ObjFreeFormReader {
  public:
    using Report = std::function<void(const TextCursor&, const std::string&)>;

    ObjFreeFormReader(ObjFreeForm& out, Report error, Report warning)
        : out_(out), error_(std::move(error)), warning_(std::move(warning)) {}

    /// Reads the arguments after `keyword`, which begins at `start`. False for other statements.
    bool read(std::string_view keyword, const TextCursor& start, TextCursor& cursor,
              const ObjContext& context);
    /// To be called at the end of the file. Reports an element without end.
    void finish(const TextCursor& end);

  private:
    enum class Open : std::uint8_t { None, Surface, Curve, Skipped };

    bool read_state(std::string_view keyword, TextCursor& cursor);
    bool read_body(std::string_view keyword, TextCursor& cursor);
    void read_basis(TextCursor& cursor);
    void read_degree(TextCursor& cursor);
    void read_parameter(TextCursor& cursor);
    void begin(Open what, const TextCursor& start, TextCursor& cursor, const ObjContext& context);
    void read_knots(TextCursor& cursor);
    void read_trim(bool hole, TextCursor& cursor);
    void end(const TextCursor& cursor);
    bool number(TextCursor& cursor, double& value, const char* what);
    bool index(TextCursor& cursor, std::size_t count, std::int32_t& value);
    void warn_once(bool& warned, const TextCursor& cursor, const std::string& message);

    ObjFreeForm& out_;
    Report error_, warning_;
    ObjElement state_;  ///< basis and degrees of the next element
    ObjElement element_;
    Open open_ = Open::None;
    bool warned_basis_ = false, warned_curve_ = false, warned_special_ = false;
};

}  // namespace alhazen

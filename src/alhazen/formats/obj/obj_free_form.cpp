#include "alhazen/formats/obj/obj_free_form.h"

#include <algorithm>
#include <climits>

namespace alhazen {

namespace {

bool more_on_line(TextCursor& cursor) {
    return cursor.skip_blanks() && cursor.peek() != '#';
}

std::uint32_t end_of(std::size_t size) {
    return std::uint32_t(std::min<std::size_t>(size, UINT32_MAX));
}

}  // namespace

bool ObjFreeFormReader::read(std::string_view keyword, const TextCursor& start, TextCursor& cursor,
                             const ObjContext& context) {
    if (keyword == "surf") {
        begin(Open::Surface, start, cursor, context);
    } else if (keyword == "curv2") {
        begin(Open::Curve, start, cursor, context);
    } else if (keyword == "curv") {
        warn_once(warned_curve_, start, "curves in space (curv) are skipped");
        open_ = Open::Skipped;
    } else if (keyword == "end") {
        end(start);
    } else {
        return read_state(keyword, cursor) || read_body(keyword, cursor);
    }
    return true;
}

bool ObjFreeFormReader::read_state(std::string_view keyword, TextCursor& cursor) {
    if (keyword == "vp") {
        read_parameter(cursor);
    } else if (keyword == "cstype") {
        read_basis(cursor);
    } else if (keyword == "deg") {
        read_degree(cursor);
    } else {
        // Statements of unsupported bases, and of connectivity and approximation: ignored without a
        // warning.
        static constexpr std::array<std::string_view, 5> kQuiet{"bmat", "step", "con", "ctech",
                                                                "stech"};
        return std::find(kQuiet.begin(), kQuiet.end(), keyword) != kQuiet.end();
    }
    return true;
}

bool ObjFreeFormReader::read_body(std::string_view keyword, TextCursor& cursor) {
    static constexpr std::array<std::string_view, 5> kBody{"parm", "trim", "hole", "scrv", "sp"};
    if (std::find(kBody.begin(), kBody.end(), keyword) == kBody.end()) return false;
    if (open_ == Open::None) {
        error_(cursor, std::string(keyword) + " outside of a surface or curve");
    } else if (keyword == "scrv" || keyword == "sp") {
        warn_once(warned_special_, cursor, "special curves and points (scrv, sp) are skipped");
    } else if (open_ == Open::Skipped) {
        return true;
    } else if (keyword == "parm") {
        read_knots(cursor);
    } else if (open_ == Open::Surface) {
        read_trim(keyword == "hole", cursor);
    }
    return true;
}

void ObjFreeFormReader::read_basis(TextCursor& cursor) {
    std::string_view word;
    if (more_on_line(cursor)) word = cursor.word();
    state_.rational = word == "rat";
    if (state_.rational && more_on_line(cursor)) word = cursor.word();
    if (word == "bezier") {
        state_.basis = ObjBasis::Bezier;
    } else if (word == "bspline") {
        state_.basis = ObjBasis::BSpline;
    } else if (word == "nurbs") {
        state_.basis = ObjBasis::BSpline;
        state_.rational = true;
    } else if (word == "cardinal") {
        state_.basis = ObjBasis::Cardinal;
    } else if (word == "bmatrix" || word == "taylor") {
        state_.basis = ObjBasis::Skipped;
        warn_once(warned_basis_, cursor,
                  "surfaces and curves of the type " + std::string(word) + " are skipped");
    } else {
        error_(cursor, "expected bezier, bspline, cardinal, bmatrix or taylor after cstype");
    }
}

void ObjFreeFormReader::read_degree(TextCursor& cursor) {
    std::int64_t u = 0, v = 0;
    if (!more_on_line(cursor) || !cursor.integer(u)) {
        error_(cursor, "expected a degree, found " + cursor.shown_word());
        return;
    }
    if (more_on_line(cursor) && !cursor.integer(v)) {
        error_(cursor, "expected a degree, found " + cursor.shown_word());
        return;
    }
    state_.degree_u = u;
    state_.degree_v = v;
}

void ObjFreeFormReader::read_parameter(TextCursor& cursor) {
    Vec3 p{0, 0, 1};
    int count = 0;
    for (; more_on_line(cursor); ++count) {
        double value = 0;
        if (!number(cursor, value, "a coordinate")) return;
        if (count < 3) p[count] = value;
    }
    if (count == 0) error_(cursor, "expected a coordinate after vp");
    if (count > 0) out_.parameters.push_back(p);
}

void ObjFreeFormReader::begin(Open what, const TextCursor& start, TextCursor& cursor,
                              const ObjContext& context) {
    if (open_ != Open::None) error_(start, "the element before has no end");
    open_ = what;
    element_ = state_;
    element_.surface = what == Open::Surface;
    element_.name = context.name;
    element_.material = context.material;
    const FileLocation where = start.location({});
    element_.line = where.line;
    element_.column = where.column;
    element_.points.begin = end_of(out_.points.size());
    element_.trims = {end_of(out_.trims.size()), end_of(out_.trims.size())};
    element_.knots_u = element_.knots_v = {};
    bool good = true;
    for (std::size_t k = 0; k < (element_.surface ? 4u : 0u) && good; ++k) {
        good = number(cursor, element_.range[k], "a bound of the parameters");
    }
    const std::size_t count = element_.surface ? context.positions : out_.parameters.size();
    while (good && more_on_line(cursor)) {
        std::int32_t point = 0;
        good = index(cursor, count, point);
        if (good) out_.points.push_back(point);
    }
    element_.points.end = end_of(out_.points.size());
    if (element_.basis == ObjBasis::Skipped || !good) open_ = Open::Skipped;
    if (open_ == Open::Skipped && what == Open::Curve) {
        // The element keeps its number.
        element_.basis = ObjBasis::Skipped;
        open_ = Open::Curve;
    }
}

/// Reads v, v/vt, v//vn or v/vt/vn and returns v only.
bool ObjFreeFormReader::index(TextCursor& cursor, std::size_t count, std::int32_t& value) {
    std::int64_t read = 0;
    const TextCursor start = cursor;
    const bool good =
        cursor.leading_integer(read) && (cursor.at_word_end() || cursor.peek() == '/');
    const std::int64_t resolved = read < 0 ? std::int64_t(count) + read : read - 1;
    if (!good || read == 0 || resolved < 0 || resolved > INT_MAX - 1) {
        error_(start,
               "expected the number of a point from 1, or a negative one that counts back; "
               "found " +
                   start.shown_word());
        return false;
    }
    while (!cursor.at_word_end()) (void)cursor.take(cursor.peek());
    value = std::int32_t(resolved);
    return true;
}

void ObjFreeFormReader::read_knots(TextCursor& cursor) {
    std::string_view side;
    if (more_on_line(cursor)) side = cursor.word();
    if (side != "u" && side != "v") {
        error_(cursor, "expected u or v after parm");
        return;
    }
    ObjSlice knots{end_of(out_.knots.size()), 0};
    while (more_on_line(cursor)) {
        double knot = 0;
        if (!number(cursor, knot, "a parameter")) break;
        if (out_.knots.size() > knots.begin && knot < out_.knots.back()) {
            error_(cursor, "the parameter falls below the one before");
        }
        out_.knots.push_back(knot);
    }
    knots.end = end_of(out_.knots.size());
    (side == "u" ? element_.knots_u : element_.knots_v) = knots;
}

void ObjFreeFormReader::read_trim(bool hole, TextCursor& cursor) {
    bool first = true;
    while (more_on_line(cursor)) {
        ObjTrim trim;
        trim.hole = hole;
        trim.first = std::exchange(first, false);
        if (!number(cursor, trim.from, "the begin of a part of a curve") ||
            !number(cursor, trim.to, "the end of a part of a curve")) {
            return;
        }
        if (!more_on_line(cursor)) {
            error_(cursor, "expected the number of a curve (curv2)");
            return;
        }
        if (!index(cursor, out_.curves.size(), trim.curve)) return;
        out_.trims.push_back(trim);
    }
    if (first) error_(cursor, "expected u0, u1 and the number of a curve (curv2)");
    element_.trims.end = end_of(out_.trims.size());
}

void ObjFreeFormReader::end(const TextCursor& cursor) {
    if (open_ == Open::None) error_(cursor, "end without a surface or curve");
    if (open_ == Open::Surface) out_.surfaces.push_back(element_);
    if (open_ == Open::Curve) out_.curves.push_back(element_);
    open_ = Open::None;
}

void ObjFreeFormReader::finish(const TextCursor& at_end) {
    if (open_ != Open::None) error_(at_end, "the last surface or curve has no end");
}

bool ObjFreeFormReader::number(TextCursor& cursor, double& value, const char* what) {
    if (more_on_line(cursor) && cursor.number(value)) return true;
    error_(cursor, std::string("expected ") + what + ", found " + cursor.shown_word());
    return false;
}

void ObjFreeFormReader::warn_once(bool& warned, const TextCursor& cursor,
                                  const std::string& message) {
    if (!std::exchange(warned, true)) warning_(cursor, message);
}

}  // namespace alhazen

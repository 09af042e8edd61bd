#include "alhazen/importers/obj_statements.h"

#include <algorithm>
#include <array>

#include "alhazen/importers/text_cursor.h"

namespace alhazen {

namespace {

constexpr int kMaxErrors = 50;
constexpr std::int64_t kMaxIndex = 0x7FFFFFFE;

/// Statements that have no part in the geometry.
constexpr std::array<std::string_view, 31> kIgnored{
    "g",        "o",         "s",     "usemtl",   "mtllib", "l",      "p",      "mg",
    "vp",       "t",         "bevel", "c_interp", "lod",    "usemap", "maplib", "shadow_obj",
    "d_interp", "trace_obj", "parm",  "end",      "con",    "cstype", "deg",    "bmat",
    "step",     "hole",      "trim",  "scrv",     "sp",     "stech",  "ctech"};

class StatementReader {
  public:
    StatementReader(std::string_view bytes, const std::string& file, const ImportOptions& options,
                    Diagnostics& diagnostics)
        : cursor_(bytes), file_(file), options_(options), diagnostics_(diagnostics) {}

    ObjStatements read() {
        for (; !cursor_.at_end() && errors_ < kMaxErrors; cursor_.skip_line()) {
            if (!cursor_.skip_blanks() || cursor_.peek() == '#') continue;
            read_statement();
        }
        if (errors_ == kMaxErrors) error("too many errors; the rest of the file is not read");
        return std::move(result_);
    }

  private:
    void read_statement() {
        const TextCursor start = cursor_;
        const std::string_view keyword = cursor_.word();
        if (keyword == "v") {
            read_vector(result_.positions, 3);
        } else if (keyword == "vn") {
            read_vector(result_.normals, 3);
        } else if (keyword == "vt") {
            read_uv();
        } else if (keyword == "f" || keyword == "fo") {
            read_face();
        } else if (std::find(kIgnored.begin(), kIgnored.end(), keyword) == kIgnored.end()) {
            unknown(start);
        }
    }

    void read_vector(std::vector<Vec3>& list, int least) {
        Vec3 v;
        if (!read_numbers(v, least) || !room_in(list.size())) return;
        list.push_back(v);
    }
    void read_uv() {
        Vec3 v;
        if (!read_numbers(v, 1) || !room_in(result_.uvs.size())) return;
        result_.uvs.push_back({v.x, v.y});
    }
    /// Reads at least `least` numbers, keeps the first three, and wants nothing but numbers on the
    /// line.
    bool read_numbers(Vec3& v, int least) {
        int count = 0;
        for (; cursor_.skip_blanks() && cursor_.peek() != '#'; ++count) {
            double value = 0.0;
            if (!cursor_.number(value)) {
                error("expected a number, found " + cursor_.shown_word());
                return false;
            }
            if (count < 3) v[count] = value;
        }
        if (count >= least) return true;
        error("expected " + std::to_string(least) + " numbers, found " + std::to_string(count));
        return false;
    }

    void read_face() {
        const std::size_t begin = result_.corners.size();
        const TextCursor start = cursor_;
        while (cursor_.skip_blanks() && cursor_.peek() != '#') {
            ObjCorner corner;
            if (!room_in(result_.corners.size()) || !read_corner(corner)) {
                result_.corners.resize(begin);
                return;
            }
            result_.corners.push_back(corner);
        }
        if (result_.corners.size() - begin < 3) {
            error("a face needs at least three vertices, found " +
                  std::to_string(result_.corners.size() - begin));
            result_.corners.resize(begin);
            return;
        }
        const std::int64_t line = std::min<std::int64_t>(start.line(), 0xFFFFFFFFll);
        result_.faces.push_back({std::uint32_t(result_.corners.size()), std::uint32_t(line)});
    }
    /// v, v/vt, v//vn or v/vt/vn.
    bool read_corner(ObjCorner& corner) {
        if (!read_index(corner.position, result_.positions.size())) return false;
        if (cursor_.take('/')) {
            const bool has_uv = cursor_.peek() != '/' && !at_word_end();
            if (has_uv && !read_index(corner.uv, result_.uvs.size())) return false;
            if (cursor_.take('/') && !at_word_end() &&
                !read_index(corner.normal, result_.normals.size())) {
                return false;
            }
        }
        if (at_word_end()) return true;
        error("expected a vertex as v, v/vt, v//vn or v/vt/vn, found " + cursor_.shown_word());
        return false;
    }
    bool read_index(std::int32_t& index, std::size_t count) {
        std::int64_t value = 0;
        const TextCursor start = cursor_;
        if (!cursor_.leading_integer(value)) {
            error("expected a vertex as v, v/vt, v//vn or v/vt/vn, found " + cursor_.shown_word());
            return false;
        }
        const std::int64_t resolved = value < 0 ? std::int64_t(count) + value : value - 1;
        if (value == 0 || resolved < 0 || resolved > kMaxIndex) {
            cursor_ = start;
            error("the index " + std::to_string(value) +
                  (value == 0 ? "; indices count from 1" : " is out of range"));
            return false;
        }
        index = std::int32_t(resolved);
        return true;
    }
    [[nodiscard]] bool at_word_end() const {
        return cursor_.at_end() || TextCursor::is_space(cursor_.peek());
    }

    bool room_in(std::size_t count) {
        if (count < options_.max_elements && count < std::size_t(kMaxIndex)) return true;
        throw Error(ErrorKind::Resource,
                    "more than " +
                        std::to_string(std::min<std::uint64_t>(options_.max_elements,
                                                               std::uint64_t(kMaxIndex))) +
                        " elements of a kind",
                    cursor_.location(file_));
    }
    void unknown(const TextCursor& start) {
        if (warned_) return;
        warned_ = true;
        diagnostics_.warning(start.location(file_), "the statement " + start.shown_word() +
                                                        " is not known; it and others are ignored");
    }
    void error(const std::string& message) {
        diagnostics_.error(cursor_.location(file_), message);
        ++errors_;
    }

    TextCursor cursor_;
    const std::string& file_;
    const ImportOptions& options_;
    Diagnostics& diagnostics_;
    ObjStatements result_;
    int errors_ = 0;
    bool warned_ = false;
};

}  // namespace

ObjStatements read_obj_statements(std::string_view bytes, const std::string& file,
                                  const ImportOptions& options, Diagnostics& diagnostics) {
    return StatementReader(bytes, file, options, diagnostics).read();
}

}  // namespace alhazen

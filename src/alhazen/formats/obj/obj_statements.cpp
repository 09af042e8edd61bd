#include "alhazen/formats/obj/obj_statements.h"

#include <algorithm>
#include <array>
#include <span>
#include <unordered_map>
#include <utility>

#include "alhazen/formats/obj/obj_pieces.h"
#include "alhazen/formats/text/text_cursor.h"
#include "alhazen/imaging/image/encoding.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {

namespace {

constexpr int kMaxObjErrors = 50;
constexpr std::int64_t kMaxIndex = 0x7FFFFFFE;
constexpr std::size_t kMaxLibraries = 1000;

/// Statements without effect on the image.
constexpr std::array<std::string_view, 12> kIgnored{
    "l",   "p",      "mg",     "t",          "bevel",    "c_interp",
    "lod", "usemap", "maplib", "shadow_obj", "d_interp", "trace_obj"};

/// Assigns numbers to distinct strings.
class NameTable {
  public:
    explicit NameTable(std::vector<std::string>& names) : names_(names) {
        names_.emplace_back();
        numbers_.emplace("", 0);
    }
    std::uint32_t number_of(const std::string& name) {
        const auto [entry, fresh] = numbers_.try_emplace(name, std::uint32_t(names_.size()));
        if (fresh) names_.push_back(name);
        return entry->second;
    }

  private:
    std::vector<std::string>& names_;
    std::unordered_map<std::string, std::uint32_t> numbers_;
};

class StatementReader {
  public:
    StatementReader(std::string_view bytes, const std::string& file, const ImportOptions& options,
                    Diagnostics& diagnostics)
        : bytes_(bytes),
          cursor_(bytes),
          file_(file),
          options_(options),
          diagnostics_(diagnostics),
          names_(result_.names),
          materials_(result_.materials),
          free_form_(
              result_.free_form, [this](const auto& at, const auto& what) { error(at, what); },
              [this](const auto& at, const auto& what) {
                  diagnostics_.warning(at.location(file_), what);
              }) {}

    ObjStatements read() {
        // Bounds the memory for lines that were read ahead.
        constexpr std::size_t kAtOnce = 128;
        const std::vector<std::string_view> pieces = obj_pieces(bytes_);
        reserve(count_obj_lines(pieces));
        const std::span<const std::string_view> all(pieces);
        for (std::size_t i = 0; i < all.size(); i += kAtOnce) {
            read_pieces(all.subspan(i, std::min(kAtOnce, all.size() - i)));
        }
        free_form_.finish(cursor_);
        if (errors_ == kMaxObjErrors) error("too many errors; the rest of the file is not read");
        if (!known_ && errors_ == 0) {
            diagnostics_.error({file_, 0, 0}, "the file has no OBJ statement");
        }
        finish_colors();
        return std::move(result_);
    }

  private:
    void read_pieces(std::span<const std::string_view> pieces) {
        std::vector<PlainObjLines> plain(pieces.size());
        parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) plain[i] = read_plain_obj_lines(pieces[i]);
        });
        for (std::size_t i = 0; i < pieces.size() && errors_ < kMaxObjErrors; ++i) {
            const std::int64_t line = cursor_.line();
            if (add_plain(plain[i])) {
                cursor_ = TextCursor(pieces[i].substr(pieces[i].size()), line + plain[i].lines);
            } else {
                cursor_ = TextCursor(pieces[i], line);
                read_lines();
            }
            plain[i] = {};
        }
    }
    void read_lines() {
        for (; !cursor_.at_end() && errors_ < kMaxObjErrors; cursor_.skip_line()) {
            if (!cursor_.skip_blanks() || cursor_.peek() == '#') continue;
            read_statement();
        }
    }
    /// False, with nothing added, if the lines are not plain or there is no room for them.
    bool add_plain(const PlainObjLines& lines) {
        const std::uint64_t most = std::min(options_.max_elements, std::uint64_t(kMaxIndex));
        if (lines.lines == 0 || result_.positions.size() + lines.positions.size() > most ||
            result_.corners.size() + lines.corners.size() > most) {
            return false;
        }
        result_.positions.insert(result_.positions.end(), lines.positions.begin(),
                                 lines.positions.end());
        if (!result_.colors.empty()) result_.colors.resize(result_.positions.size());
        if (!lines.face_lines.empty()) begin_run();
        std::size_t end = result_.corners.size();
        result_.corners.append(lines.corners);
        for (const std::int64_t line : lines.face_lines) {
            add_face(end += 3, cursor_.line() + line);
        }
        known_ = known_ || !lines.positions.empty() || !lines.face_lines.empty();
        return true;
    }

    /// Reserves memory: growing arrays would take twice as much. The reservation is bounded by the
    /// bytes that the numbers require.
    void reserve(const ObjLineCounts& lines) {
        const std::size_t most = bytes_.size() / 7 + 1;  // "v 0 0 0"
        result_.positions.reserve(std::min(lines.positions, most));
        result_.uvs.reserve(std::min(lines.uvs, most));
        result_.normals.reserve(std::min(lines.normals, most));
        result_.faces.reserve(std::min(lines.faces, most));
        result_.corners.position.reserve(3 * std::min(lines.faces, most));
        if (lines.uvs != 0) result_.corners.uv.reserve(3 * std::min(lines.faces, most));
        if (lines.normals != 0) result_.corners.normal.reserve(3 * std::min(lines.faces, most));
    }

    void read_statement() {
        const TextCursor start = cursor_;
        const std::string_view keyword = cursor_.word();
        bool known = true;
        if (keyword == "v") {
            read_position();
        } else if (keyword == "vn") {
            read_normal();
        } else if (keyword == "vt") {
            read_uv();
        } else if (keyword == "f" || keyword == "fo") {
            read_face();
        } else if (keyword == "o" || keyword == "g") {
            read_name(keyword == "o");
        } else if (keyword == "s") {
            read_smoothing();
        } else if (keyword == "usemtl") {
            run_.material = materials_.number_of(rest_of_line());
            result_.material_lines.resize(result_.materials.size(), line_of(start));
        } else if (keyword == "mtllib") {
            read_library();
        } else if (keyword == "call") {
            warn_of_call(start);
        } else if (free_form_.read(keyword, start, cursor_,
                                   {result_.positions.size(), run_.name, run_.material})) {
            (void)room_in(result_.free_form.points.size() + result_.free_form.knots.size());
        } else if (std::find(kIgnored.begin(), kIgnored.end(), keyword) == kIgnored.end()) {
            known = false;
            unknown(start);
        }
        known_ = known_ || known;
    }

    void read_position() {
        const int count = read_numbers(3);
        if (count == 0 || !room_in(result_.positions.size())) return;
        result_.positions.push_back({numbers_[0], numbers_[1], numbers_[2]});
        // Four or seven numbers: the fourth is a weight. Six or seven: the last three are a colour.
        if (count == 4 || count == 7) {
            result_.weights.resize(result_.positions.size() - 1, 1.0);
            result_.weights.push_back(numbers_[3]);
        }
        if (count == 5) warn_of_five_numbers();
        if (count < 6) {
            if (!result_.colors.empty()) result_.colors.emplace_back();
            return;
        }
        if (result_.colors.empty()) result_.colors.reserve(result_.positions.capacity());
        result_.colors.resize(result_.positions.size() - 1);
        const double* const c = &numbers_[count == 7 ? 4 : 3];
        result_.colors.push_back({float(c[0]), float(c[1]), float(c[2]), 1});
        brightest_ = std::max({brightest_, c[0], c[1], c[2]});
    }
    void warn_of_five_numbers() {
        if (std::exchange(told_of_five_, true)) return;
        diagnostics_.warning(cursor_.location(file_),
                             "a 'v' of five numbers is neither a point and a weight nor a point "
                             "and a colour: the last two are ignored");
    }
    /// Converts colours from display encoding; range 0..1, or 0..255 if any value is above 1.
    void finish_colors() {
        const double scale = brightest_ > 1.0 ? 1.0 / 255.0 : 1.0;
        for (VertexColor& c : result_.colors) {
            for (float* channel : {&c.r, &c.g, &c.b}) {
                *channel = float(linear_from_srgb(std::max(0.0, double(*channel) * scale)));
            }
        }
    }
    void read_normal() {
        if (read_numbers(3) == 0 || !room_in(result_.normals.size())) return;
        result_.normals.push_back({numbers_[0], numbers_[1], numbers_[2]});
    }
    void read_uv() {
        const int count = read_numbers(1);
        if (count == 0 || !room_in(result_.uvs.size())) return;
        result_.uvs.push_back({numbers_[0], count > 1 ? numbers_[1] : 0.0});
    }
    /// Reads at least `least` numbers and keeps the first seven; other text on the line is an
    /// error. Returns the number of numbers; 0 after an error.
    int read_numbers(int least) {
        int count = 0;
        for (; cursor_.skip_blanks() && cursor_.peek() != '#'; ++count) {
            double value = 0.0;
            if (!cursor_.number(value)) {
                error("expected a number, found " + cursor_.shown_word());
                return 0;
            }
            if (count < 7) numbers_[std::size_t(count)] = value;
        }
        if (count >= least) return count;
        error("expected " + std::to_string(least) + " numbers, found " + std::to_string(count));
        return 0;
    }

    /// Reads the rest of a face of three positive indices of positions, as most are; false, at the
    /// same place, at any other and where there is no room.
    bool read_plain_triangle() {
        ObjCorners& corners = result_.corners;
        if (!corners.uv.empty() || !corners.normal.empty()) return false;
        if (corners.size() + 3 > std::min(options_.max_elements, std::uint64_t(kMaxIndex))) {
            return false;
        }
        TextCursor cursor = cursor_;
        std::array<std::int64_t, 3> indices;
        for (std::int64_t& index : indices) {
            const bool read = cursor.skip_blanks() && cursor.leading_integer(index);
            if (!read || index < 1 || index > kMaxIndex + 1) return false;
            if (!cursor.at_end() && !TextCursor::is_space(cursor.peek())) return false;
        }
        if (cursor.skip_blanks()) return false;
        begin_run();
        for (const std::int64_t index : indices) {
            corners.position.push_back(std::int32_t(index - 1));
        }
        end_face(cursor_);
        cursor_ = cursor;
        return true;
    }
    void read_face() {
        if (read_plain_triangle()) return;
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
        begin_run();
        end_face(start);
    }
    /// Adds the face whose corners were read.
    void end_face(const TextCursor& start) { add_face(result_.corners.size(), start.line()); }
    void add_face(std::size_t end_corner, std::int64_t line) {
        line = std::min<std::int64_t>(line, 0xFFFFFFFFll);
        result_.faces.push_back({std::uint32_t(end_corner), std::uint32_t(line)});
    }
    void begin_run() {
        run_.first_face = std::uint32_t(result_.faces.size());
        if (!result_.runs.empty()) {
            const ObjRun& last = result_.runs.back();
            if (last.name == run_.name && last.material == run_.material &&
                last.smoothing == run_.smoothing) {
                return;
            }
        }
        result_.runs.push_back(run_);
    }
    /// Reads v, v/vt, v//vn or v/vt/vn. A comment may follow without a blank.
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
        return cursor_.at_word_end() || cursor_.peek() == '#';
    }

    /// Reads an object or group name. An object ends the previous group; a group within an object
    /// is named after both.
    void read_name(bool object) {
        std::string name = obj_name_of(rest_of_line());
        if (object) object_ = name;
        if (!object && !object_.empty() && name != object_) {
            name = name.empty() ? object_ : object_ + "/" + name;
        }
        run_.name = names_.number_of(name);
    }
    void read_smoothing() {
        std::int64_t group = 0;
        if (cursor_.skip_blanks() && cursor_.leading_integer(group)) {
            run_.smoothing = std::uint32_t(group);
        } else {
            run_.smoothing = cursor_.word() == "on" ? 1 : 0;
        }
    }
    void read_library() {
        const std::uint32_t line = line_of(cursor_);
        std::string names = rest_of_line();
        if (names.empty()) return;
        if (result_.libraries.size() < kMaxLibraries) {
            result_.libraries.push_back({std::move(names), line});
        } else if (!too_many_libraries_) {
            too_many_libraries_ = true;
            diagnostics_.warning({file_, int(line), 0}, "more than " +
                                                            std::to_string(kMaxLibraries) +
                                                            " mtllib lines; the rest is ignored");
        }
    }
    static std::uint32_t line_of(const TextCursor& at) {
        return std::uint32_t(std::min<std::int64_t>(at.line(), INT_MAX));
    }
    /// Reports the first statement that includes a file.
    void warn_of_call(const TextCursor& start) {
        if (warned_of_call_) return;
        warned_of_call_ = true;
        diagnostics_.warning(start.location(file_),
                             "the file of 'call " + rest_of_line().substr(0, 200) +
                                 "' is not read, nor are those of other 'call' statements");
    }
    /// The rest of the line without surrounding blanks; `#` does not start a comment, since it may
    /// be part of a name.
    std::string rest_of_line() {
        cursor_.skip_blanks();
        std::string_view rest = cursor_.rest_of_line();
        while (!rest.empty() && TextCursor::is_blank(rest.back())) rest.remove_suffix(1);
        return std::string(rest);
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
    void error(const std::string& message) { error(cursor_, message); }
    void error(const TextCursor& at, const std::string& message) {
        diagnostics_.error(at.location(file_), message);
        ++errors_;
    }

    std::string_view bytes_;
    TextCursor cursor_;
    const std::string& file_;
    const ImportOptions& options_;
    Diagnostics& diagnostics_;
    ObjStatements result_;
    NameTable names_, materials_;
    ObjFreeFormReader free_form_;
    ObjRun run_;
    std::string object_;
    std::array<double, 7> numbers_{};
    double brightest_ = 0.0;
    int errors_ = 0;
    bool known_ = false;
    bool warned_ = false;
    bool warned_of_call_ = false;
    bool told_of_five_ = false;
    bool too_many_libraries_ = false;
};

}  // namespace

void ObjCorners::resize(std::size_t size) {
    position.resize(size);
    if (uv.size() > size) uv.resize(size);
    if (normal.size() > size) normal.resize(size);
}

void ObjCorners::append(const std::vector<std::int32_t>& positions) {
    position.insert(position.end(), positions.begin(), positions.end());
    if (!uv.empty()) uv.resize(position.size(), -1);
    if (!normal.empty()) normal.resize(position.size(), -1);
}

void ObjCorners::need_normals() {
    normal.resize(position.size(), -1);
}

std::string obj_name_of(std::string_view text) {
    const auto blank_at = [&](std::size_t at) {
        return at >= text.size() || TextCursor::is_blank(text[at]);
    };
    for (std::size_t at = text.find('#'); at != text.npos; at = text.find('#', at + 1)) {
        if (!blank_at(at - 1) || !blank_at(at + 1)) continue;
        while (at > 0 && blank_at(at - 1)) --at;
        return std::string(text.substr(0, at));
    }
    return std::string(text);
}

ObjStatements read_obj_statements(std::string_view bytes, const std::string& file,
                                  const ImportOptions& options, Diagnostics& diagnostics) {
    return StatementReader(bytes, file, options, diagnostics).read();
}

}  // namespace alhazen

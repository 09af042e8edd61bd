#include "alhazen/formats/obj/obj_pieces.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "alhazen/formats/text/text_cursor.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {

namespace {

constexpr std::size_t kPieceBytes = std::size_t{128} << 10;

/// One past the first end of a line at or behind `from` whose line is not continued.
std::size_t end_of_line(std::string_view text, std::size_t from) {
    for (;;) {
        const std::size_t newline = text.find('\n', from);
        if (newline == std::string_view::npos) return text.size();
        std::size_t last = newline;
        if (last > 0 && text[last - 1] == '\r') --last;
        while (last > 0 && TextCursor::is_blank(text[last - 1])) --last;
        if (last == 0 || text[last - 1] != '\\') return newline + 1;
        from = newline + 1;
    }
}

ObjLineCounts lines_of(std::string_view piece) {
    ObjLineCounts counts;
    const char* at = piece.data();
    const char* const end = at + piece.size();
    while (at != end) {
        if (*at == 'v' && end - at > 1) {
            ++(at[1] == 't' ? counts.uvs : at[1] == 'n' ? counts.normals : counts.positions);
        } else if (*at == 'f') {
            ++counts.faces;
        }
        const void* newline = std::memchr(at, '\n', std::size_t(end - at));
        if (newline == nullptr) break;
        at = static_cast<const char*>(newline) + 1;
    }
    return counts;
}

/// Reads three numbers and the rest of the line; false if there is anything else.
bool read_plain_position(TextCursor& cursor, std::vector<Vec3>& positions) {
    std::array<double, 3> numbers;
    for (double& number : numbers) {
        if (!cursor.skip_blanks() || !cursor.number(number)) return false;
    }
    if (cursor.skip_blanks()) return false;
    positions.push_back({numbers[0], numbers[1], numbers[2]});
    return true;
}

/// Reads three positive indices and the rest of the line; false if there is anything else.
bool read_plain_corners(TextCursor& cursor, std::vector<std::int32_t>& corners) {
    std::array<std::int64_t, 3> indices;
    for (std::int64_t& index : indices) {
        if (!cursor.skip_blanks() || !cursor.leading_integer(index)) return false;
        if (index < 1 || index > INT32_MAX) return false;
        if (!cursor.at_end() && !TextCursor::is_space(cursor.peek())) return false;
    }
    if (cursor.skip_blanks()) return false;
    for (const std::int64_t index : indices) corners.push_back(std::int32_t(index - 1));
    return true;
}

}  // namespace

std::vector<std::string_view> obj_pieces(std::string_view text) {
    std::vector<std::string_view> pieces;
    while (!text.empty()) {
        const std::size_t end =
            text.size() <= kPieceBytes ? text.size() : end_of_line(text, kPieceBytes);
        pieces.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
    return pieces;
}

ObjLineCounts count_obj_lines(const std::vector<std::string_view>& pieces) {
    std::vector<ObjLineCounts> counts(pieces.size());
    parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) counts[i] = lines_of(pieces[i]);
    });
    ObjLineCounts all;
    for (const ObjLineCounts& c : counts) {
        all.positions += c.positions;
        all.uvs += c.uvs;
        all.normals += c.normals;
        all.faces += c.faces;
    }
    return all;
}

PlainObjLines read_plain_obj_lines(std::string_view piece) {
    if (piece.empty() || !TextCursor::is_newline(piece.back())) return {};
    PlainObjLines result;
    TextCursor cursor(piece, 0);
    for (; !cursor.at_end(); cursor.skip_line()) {
        if (!cursor.skip_blanks() || cursor.peek() == '#') continue;
        const std::string_view keyword = cursor.word();
        if (keyword == "v") {
            if (!read_plain_position(cursor, result.positions)) return {};
        } else if (keyword == "f") {
            const std::int64_t line = cursor.line();
            if (!read_plain_corners(cursor, result.corners)) return {};
            result.face_lines.push_back(line);
        } else {
            return {};
        }
    }
    result.lines = cursor.line();
    return result;
}

}  // namespace alhazen

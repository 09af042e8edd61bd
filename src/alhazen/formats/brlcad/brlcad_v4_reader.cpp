#include "alhazen/formats/brlcad/brlcad_v4_reader.h"

#include <array>

#include "alhazen/formats/brlcad/brlcad_v4_solids.h"

namespace alhazen {

namespace {

std::string without_spaces(std::string_view text) {
    while (!text.empty() && TextCursor::is_space(text.back())) text.remove_suffix(1);
    while (!text.empty() && TextCursor::is_space(text.front())) text.remove_prefix(1);
    return std::string(text);
}

BrlcadOperator member_operator(std::string_view letter) {
    if (letter == "u") return BrlcadOperator::Union;
    if (letter == "+") return BrlcadOperator::Intersection;
    if (letter == "-") return BrlcadOperator::Difference;
    return BrlcadOperator::Leaf;
}

}  // namespace

BrlcadV4Reader::BrlcadV4Reader(const ImportSource& source, BrlcadDatabase& database,
                               Diagnostics& diagnostics)
    : cursor_(source.bytes),
      options_(source.options),
      database_(database),
      diagnostics_(diagnostics) {}

bool BrlcadV4Reader::recognise(std::string_view text) {
    TextCursor cursor(text.substr(0, 4096));
    std::int64_t units = 0;
    return cursor.skip_to_word() && cursor.word() == "I" && cursor.skip_blanks() &&
           cursor.integer(units) && cursor.skip_blanks() && cursor.word().starts_with("v");
}

BrlcadPlace BrlcadV4Reader::place() const {
    const FileLocation here = cursor_.location({});
    return {here.line, here.column};
}

bool BrlcadV4Reader::fail(const std::string& message) {
    record_failed_ = true;
    if (cursor_.bytes_left() == 0) {
        diagnostics_.error(database_.at(place()), message);
    } else {
        database_.fault(database_.at(place()), message, diagnostics_);
    }
    return false;
}

void BrlcadV4Reader::keep_unread(const std::string& object_name) {
    if (database_.find(object_name) != nullptr) return;
    add_solid(object_name, {"", BrlcadUnsupported{"could not be read"}}, record_);
}

bool BrlcadV4Reader::name(std::string& value) {
    if (!cursor_.skip_blanks()) return fail("expected a name, found the end of the line");
    value = cursor_.word();
    return true;
}

bool BrlcadV4Reader::own_name(std::string& value) {
    if (!name(value)) return false;
    object_name_ = value;
    return true;
}

bool BrlcadV4Reader::numbers(std::span<double> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!cursor_.skip_blanks() || !cursor_.number(values[i])) {
            return fail("expected " + std::to_string(values.size()) + " numbers, found " +
                        cursor_.shown_word() + " as number " + std::to_string(i + 1));
        }
    }
    return true;
}

bool BrlcadV4Reader::integer(std::int64_t& value, std::int64_t least, std::int64_t most) {
    const bool present = cursor_.skip_blanks();
    TextCursor before = cursor_;
    if (present && cursor_.integer(value) && value >= least && value <= most) return true;
    cursor_ = before;
    return fail("expected a whole number from " + std::to_string(least) + " to " +
                std::to_string(most) + ", found " + cursor_.shown_word());
}

std::int64_t BrlcadV4Reader::optional_integer(std::int64_t missing) {
    std::int64_t value = missing;
    if (cursor_.skip_blanks() && !cursor_.integer(value)) {
        fail("expected a whole number, found " + cursor_.shown_word());
        cursor_.rest_of_line();
    }
    return value;
}

void BrlcadV4Reader::check_room(std::int64_t count) {
    elements_ += static_cast<std::uint64_t>(count);
    if (elements_ > options_.max_elements) {
        throw Error(
            ErrorKind::Resource,
            "more than " + std::to_string(options_.max_elements) + " members, points and faces",
            database_.at(record_));
    }
}

void BrlcadV4Reader::read() {
    while (cursor_.skip_to_word()) {
        record_ = place();
        const bool lost = record_failed_;
        record_failed_ = false;
        object_name_.clear();
        read_record(lost);
        if (record_failed_ && !object_name_.empty()) keep_unread(object_name_);
        cursor_.skip_line();
    }
    finish_combination();
}

void BrlcadV4Reader::read_record(bool lost) {
    const std::string shown = cursor_.shown_word();
    const std::string_view kind = cursor_.word();
    if (kind == "M") return read_member();
    finish_combination();
    if (kind == "I") return read_ident();
    if (kind == "S") return read_solid();
    if (kind == "C") return read_combination();
    if (kind == "m") return read_region_color();
    if (kind == "p") return read_particle();
    if (kind == "n") return read_planes();
    if (kind == "A") return read_ars();
    if (kind == "t") return read_bot();
    if (kind == "P") return read_polygons();
    if (kind == "s") return read_string_solid();
    if (kind == "N") return read_nmg();
    if (kind == "w") return read_pipe();
    if (kind == "b") return read_unsupported("spline");
    if (kind == "D") return skip_spline_surface();
    if (kind == "c") return read_unsupported("cline");
    if (kind == "e") return read_unsupported("extrude");
    if (kind == "d") return read_sketch();
    if (kind.starts_with("#")) return;
    // The rest of an unreadable record is not reported as a second fault.
    record_failed_ = true;
    if (lost) return;
    database_.fault(database_.at(record_),
                    shown +
                        " is not a record type; expected I, S, C, M, A, P, t, p, n, s, N, w, b, "
                        "D, c, e, d or m",
                    diagnostics_);
}

void BrlcadV4Reader::read_ident() {
    std::int64_t units = 0;
    if (!integer(units, 0, 1000)) return;
    std::string version;
    if (!name(version)) return;
    if (version != "v4") {
        diagnostics_.warning(database_.at(record_),
                             "a database of version '" + version + "', read as one of version v4");
    }
    cursor_.skip_line();
    database_.title = without_spaces(cursor_.rest_of_line());
}

void BrlcadV4Reader::read_solid() {
    std::int64_t type = 0, group = 0;
    std::string solid_name;
    std::array<double, 24> values{};
    if (!integer(type, 0, 1'000'000) || !own_name(solid_name) ||
        !integer(group, -32768, 1'000'000) || !numbers(values)) {
        return;
    }
    check_room(1);
    add_solid(std::move(solid_name), brlcad_v4_solid(type, values), record_);
}

void BrlcadV4Reader::read_combination() {
    std::string kind, comb_name;
    if (!name(kind) || !name(comb_name)) return;
    BrlcadCombination comb;
    if (kind == "Y" || kind == "P" || kind == "V") {
        comb.region = true;
    } else if (kind != "N") {
        fail("a combination is Y (a region) or N, not '" + kind + "'");
    }
    const auto small = [](std::int64_t n) {
        return static_cast<int>(n < -2147483647 ? -2147483647 : n > 2147483647 ? 2147483647 : n);
    };
    comb.region_id = small(optional_integer(0));
    comb.air = small(optional_integer(0));
    for (int unused = 0; unused < 4; ++unused) optional_integer(0);
    const bool colored = optional_integer(0) == 1;
    std::array<double, 3> rgb{};
    for (double& c : rgb) c = static_cast<double>(optional_integer(0));
    if (colored) comb.color = brlcad_color(rgb[0], rgb[1], rgb[2]);
    const bool has_shader = optional_integer(0) != 0;
    const bool has_parameters = optional_integer(0) != 0;
    comb.inherit = optional_integer(0) == 1;
    for (const bool present : {has_shader, has_parameters}) {
        if (!present) continue;
        cursor_.skip_line();
        if (!comb.shader.empty()) comb.shader += ' ';
        comb.shader += without_spaces(cursor_.rest_of_line());
    }
    check_room(1);
    combination_ = {std::move(comb_name), std::move(comb), record_};
    in_combination_ = true;
}

void BrlcadV4Reader::finish_combination() {
    if (!in_combination_) return;
    in_combination_ = false;
    auto& comb = std::get<BrlcadCombination>(combination_.what);
    comb.tree.set_root(members_.finish(comb.tree));
    database_.add(std::move(combination_), diagnostics_);
}

void BrlcadV4Reader::read_member() {
    if (!in_combination_) {
        fail("a member (M) without a combination (C) before it");
        return;
    }
    std::string letter, member;
    std::array<double, 16> matrix{};
    BrlcadOperator op = BrlcadOperator::Leaf;
    if (name(letter)) {
        op = member_operator(letter);
        if (op == BrlcadOperator::Leaf) {
            fail("'" + letter + "' is not an operator; expected u, + or -");
        }
    }
    if (op == BrlcadOperator::Leaf || !name(member) || !numbers(matrix)) {
        // A member without a transform: the object that contains it is omitted.
        matrix.fill(0.0);
        if (member.empty()) member = "?";
        op = BrlcadOperator::Union;
    }
    check_room(1);
    BrlcadTree& tree = std::get<BrlcadCombination>(combination_.what).tree;
    const std::uint32_t leaf = tree.add_leaf(std::move(member), matrix, record_);
    members_.add(tree, op, leaf);
}

void BrlcadV4Reader::read_region_color() {
    std::int64_t flags = 0, first = 0, last = 0, r = 0, g = 0, b = 0;
    const std::int64_t most = 2147483647;
    if (!integer(flags, -most, most) || !integer(first, -most, most) ||
        !integer(last, -most, most) || !integer(r, 0, 255) || !integer(g, 0, 255) ||
        !integer(b, 0, 255)) {
        return;
    }
    check_room(1);
    database_.region_colors.push_back(
        {static_cast<int>(first), static_cast<int>(last),
         brlcad_color(static_cast<double>(r), static_cast<double>(g), static_cast<double>(b))});
}

void BrlcadV4Reader::add_solid(std::string solid_name, BrlcadSolid solid,
                               const BrlcadPlace& where) {
    database_.add({std::move(solid_name), std::move(solid), where}, diagnostics_);
}

}  // namespace alhazen

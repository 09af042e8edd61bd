#include "alhazen/formats/brlcad/brlcad_v5_reader.h"

#include <algorithm>
#include <array>

#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

namespace {

/// The integer of a word; none if the word is not an integer.
std::optional<int> whole_number(const TclWord& word) {
    TextCursor cursor(word.text);
    std::int64_t value = 0;
    if (!cursor.skip_to_word() || !cursor.integer(value) || cursor.skip_to_word()) {
        return std::nullopt;
    }
    return static_cast<int>(std::clamp<std::int64_t>(value, -2147483647, 2147483647));
}

bool is_yes(const TclWord& word) {
    return word.text == "yes" || word.text == "1" || word.text == "R" || word.text == "r" ||
           word.text == "true" || word.text == "on";
}

/// Three numbers separated by slashes, commas or blanks.
std::optional<Rgb> color_of(const TclWord& word) {
    std::string text(word.text);
    std::replace(text.begin(), text.end(), '/', ' ');
    std::replace(text.begin(), text.end(), ',', ' ');
    TextCursor cursor(text);
    std::array<double, 3> c{};
    for (double& value : c) {
        if (!cursor.skip_to_word() || !cursor.number(value)) return std::nullopt;
    }
    if (cursor.skip_to_word()) return std::nullopt;
    return brlcad_color(c[0], c[1], c[2]);
}

std::string shown(const TclWord& word) {
    std::string text = tcl_value(word).substr(0, 40);
    if (word.text.size() > 40) text += "...";
    return "'" + text + "'";
}

}  // namespace

BrlcadV5Reader::BrlcadV5Reader(const ImportSource& source, BrlcadDatabase& database,
                               Diagnostics& diagnostics)
    : text_(source.bytes),
      options_(source.options),
      database_(database),
      diagnostics_(diagnostics),
      places_(source.bytes) {}

bool BrlcadV5Reader::recognise(std::string_view text) {
    text = text.substr(0, 65536);
    bool title = false, units = false;
    TextCursor cursor(text);
    for (; cursor.skip_to_word("#"); cursor.skip_line()) {
        const std::string_view command = cursor.word();
        if (command == "put" || command == "attr") return cursor.skip_blanks();
        title |= command == "title";
        units |= command == "units";
    }
    return title && units;
}

FileLocation BrlcadV5Reader::location(const TclWord& word) {
    return database_.at(places_.of(word.text.data()));
}

void BrlcadV5Reader::fault(const Error& error, const TclWord& word) {
    if (error.location().line <= 0) return fault(location(word), error.what());
    // `what` begins with the location.
    std::string message(error.what());
    const std::string place = to_string(error.location()) + ": ";
    if (message.starts_with(place)) message.erase(0, place.size());
    fault(error.location(), message);
}

void BrlcadV5Reader::fault(const FileLocation& where, const std::string& message) {
    database_.fault(where, message, diagnostics_);
}

void BrlcadV5Reader::read() {
    TclCommands commands(text_);
    std::vector<TclWord> words;
    try {
        while (commands.next(words)) {
            try {
                read_command(words);
            } catch (const Error& error) {
                if (error.kind() != ErrorKind::Scene) throw;
                fault(error, words[0]);
            }
        }
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Scene) throw;
        diagnostics_.error(database_.at(places_.of(commands.at())), error.what());
    }
}

void BrlcadV5Reader::read_command(std::span<const TclWord> words) {
    const std::string_view command = words[0].text;
    if (command == "put") return read_put(words);
    if (command == "attr") return read_attributes(words);
    if (command == "color") return read_region_color(words);
    if (command == "title") {
        if (words.size() > 1) database_.title = tcl_value(words[1]);
        return;
    }
    if (command == "units") return;  // only for display in BRL-CAD's programs
    if (command == "dbbinary" || command == "bo") {
        diagnostics_.warning(location(words[0]),
                             "'" + std::string(command) + "' (binary data) is not read");
        return;
    }
    fault(location(words[0]), shown(words[0]) +
                                  " is not a command of a database; expected put, "
                                  "attr, title, units or color");
}

void BrlcadV5Reader::read_put(std::span<const TclWord> words) {
    if (words.size() < 3) {
        fault(location(words[0]), "expected put NAME TYPE PARAMETERS");
        return;
    }
    BrlcadObject object;
    object.name = tcl_value(words[1]);
    object.place = places_.of(words[0].text.data());
    try {
        read_form(words, object);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Scene) throw;
        object.what = BrlcadSolid{std::string(words[2].text.substr(0, 40)),
                                  BrlcadUnsupported{"could not be read"}};
        fault(error, words[0]);
    }
    if (++elements_ > options_.max_elements) {
        throw Error(ErrorKind::Resource,
                    "more than " + std::to_string(options_.max_elements) + " objects and points",
                    database_.at(object.place));
    }
    database_.add(std::move(object), diagnostics_);
}

void BrlcadV5Reader::read_form(std::span<const TclWord> words, BrlcadObject& object) {
    if (words[2].text == "comb") {
        object.what = read_combination(words.subspan(3));
        return;
    }
    const std::uint64_t room = options_.max_elements - std::min(elements_, options_.max_elements);
    BrlcadSolid solid =
        read_brlcad_v5_solid(words[2], words.subspan(3), places_, database_.file, room);
    if (const auto* mesh = std::get_if<BrlcadMesh>(&solid.form)) {
        elements_ += mesh->mesh->positions.size() + mesh->mesh->triangles.size();
    }
    object.what = std::move(solid);
}

BrlcadCombination BrlcadV5Reader::read_combination(std::span<const TclWord> words) {
    BrlcadCombination comb;
    for (std::size_t i = 0; i < words.size(); i += 2) {
        if (i + 1 == words.size()) {
            fault(location(words[i]), "expected a value of " + shown(words[i]));
            break;
        }
        if (words[i].text == "tree") {
            comb.tree = read_brlcad_tree(words[i + 1].text, places_, database_.file);
            elements_ += comb.tree.nodes().size();
        } else {
            set_attribute(comb, words[i], words[i + 1]);
        }
    }
    return comb;
}

void BrlcadV5Reader::set_attribute(BrlcadCombination& comb, const TclWord& key,
                                   const TclWord& value) {
    const std::string_view name = key.text;
    const auto wrong = [&](const char* expected) {
        fault(location(value),
              "'" + std::string(name) + "': expected " + expected + ", found " + shown(value));
    };
    if (name == "region") {
        comb.region = is_yes(value);
    } else if (name == "region_id" || name == "id") {
        const std::optional<int> id = whole_number(value);
        if (!id) return wrong("a whole number");
        comb.region_id = *id;
    } else if (name == "air" || name == "aircode") {
        const std::optional<int> air = whole_number(value);
        if (!air) return wrong("a whole number");
        comb.air = *air;
    } else if (name == "rgb" || name == "color") {
        if (value.text.empty() || value.text == "invalid") return;
        comb.color = color_of(value);
        if (!comb.color) return wrong("a colour of three numbers 0 to 255");
    } else if (name == "shader" || name == "oshader") {
        comb.shader = tcl_value(value);
    } else if (name == "inherit") {
        comb.inherit = is_yes(value);
    }
    // Other attributes (material_id, los, comments) do not affect the image.
}

void BrlcadV5Reader::read_attributes(std::span<const TclWord> words) {
    if (words.size() < 3 || words[1].text != "set") {
        fault(location(words[0]), "expected attr set NAME KEY VALUE ...");
        return;
    }
    const std::string name = tcl_value(words[2]);
    BrlcadObject* object = database_.find(name);
    auto* comb = object == nullptr ? nullptr : std::get_if<BrlcadCombination>(&object->what);
    if (object == nullptr && name != "_GLOBAL") {
        diagnostics_.warning(location(words[2]),
                             "attributes of '" + name + "', which is not in the database (yet)");
        return;
    }
    for (std::size_t i = 3; i < words.size(); i += 2) {
        if (i + 1 == words.size()) {
            fault(location(words[i]), "expected a value of " + shown(words[i]));
        } else if (comb != nullptr) {
            set_attribute(*comb, words[i], words[i + 1]);
        } else if (object == nullptr && words[i].text == "title") {
            database_.title = tcl_value(words[i + 1]);
        } else if (object == nullptr && words[i].text == "regionid_colortable") {
            read_color_table(words[i + 1]);
        }
    }
}

void BrlcadV5Reader::read_region_color(std::span<const TclWord> words) {
    std::array<int, 5> n{};
    bool good = words.size() == 6;
    for (std::size_t i = 0; good && i < 5; ++i) {
        const std::optional<int> value = whole_number(words[i + 1]);
        good = value.has_value();
        if (good) n[i] = *value;
    }
    if (!good) {
        fault(location(words[0]), "expected color FIRST LAST R G B");
        return;
    }
    database_.region_colors.push_back({n[0], n[1], brlcad_color(n[2], n[3], n[4])});
}

void BrlcadV5Reader::read_color_table(const TclWord& table) {
    const std::vector<double> n = tcl_numbers(table.text, 1'000'000);
    if (n.size() % 5 != 0) {
        fault(location(table), "expected lists of five numbers: FIRST LAST R G B");
        return;
    }
    const auto small = [](double v) { return static_cast<int>(std::clamp(v, -2e9, 2e9)); };
    for (std::size_t i = 0; i < n.size(); i += 5) {
        database_.region_colors.push_back(
            {small(n[i]), small(n[i + 1]), brlcad_color(n[i + 2], n[i + 3], n[i + 4])});
    }
}

}  // namespace alhazen

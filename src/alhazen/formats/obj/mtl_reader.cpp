#include "alhazen/formats/obj/mtl_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <unordered_set>

#include "alhazen/formats/text/lexer.h"
#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

namespace {

std::string lower(std::string_view text) {
    std::string copy(text);
    std::transform(copy.begin(), copy.end(), copy.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return copy;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && TextCursor::is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && TextCursor::is_blank(text.back())) text.remove_suffix(1);
    return text;
}

/// Reads the options before an image name, and those that some exporters write after it.
class MapReader {
  public:
    explicit MapReader(MtlMap& map) : map_(map) {}

    /// Reads the line; false if an option is unsupported.
    bool read(std::string_view line) {
        TextCursor cursor(line);
        read_options(cursor);
        std::string_view name = trimmed(cursor.rest_of_line());
        const std::size_t behind = options_behind(name);
        if (behind != std::string_view::npos) {
            TextCursor late(name.substr(behind));
            read_options(late);
            name = trimmed(name.substr(0, behind));
        }
        if (name.size() > 1 && name.front() == '"' && name.back() == '"') {
            name = name.substr(1, name.size() - 2);
        }
        map_.file = std::string(name);
        return kept_;
    }

  private:
    static constexpr std::array<std::string_view, 16> kOptions{
        "-s",      "-o",       "-t",     "-mm", "-bm",   "-boost",      "-texres", "-blendu",
        "-blendv", "-imfchan", "-clamp", "-cc", "-type", "-colorspace", "-texopt", "-threshold"};

    void read_options(TextCursor& cursor) {
        while (cursor.skip_blanks() && cursor.peek() == '-') {
            TextCursor ahead = cursor;
            const std::string option = lower(ahead.word());
            if (std::find(kOptions.begin(), kOptions.end(), option) == kOptions.end()) return;
            cursor = ahead;
            read_option(option, cursor);
        }
    }
    void read_option(const std::string& option, TextCursor& cursor) {
        if (option == "-s" || option == "-o" || option == "-t") {
            Vec2& target = option == "-s" ? map_.scale : option == "-o" ? map_.offset : unused_;
            const Vec2 rest = option == "-s" ? Vec2{1, 1} : Vec2{0, 0};
            std::array<double, 3> v{};
            const int count = numbers(cursor, v);
            target = {count > 0 ? v[0] : rest.x, count > 1 ? v[1] : rest.y};
        } else if (option == "-mm") {
            std::array<double, 3> v{0, 1, 0};
            numbers(cursor, v, 2);
            kept_ = kept_ && v[0] == 0.0;
            map_.gain = v[1];
        } else if (option == "-bm") {
            one(cursor, map_.bump);
        } else if (option == "-boost" || option == "-texres" || option == "-threshold") {
            double unused = 0;
            one(cursor, unused);
        } else {
            cursor.skip_blanks();
            const std::string value = lower(cursor.word());
            if (option == "-clamp") map_.clamp = value == "on";
            if (option == "-imfchan") set_channel(value);
        }
    }
    void set_channel(const std::string& name) {
        if (name == "r") map_.channel = Channel::Red;
        if (name == "g") map_.channel = Channel::Green;
        if (name == "b") map_.channel = Channel::Blue;
        if (name == "m") map_.channel = Channel::Alpha;
        if (name == "l") map_.channel = Channel::Mean;
        kept_ = kept_ && name != "z";
    }
    static int numbers(TextCursor& cursor, std::array<double, 3>& v, int most = 3) {
        int count = 0;
        while (count < most && cursor.skip_blanks() && cursor.number(v[std::size_t(count)])) {
            ++count;
        }
        return count;
    }
    static void one(TextCursor& cursor, double& value) {
        std::array<double, 3> v{};
        if (numbers(cursor, v, 1) == 1) value = v[0];
    }
    /// Index of the first option after the name.
    static std::size_t options_behind(std::string_view name) {
        for (std::size_t at = name.find(" -"); at != std::string_view::npos;
             at = name.find(" -", at + 1)) {
            const std::string_view word = name.substr(at + 1, name.find(' ', at + 1) - at - 1);
            if (std::find(kOptions.begin(), kOptions.end(), lower(word)) != kOptions.end()) {
                return at;
            }
        }
        return std::string_view::npos;
    }

    MtlMap& map_;
    Vec2 unused_;
    bool kept_ = true;
};

class MtlReader {
  public:
    MtlReader(std::string_view bytes, const std::string& file, Diagnostics& diagnostics)
        : cursor_(bytes), file_(file), diagnostics_(diagnostics) {}

    std::vector<MtlMaterial> read() {
        for (; !cursor_.at_end(); cursor_.skip_line()) {
            if (!cursor_.skip_blanks() || cursor_.peek() == '#') continue;
            start_ = cursor_.location(file_);
            word_ = cursor_.word().substr(0, 32);
            const std::string keyword = lower(word_);
            if (keyword == "newmtl") {
                if (materials_.size() == kMaxMtlMaterials) {
                    diagnostics_.warning(start_, "more than " + std::to_string(kMaxMtlMaterials) +
                                                     " materials; the rest is ignored");
                    break;
                }
                cursor_.skip_blanks();
                materials_.emplace_back();
                materials_.back().name = std::string(trimmed(cursor_.rest_of_line()));
                if (!names_.insert(materials_.back().name).second) {
                    diagnostics_.warning(start_, "a second material '" +
                                                     printable(materials_.back().name) +
                                                     "' of the file is ignored");
                }
                materials_.back().location = start_;
            } else if (materials_.empty()) {
                warn_once(0, "a statement before the first newmtl is ignored");
            } else {
                read_statement(keyword, materials_.back());
            }
        }
        if (!unused_.empty()) diagnostics_.warning(first_unused_, list_unused());
        return std::move(materials_);
    }

  private:
    static constexpr std::size_t kMaxListed = 20;

    void read_statement(const std::string& keyword, MtlMaterial& m) {
        struct Color {
            std::string_view keyword;
            std::optional<Rgb> MtlMaterial::*field;
        };
        static constexpr std::array<Color, 6> kColors{{{"ka", &MtlMaterial::ka},
                                                       {"kd", &MtlMaterial::kd},
                                                       {"ks", &MtlMaterial::ks},
                                                       {"ke", &MtlMaterial::ke},
                                                       {"tf", &MtlMaterial::tf},
                                                       {"kt", &MtlMaterial::tf}}};
        struct Number {
            std::string_view keyword;
            std::optional<double> MtlMaterial::*field;
            double most;
        };
        static constexpr double kNoLimit = std::numeric_limits<double>::infinity();
        static constexpr std::array<Number, 8> kNumbers{{{"ns", &MtlMaterial::ns, kNoLimit},
                                                         {"ni", &MtlMaterial::ni, kNoLimit},
                                                         {"d", &MtlMaterial::d, 1},
                                                         {"tr", &MtlMaterial::tr, 1},
                                                         {"pr", &MtlMaterial::pr, 1},
                                                         {"pm", &MtlMaterial::pm, 1},
                                                         {"pc", &MtlMaterial::pc, 1},
                                                         {"pcr", &MtlMaterial::pcr, 1}}};
        struct Map {
            std::string_view keyword;
            MtlMap MtlMaterial::*field;
        };
        static constexpr std::array<Map, 13> kMaps{{{"map_ka", &MtlMaterial::map_ka},
                                                    {"map_kd", &MtlMaterial::map_kd},
                                                    {"map_ks", &MtlMaterial::map_ks},
                                                    {"map_ke", &MtlMaterial::map_ke},
                                                    {"map_ns", &MtlMaterial::map_ns},
                                                    {"map_d", &MtlMaterial::map_d},
                                                    {"map_opacity", &MtlMaterial::map_d},
                                                    {"map_pr", &MtlMaterial::map_pr},
                                                    {"map_pm", &MtlMaterial::map_pm},
                                                    {"norm", &MtlMaterial::normal},
                                                    {"map_norm", &MtlMaterial::normal},
                                                    {"bump", &MtlMaterial::map_bump},
                                                    {"map_bump", &MtlMaterial::map_bump}}};
        for (const Color& color : kColors) {
            if (color.keyword == keyword) return read_color(m.*color.field);
        }
        for (const Number& number : kNumbers) {
            if (number.keyword == keyword) return read_number(m.*number.field, number.most);
        }
        for (const Map& map : kMaps) {
            if (map.keyword == keyword) return read_map(m.*map.field);
        }
        if (keyword == "illum") {
            std::optional<double> model;
            read_number(model, 10);
            if (model && *model >= 0 && *model <= 10) m.illum = int(*model);
        } else if (keyword == "disp" || keyword == "map_disp" || keyword == "decal" ||
                   keyword == "refl" || keyword == "map_tr" || keyword == "map_ps") {
            warn_once(1, "displacement, decals, reflection maps, map_Tr and map_Ps are ignored");
        } else if (keyword == "ps" || keyword == "aniso" || keyword == "anisor") {
            double value = 0;  // exporters write 0 for none
            if (!cursor_.skip_blanks() || !cursor_.number(value) || value != 0) unused("");
        } else {
            unused("");
        }
    }

    void read_color(std::optional<Rgb>& color) {
        cursor_.skip_blanks();
        if (std::isalpha(static_cast<unsigned char>(cursor_.peek()))) {
            return warn_once(2, "spectral and XYZ colours are not supported and ignored");
        }
        TextCursor begin = cursor_;
        Rgb value;
        int count = 0;
        while (count < 3 && cursor_.skip_blanks() && cursor_.number(value[count])) ++count;
        if (count == 0) return bad_number();
        if (count == 2) warn_once(5, "a colour of two numbers: the second is also its blue");
        // One number is grey; of two, the second also serves as the third.
        for (; count < 3; ++count) value[count] = value[count - 1];
        if (std::min({value.r, value.g, value.b}) < 0) return unused(begin.rest_of_line());
        color = value;
    }
    void read_number(std::optional<double>& number, double most) {
        cursor_.skip_blanks();
        // "d -halo 0.5": the halo does not apply to triangle surfaces; its factor is read as d.
        if (cursor_.peek() == '-') {
            TextCursor ahead = cursor_;
            if (ahead.word() == "-halo") {
                warn_once(4, "-halo is ignored: d is the same from all sides");
                cursor_ = ahead;
                cursor_.skip_blanks();
            }
        }
        double value = 0;
        TextCursor ahead = cursor_;
        if (!cursor_.number(value)) return bad_number();
        if (value < 0 || value > most) unused(ahead.word());
        number = value;
    }
    void read_map(MtlMap& map) {
        map = {};
        map.location = start_;
        cursor_.skip_blanks();
        if (!MapReader(map).read(cursor_.rest_of_line())) {
            warn_once(3, "the base of -mm and the channel z of -imfchan are ignored");
        }
        if (map.file.empty()) unused("(no file)");
    }

    /// Lists the current statement, with `detail`, as one that is unknown or out of its range.
    void unused(std::string_view detail) {
        std::string text = "'" + std::string(word_);
        if (!detail.empty()) text += " " + std::string(detail.substr(0, 32));
        text += "'";
        if (unused_.empty()) first_unused_ = start_;
        if (std::find(unused_.begin(), unused_.end(), text) != unused_.end()) return;
        if (unused_.size() <= kMaxListed) unused_.push_back(std::move(text));
    }
    [[nodiscard]] std::string list_unused() const {
        std::string list = "unknown or out of range:";
        for (std::size_t i = 0; i < unused_.size() && i < kMaxListed; ++i) {
            list += (i == 0 ? " " : ", ") + unused_[i];
        }
        return list + (unused_.size() > kMaxListed ? " and others" : "");
    }

    void bad_number() {
        diagnostics_.warning(cursor_.location(file_),
                             "expected a number, found " + cursor_.shown_word() + "; ignored");
    }
    void warn_once(std::size_t which, const char* message) {
        if (warned_[which]) return;
        warned_[which] = true;
        diagnostics_.warning(start_, message);
    }

    TextCursor cursor_;
    const std::string& file_;
    Diagnostics& diagnostics_;
    FileLocation start_;
    std::string_view word_;  ///< the keyword of the current statement
    std::vector<MtlMaterial> materials_;
    std::vector<std::string> unused_;  ///< at most one more than are listed
    FileLocation first_unused_;
    std::unordered_set<std::string> names_;
    std::array<bool, 6> warned_{};
};

}  // namespace

std::vector<MtlMaterial> read_mtl(std::string_view bytes, const std::string& file,
                                  Diagnostics& diagnostics) {
    return MtlReader(bytes, file, diagnostics).read();
}

}  // namespace alhazen

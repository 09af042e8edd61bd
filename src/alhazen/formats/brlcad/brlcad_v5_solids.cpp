#include <algorithm>
#include <array>
#include <set>

#include "alhazen/formats/brlcad/brlcad_v4_solids.h"
#include "alhazen/formats/brlcad/brlcad_v5_reader.h"
#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

namespace {

/// Parameters of a solid by name.
class Parameters {
  public:
    Parameters(const TclWord& type, std::span<const TclWord> words, TextPlaces& places,
               const std::string& file)
        : type_(type), words_(words), places_(places), file_(file) {
        for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
            by_name_.try_emplace(words[i].text, words[i + 1]);
        }
        if (words.size() % 2 != 0) fail(words.back(), "expected a value after it");
    }

    [[noreturn]] void fail(const TclWord& at, const std::string& message) const {
        const BrlcadPlace place = places_.of(at.text.data());
        throw Error(
            ErrorKind::Scene,
            std::string(type_.text) + " '" + std::string(at.text.substr(0, 40)) + "': " + message,
            {file_, place.line, place.column});
    }

    [[nodiscard]] bool has(std::string_view name) const { return by_name_.contains(name); }
    const TclWord& word(std::string_view name) const {
        const auto found = by_name_.find(name);
        if (found == by_name_.end()) {
            fail(type_, "expected a parameter " + std::string(name));
        }
        return found->second;
    }
    std::vector<double> numbers(std::string_view name, std::size_t count) const {
        const TclWord& value = word(name);
        std::vector<double> v;
        try {
            v = tcl_numbers(value.text, count);
        } catch (const Error& error) {
            fail(value, std::string(name) + ": " + error.what());
        }
        if (v.size() != count) {
            fail(value, "expected " + std::to_string(count) + " numbers of " + std::string(name));
        }
        return v;
    }
    double number(std::string_view name) const { return numbers(name, 1)[0]; }
    Vec3 vec(std::string_view name) const {
        const std::vector<double> v = numbers(name, 3);
        return {v[0], v[1], v[2]};
    }
    /// An integer from `least` to `most`.
    std::size_t count(std::string_view name, std::size_t least, std::uint64_t most) const {
        const double n = number(name);
        if (!(n >= static_cast<double>(least) && n <= static_cast<double>(most)) ||
            n != static_cast<double>(static_cast<std::uint64_t>(n))) {
            fail(word(name), "expected a whole number from " + std::to_string(least) + " to " +
                                 std::to_string(most));
        }
        return static_cast<std::size_t>(n);
    }

  private:
    TclWord type_;
    std::span<const TclWord> words_;
    TextPlaces& places_;
    const std::string& file_;
    std::map<std::string_view, TclWord> by_name_;
};

BrlcadArb8 arb8(const Parameters& p) {
    BrlcadArb8 arb;
    for (std::size_t i = 0; i < 8; ++i) arb.corners[i] = p.vec("V" + std::to_string(i + 1));
    return arb;
}

BrlcadPolyhedron arbn(const Parameters& p, std::uint64_t max_elements) {
    BrlcadPolyhedron polyhedron;
    const std::size_t planes = p.count("N", 0, std::min<std::uint64_t>(max_elements, 1'000'000));
    for (std::size_t i = 0; i < planes; ++i) {
        const std::vector<double> v = p.numbers("P" + std::to_string(i), 4);
        polyhedron.planes.push_back({{v[0], v[1], v[2]}, v[3]});
    }
    return polyhedron;
}

BrlcadMesh ars(const Parameters& p, std::uint64_t max_elements) {
    const std::size_t curves = p.count("NC", 2, max_elements);
    const std::size_t per_curve = p.count("PPC", 1, max_elements / curves);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < curves; ++i) {
        const std::vector<double> v = p.numbers("C" + std::to_string(i), 3 * per_curve);
        for (std::size_t j = 0; j < per_curve; ++j) {
            points.push_back({v[3 * j], v[3 * j + 1], v[3 * j + 2]});
        }
    }
    return brlcad_ars(points, curves, per_curve);
}

BrlcadMesh bot(const Parameters& p, std::uint64_t max_elements) {
    BrlcadMesh bot;
    bot.mesh = std::make_shared<TriangleMesh>();
    const std::string_view mode = p.word("mode").text;
    bot.solid = mode == "volume";
    bot.plate = mode == "plate" || mode == "plate_nocos";
    if (!bot.solid && !bot.plate && mode != "surf") {
        p.fail(p.word("mode"), "expected volume, surf, plate or plate_nocos");
    }
    const auto list = [&](const char* name) {
        const std::size_t most = static_cast<std::size_t>(std::min<std::uint64_t>(
            3 * std::min<std::uint64_t>(max_elements, 0x55555555u), 0xffffffffu));
        std::vector<double> v = tcl_numbers(p.word(name).text, most);
        if (v.size() % 3 != 0) p.fail(p.word(name), "expected three numbers each");
        return v;
    };
    const std::vector<double> points = list("V");
    for (std::size_t i = 0; i < points.size(); i += 3) {
        bot.mesh->positions.push_back({points[i], points[i + 1], points[i + 2]});
    }
    const std::vector<double> faces = list("F");
    const auto vertices = static_cast<double>(bot.mesh->positions.size());
    const bool turned = p.has("orient") && p.word("orient").text == "lh";
    for (std::size_t i = 0; i < faces.size(); i += 3) {
        std::array<std::uint32_t, 3> triangle{};
        for (std::size_t k = 0; k < 3; ++k) {
            const double v = faces[i + k];
            if (!(v >= 0.0 && v < vertices) ||
                v != static_cast<double>(static_cast<std::uint32_t>(v))) {
                p.fail(p.word("F"),
                       "face " + std::to_string(i / 3) + " has an invalid vertex number");
            }
            triangle[k] = static_cast<std::uint32_t>(v);
        }
        if (turned) std::swap(triangle[1], triangle[2]);
        bot.mesh->triangles.push_back(triangle);
    }
    return bot;
}

BrlcadConicCylinder conic_cylinder(const Parameters& p, bool hyperbolic) {
    return {p.vec("V"), p.vec("H"), p.vec("B"), p.number("r"), hyperbolic ? p.number("c") : 0.0,
            hyperbolic};
}

BrlcadConicDome conic_dome(const Parameters& p, bool hyperbolic) {
    return {p.vec("V"),      p.vec("H"),      p.vec("A"),
            p.number("r_1"), p.number("r_2"), hyperbolic ? p.number("c") : 0.0,
            hyperbolic};
}

}  // namespace

std::vector<double> tcl_numbers(std::string_view list, std::size_t most) {
    TclTokens tokens(list);
    std::vector<double> numbers;
    int depth = 0;
    for (;;) {
        const TclToken token = tokens.next();
        if (token.kind == TclTokenKind::Open) {
            ++depth;
        } else if (token.kind == TclTokenKind::Close) {
            --depth;
        } else if (token.kind == TclTokenKind::End) {
            return numbers;
        } else {
            TextCursor cursor(token.word.text);
            double value = 0.0;
            if (!cursor.number(value)) {
                throw Error(ErrorKind::Scene, "expected a number, found " + cursor.shown_word());
            }
            if (numbers.size() == most) {
                throw Error(ErrorKind::Scene, "more than " + std::to_string(most) + " numbers");
            }
            numbers.push_back(value);
        }
        if (depth < 0 || depth > 8) throw Error(ErrorKind::Scene, "unbalanced or too deep braces");
    }
}

BrlcadSolid read_brlcad_v5_solid(const TclWord& type, std::span<const TclWord> parameters,
                                 TextPlaces& places, const std::string& file,
                                 std::uint64_t max_elements) {
    BrlcadSolid solid{std::string(type.text.substr(0, 64)), BrlcadUnsupported{}};
    const std::string& t = solid.type;
    const Parameters p(type, parameters, places, file);
    if (t == "arb8") {
        solid.form = arb8(p);
    } else if (t == "ell" || t == "sph") {
        solid.form = BrlcadEllipsoid{p.vec("V"), p.vec("A"), p.vec("B"), p.vec("C")};
    } else if (t == "tgc") {
        solid.form =
            BrlcadTgc{p.vec("V"), p.vec("H"), p.vec("A"), p.vec("B"), p.vec("C"), p.vec("D")};
    } else if (t == "tor") {
        solid.form = BrlcadTorus{p.vec("V"), p.vec("H"), p.number("r_a"), p.number("r_h")};
    } else if (t == "half") {
        solid.form = BrlcadHalfSpace{p.vec("N"), p.number("d")};
    } else if (t == "part") {
        solid.form = BrlcadParticle{p.vec("V"), p.vec("H"), p.number("r_v"), p.number("r_h")};
    } else if (t == "rpc" || t == "rhc") {
        solid.form = conic_cylinder(p, t == "rhc");
    } else if (t == "epa" || t == "ehy") {
        solid.form = conic_dome(p, t == "ehy");
    } else if (t == "eto") {
        solid.form =
            BrlcadEllipticTorus{p.vec("V"), p.vec("N"), p.vec("C"), p.number("r"), p.number("r_d")};
    } else if (t == "hyp") {
        solid.form =
            BrlcadHyperboloid{p.vec("V"), p.vec("H"), p.vec("A"), p.number("b"), p.number("bnr")};
    } else if (t == "superell") {
        solid.form = BrlcadSuperellipsoid{p.vec("V"), p.vec("A"),    p.vec("B"),
                                          p.vec("C"), p.number("n"), p.number("e")};
    } else if (t == "arbn") {
        solid.form = arbn(p, max_elements);
    } else if (t == "ars") {
        solid.form = ars(p, max_elements);
    } else if (t == "bot") {
        solid.form = bot(p, max_elements);
    }
    return solid;
}

}  // namespace alhazen

#include "alhazen/formats/brlcad/brlcad_shader.h"

#include <algorithm>
#include <array>

#include "alhazen/formats/brlcad/brlcad_tcl.h"
#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

namespace {

/// Names that begin a shader within a stack, where nothing else separates it from the previous one.
constexpr std::array<std::string_view, 26> kShaderNames{
    "air",    "brdf",     "bump", "bwtexture", "camo",  "checker", "cloud",   "cook",  "default",
    "envmap", "fakestar", "fire", "flat",      "gauss", "glass",   "gravel",  "light", "mirror",
    "phong",  "plastic",  "prj",  "scloud",    "stack", "testmap", "texture", "wood"};

bool is_shader_name(std::string_view word) {
    return std::find(kShaderNames.begin(), kShaderNames.end(), word) != kShaderNames.end();
}

std::optional<double> number_of(std::string_view word) {
    TextCursor cursor(word);
    double value = 0.0;
    if (word.empty() || !cursor.number(value) || !cursor.at_end()) return std::nullopt;
    return value;
}

}  // namespace

const std::vector<double>* BrlcadShader::find(std::string_view long_name,
                                              std::string_view short_name) const {
    const std::vector<double>* found = nullptr;
    for (const auto& [name_of_it, values] : parameters) {
        if (name_of_it == long_name || (!short_name.empty() && name_of_it == short_name)) {
            found = &values;
        }
    }
    return found;
}

std::optional<double> BrlcadShader::number(std::string_view long_name,
                                           std::string_view short_name) const {
    const std::vector<double>* values = find(long_name, short_name);
    if (values == nullptr || values->empty()) return std::nullopt;
    return values->front();
}

std::optional<Rgb> BrlcadShader::three(std::string_view long_name,
                                       std::string_view short_name) const {
    const std::vector<double>* values = find(long_name, short_name);
    if (values == nullptr || values->size() < 3) return std::nullopt;
    return Rgb{(*values)[0], (*values)[1], (*values)[2]};
}

std::vector<BrlcadShader> read_brlcad_shaders(const std::string& text) {
    std::string spaced;
    for (const char c : text) {
        if (c == ';') {
            spaced += " ; ";
        } else {
            spaced += c == '=' || c == ',' || c == '/' ? ' ' : c;
        }
    }
    std::vector<BrlcadShader> shaders;
    bool begins = true;
    TclTokens tokens(spaced);
    for (TclToken token = tokens.next(); token.kind != TclTokenKind::End; token = tokens.next()) {
        if (token.kind != TclTokenKind::Word) continue;
        const std::string word = tcl_value(token.word);
        const bool in_list =
            !shaders.empty() && (shaders[0].name == "stack" || shaders[0].name == "envmap");
        if (word == ";") {
            begins = true;
        } else if (begins || (in_list && is_shader_name(word))) {
            shaders.push_back({word, {}});
            // The next word in a stack or after envmap begins another shader.
            begins = word == "stack" || word == "envmap";
        } else if (const auto value = number_of(word); !value) {
            shaders.back().parameters.push_back({word, {}});
        } else if (!shaders.back().parameters.empty()) {
            shaders.back().parameters.back().second.push_back(*value);
        }
    }
    return shaders;
}

}  // namespace alhazen

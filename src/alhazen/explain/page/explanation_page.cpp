#include "alhazen/explain/page/explanation_page.h"

#include <fmt/format.h>

#include "alhazen/explain/page/explanation_json.h"
#include "alhazen/laboratory/html_text.h"

namespace alhazen {

namespace {

/// Escapes JSON so that it cannot end the enclosing HTML element.
std::string in_element(std::string json) {
    std::string safe;
    safe.reserve(json.size());
    for (const char c : json) {
        if (c == '<') {
            safe += "\\u003c";
        } else {
            safe += c;
        }
    }
    return safe;
}

}  // namespace

std::string explanation_page(const Explanation& e) {
    const std::string title = fmt::format("Pixel {},{} of {}", e.x, e.y, html_escaped(e.scene));
    std::string page =
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src "
        "data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n";
    page += fmt::format("<title>{}</title>\n<style>", title);
    append(page, kExplanationStyle);
    page += "</style>\n</head>\n<body>\n<main id=\"explanation\">";
    page += fmt::format("<h1>{}</h1><noscript>This page draws the data in it by a script.", title);
    page += "</noscript></main>\n<script type=\"application/json\" id=\"data\">";
    page += in_element(explanation_json(e, -1));
    page += "</script>\n<script type=\"application/json\" id=\"preview\">";
    page += e.preview.samples.empty() ? "null" : fmt::format("\"{}\"", png_data_uri(e.preview));
    page += "</script>\n<script type=\"module\">";
    append(page, kExplanationScript);
    page += "</script>\n</body>\n</html>\n";
    return page;
}

}  // namespace alhazen

#include "alhazen/imaging/svg/svg_writer.h"

#include <fmt/format.h>

#include "alhazen/imaging/image/encoding.h"

namespace alhazen {

std::string xml_escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c >= ' ' && c < '\x7f' ? c : '?';
        }
    }
    return out;
}

std::string css_color(const Rgb& linear) {
    std::string out = "#";
    for (int i = 0; i < 3; ++i) {
        out += fmt::format("{:02x}", encode_channel(linear[i], Encoding::Srgb, 8));
    }
    return out;
}

namespace svg {

std::string decimals(double x, int count) {
    return fmt::format("{:.{}f}", x, count);
}

std::string digits(double x) {
    return fmt::format("{:.10g}", x);
}

std::string points(std::span<const Vec2> corners) {
    std::string text;
    for (const Vec2& p : corners) {
        text += fmt::format("{}{:.2f},{:.2f}", text.empty() ? "" : " ", p.x, p.y);
    }
    return text;
}

void Path::add(char command, const Vec2& p) {
    data_ += fmt::format("{}{:.10g} {:.10g}", command, p.x, p.y);
}

void Writer::begin(std::string_view element, Attributes attributes) {
    out_ += '<';
    out_ += element;
    for (const Attribute& a : attributes) {
        out_ += fmt::format(" {}=\"{}\"", a.name, xml_escaped(a.value));
    }
}

void Writer::open(std::string_view element, Attributes attributes) {
    begin(element, attributes);
    out_ += ">\n";
    open_.emplace_back(element);
}

void Writer::close() {
    out_ += fmt::format("</{}>\n", open_.back());
    open_.pop_back();
}

void Writer::leaf(std::string_view element, Attributes attributes) {
    begin(element, attributes);
    out_ += "/>\n";
}

void Writer::text(std::string_view element, Attributes attributes, std::string_view text) {
    begin(element, attributes);
    out_ += fmt::format(">{}</{}>\n", xml_escaped(text), element);
}

std::string Writer::finish() {
    while (!open_.empty()) close();
    return std::move(out_);
}

}  // namespace svg

}  // namespace alhazen

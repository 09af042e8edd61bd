#include "frame_protocol.h"

#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>

#include "alhazen/base/error.h"

namespace alhazen::viewer {

namespace {

/// The largest number of nested brackets.
int depth_of(std::string_view text) {
    int depth = 0, most = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string && c == '\\') {
            ++i;
        } else if (c == '"') {
            in_string = !in_string;
        } else if (!in_string && (c == '[' || c == '{')) {
            most = std::max(most, ++depth);
        } else if (!in_string && (c == ']' || c == '}')) {
            --depth;
        }
    }
    return most;
}

}  // namespace

nlohmann::ordered_json wish_json(std::string_view text) {
    constexpr int kDeepest = 64;
    if (depth_of(text) > kDeepest) throw Error(ErrorKind::Usage, "nested deeper than 64 levels");
    return nlohmann::ordered_json::parse(text);
}

ClientMessage client_message(std::string_view text) {
    ClientMessage message;
    try {
        const nlohmann::ordered_json given = wish_json(text);
        if (!given.is_object()) return message;
        if (const auto token = given.find("token"); token != given.end()) {
            message.token = token->get<std::string>();
            message.kind = ClientMessage::Kind::Token;
            return message;
        }
        message.moving = given.value("moving", false);
        message.id = given.value("id", std::int64_t{0});
        message.kind =
            given.contains("shown") ? ClientMessage::Kind::Shown : ClientMessage::Kind::Wish;
    } catch (const std::exception&) {
        message.kind = ClientMessage::Kind::Bad;
    }
    return message;
}

std::string picture_head(std::int64_t id, const Response& made) {
    const std::string facts = made.facts.empty() ? "null" : made.facts;
    const std::string text = "{\"id\":" + std::to_string(id) +
                             ",\"status\":" + std::to_string(made.status) + ",\"type\":\"" +
                             made.type + "\",\"facts\":" + facts + "}";
    std::string head;
    for (int i = 0; i < 4; ++i) head += static_cast<char>(text.size() >> (8 * i) & 255U);
    return head + text;
}

}  // namespace alhazen::viewer

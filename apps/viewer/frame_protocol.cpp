#include "frame_protocol.h"

#include <exception>
#include <nlohmann/json.hpp>

#include "wish_values.h"

namespace alhazen::viewer {

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
        if (given.value("stop", false)) {
            message.kind = ClientMessage::Kind::Stop;
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

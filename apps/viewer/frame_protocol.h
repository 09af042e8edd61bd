#pragma once
/// The messages of the WebSocket (frame_socket.h) as texts.
///
/// Conventions: a message to the server is a JSON object: {"token": KEY} at first, then wishes (a
/// body of /frame with `id`, and `moving` where the next of its kind is to be shown only after it),
/// and {"shown": id} for each picture that has arrived. A message from the server is a state, JSON
/// in a text message, or a picture in a binary one: four bytes, the length of a JSON text (least
/// byte first), that text (`id`, `status`, `type`, `facts`), the body.

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "http_server.h"

namespace alhazen::viewer {

/// JSON nested at most 64 deep. Throws nlohmann::json::exception, and Error (Usage) where deeper.
[[nodiscard]] nlohmann::ordered_json wish_json(std::string_view text);

struct ClientMessage {
    enum class Kind { Bad, Token, Shown, Wish };
    Kind kind = Kind::Bad;
    std::string token;
    std::int64_t id = 0;
    bool moving = false;
};
[[nodiscard]] ClientMessage client_message(std::string_view text);

/// What comes before the body of a picture.
[[nodiscard]] std::string picture_head(std::int64_t id, const Response& made);

}  // namespace alhazen::viewer

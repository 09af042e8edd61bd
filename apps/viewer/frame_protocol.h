#pragma once
/// The messages of the WebSocket (frame_socket.h) as text.
///
/// Conventions: a message to the server is a JSON object: first {"token": KEY}; then requests (a
/// body of /frame with `id`, and `moving` if the next picture must wait until this one is shown),
/// {"shown": id} for each picture that has arrived, and {"stop": true} with the `client` of /stop.
/// A message from the server is a state, as JSON in a text message, or a picture in a binary
/// message: the length of a JSON text (four bytes, least significant first), the text (`id`,
/// `status`, `type`, `facts`), the body.

#include <cstdint>
#include <string>
#include <string_view>

#include "http_server.h"

namespace alhazen::viewer {

struct ClientMessage {
    enum class Kind { Bad, Token, Shown, Wish, Stop };
    Kind kind = Kind::Bad;
    std::string token;
    std::int64_t id = 0;
    bool moving = false;
};
[[nodiscard]] ClientMessage client_message(std::string_view text);

/// The part of a picture's message before the body.
[[nodiscard]] std::string picture_head(std::int64_t id, const Response& made);

}  // namespace alhazen::viewer

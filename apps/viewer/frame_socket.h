#pragma once
/// Frames over a WebSocket (RFC 6455): the newest wish of a client, and at most one picture on its
/// way.
///
/// Conventions: the first message is {"token": ...}, within 5 s; a wrong one is closed by 1008. A
/// wish is JSON with `id`, and `moving` where the next of its kind is to be shown only after it. A
/// wish takes the place of one that waits, and ends one in hand that is not `moving`. The answer is
/// binary: four bytes, the length of a JSON text (least byte first), that text (`id`, `status`,
/// `type`, `facts`), the body. {"shown": id} says that it has arrived: the next is sent then, while
/// another may be made. A picture that waits gives its place to a newer one. Messages to the server
/// have 1 MiB at most (1009), what is no JSON object is closed by 1007. Threads: all of it in the
/// strand of the stream, the handler beside it. Included by http_server.cpp alone.

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>
#include <optional>

#include "http_server.h"

namespace alhazen::viewer {

class FrameSocket : public std::enable_shared_from_this<FrameSocket> {
  public:
    using Handler = std::function<Response(const Request&)>;
    using HttpRequest = boost::beast::http::request<boost::beast::http::string_body>;

    /// `workers` runs the handler; the handler must outlive the socket.
    FrameSocket(boost::beast::tcp_stream stream, boost::asio::io_context& workers,
                const Handler& handler)
        : socket_(std::move(stream)), workers_(workers), handler_(handler) {}

    /// Until the client is gone.
    boost::asio::awaitable<void> serve(const HttpRequest& request, const std::string& token) {
        namespace websocket = boost::beast::websocket;
        websocket::stream_base::timeout patience{std::chrono::seconds(5), std::chrono::seconds(5),
                                                 false};
        socket_.set_option(patience);
        socket_.read_message_max(kMostMessage);
        socket_.auto_fragment(false);
        socket_.binary(true);
        co_await socket_.async_accept(request, boost::asio::use_awaitable);
        if (!co_await knows(token)) co_return;
        patience.keep_alive_pings = true;  // a quiet page stays
        socket_.set_option(patience);
        try {
            for (;;) {
                const Json message = co_await next();
                if (!message.is_object()) break;
                take(message);
            }
        } catch (...) {
            leave();
            throw;
        }
        leave();
        co_await socket_.async_close(websocket::close_code::bad_payload,
                                     boost::asio::use_awaitable);
    }

  private:
    using Json = nlohmann::ordered_json;
    static constexpr std::size_t kMostMessage = 1024 * 1024;
    struct Wish {
        std::int64_t id = 0;
        bool moving = false;
        std::string body;
    };
    struct Picture {
        std::string head, body;
    };

    /// Whether the first message has the token. A timer, as bytes that drip count as life.
    boost::asio::awaitable<bool> knows(const std::string& token) {
        boost::asio::steady_timer timer(socket_.get_executor(), std::chrono::seconds(5));
        timer.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
            if (!error) boost::beast::get_lowest_layer(self->socket_).close();
        });
        const Json first = co_await next();
        timer.cancel();
        const auto given = first.is_object() ? first.find("token") : first.end();
        if (first.is_object() && given != first.end() && given->is_string() &&
            same_secret(given->get_ref<const std::string&>(), token)) {
            co_return true;
        }
        co_await socket_.async_close(boost::beast::websocket::close_code::policy_error,
                                     boost::asio::use_awaitable);
        co_return false;
    }

    boost::asio::awaitable<Json> next() {
        boost::beast::flat_buffer buffer;
        (void)co_await socket_.async_read(buffer, boost::asio::use_awaitable);
        text_ = boost::beast::buffers_to_string(buffer.data());
        co_return Json::parse(text_, nullptr, false);
    }

    void take(const Json& message) {
        const auto id = message.find("id"), moving = message.find("moving");
        if (message.contains("shown")) {
            on_way_ = false;
        } else {
            pending_ = Wish{id != message.end() && id->is_number_integer() ? id->get<std::int64_t>()
                                                                           : 0,
                            moving != message.end() && *moving == true, text_};
            if (stop_ && !working_.moving) stop_->request();
        }
        step();
    }

    void step() {
        if (ready_ && !on_way_ && !writing_) send();
        if (pending_ && !stop_) work();
    }

    void work() {
        working_ = std::move(*pending_);
        pending_.reset();
        stop_ = std::make_shared<StopFlag>();
        boost::asio::post(workers_, [self = shared_from_this()] {
            Response made = self->handler_({"/frame", self->working_.body, self->stop_});
            boost::asio::post(self->socket_.get_executor(),
                              [self, made = std::move(made)]() mutable { self->made(made); });
        });
    }

    void made(Response& made) {
        stop_.reset();
        if (gone_) return;
        const std::string text = "{\"id\":" + std::to_string(working_.id) +
                                 ",\"status\":" + std::to_string(made.status) + ",\"type\":\"" +
                                 made.type + "\",\"facts\":" +
                                 (made.facts.empty() ? "null" : made.facts) + "}";
        std::string head;
        for (int i = 0; i < 4; ++i) head += static_cast<char>(text.size() >> (8 * i) & 255U);
        ready_ = Picture{head + text, std::move(made.body)};
        step();
    }

    void send() {
        sent_ = std::move(*ready_);
        ready_.reset();
        on_way_ = writing_ = true;
        const std::array<boost::asio::const_buffer, 2> parts{boost::asio::buffer(sent_.head),
                                                             boost::asio::buffer(sent_.body)};
        socket_.async_write(parts, [self = shared_from_this()](
                                       const boost::system::error_code& error, std::size_t) {
            self->writing_ = false;
            if (!error && !self->gone_) self->step();
        });
    }

    void leave() {
        gone_ = true;
        pending_.reset();
        if (stop_) stop_->request();
    }

    boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
    boost::asio::io_context& workers_;
    const Handler& handler_;
    std::string text_;               ///< of the last message
    std::optional<Wish> pending_;    ///< the newest that nobody works at
    Wish working_;                   ///< in hand while there is `stop_`
    std::shared_ptr<StopFlag> stop_; ///< of the work in hand
    std::optional<Picture> ready_;   ///< made, and not sent
    Picture sent_;
    bool on_way_ = false, writing_ = false, gone_ = false;
};

}  // namespace alhazen::viewer

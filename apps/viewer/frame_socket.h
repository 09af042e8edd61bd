#pragma once
/// Serves frames and states over a WebSocket (RFC 6455): the newest request of a client, at most
/// one picture in transit, and the current state.
///
/// Conventions: messages are those of frame_protocol.h. The token comes first, within 5 s and 1
/// KiB; a wrong one closes the connection with 1008. A request replaces a pending one, and ends a
/// running one that is not `moving`; a stop ends both. The next picture is sent after the previous
/// one has arrived ("shown"); meanwhile another may be rendered, which a newer one replaces. States
/// are polled ten times a second unless one waits to be sent; they are sent when they change, and
/// each second as a sign of life. Memory for a client that does not read is therefore bounded: one
/// state and three pictures. Messages to the server have at most 1 MiB (1009); invalid messages
/// close the connection with 1007; a client that answers no ping for 5 s is disconnected.
/// Threads: everything runs in the strand of the stream, except the handler.
/// Included only by http_server.cpp.

#include <array>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <optional>

#include "frame_protocol.h"
#include "http_server.h"

namespace alhazen::viewer {

class FrameSocket : public std::enable_shared_from_this<FrameSocket> {
  public:
    using Handler = std::function<Response(const Request&)>;
    using HttpRequest = boost::beast::http::request<boost::beast::http::string_body>;

    /// `workers` runs the handler; the handler must outlive the socket.
    FrameSocket(boost::beast::tcp_stream stream, boost::asio::io_context& workers,
                const Handler& handler)
        : socket_(std::move(stream)),
          looks_(socket_.get_executor()),
          workers_(workers),
          handler_(handler) {}

    /// Serves until the client disconnects.
    boost::asio::awaitable<void> serve(const HttpRequest& request, const std::string& token) {
        namespace websocket = boost::beast::websocket;
        websocket::stream_base::timeout patience{std::chrono::seconds(5), std::chrono::seconds(5),
                                                 false};
        socket_.set_option(patience);
        socket_.read_message_max(kMostFirst);
        socket_.auto_fragment(false);
        // Synchronous on a non-blocking socket, which takes less time to compile than async_accept:
        // a full send buffer is an error and ends the connection.
        boost::beast::get_lowest_layer(socket_).socket().non_blocking(true);
        socket_.accept(request);
        if (!co_await knows(token)) co_return;
        patience.keep_alive_pings = true;  // a silent page stays connected
        socket_.set_option(patience);
        socket_.read_message_max(kMostMessage);
        look();
        try {
            for (;;) {
                const ClientMessage message = co_await next();
                if (message.kind == ClientMessage::Kind::Bad) break;
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
    using Clock = std::chrono::steady_clock;
    static constexpr std::size_t kMostFirst = 1024, kMostMessage = 1024 * 1024;
    static constexpr auto kLook = std::chrono::milliseconds(100);
    static constexpr auto kSignOfLife = std::chrono::seconds(1);
    struct Wish {
        std::int64_t id = 0;
        bool moving = false;
        std::string body;
    };
    struct Picture {
        std::string head, body;
    };

    /// True if the first message has the token. A timer limits the time: slow bytes count as
    /// activity.
    boost::asio::awaitable<bool> knows(const std::string& token) {
        boost::asio::steady_timer timer(socket_.get_executor(), std::chrono::seconds(5));
        timer.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
            if (!error) boost::beast::get_lowest_layer(self->socket_).close();
        });
        const ClientMessage first = co_await next();
        timer.cancel();
        if (first.kind == ClientMessage::Kind::Token && same_secret(first.token, token)) {
            co_return true;
        }
        co_await socket_.async_close(boost::beast::websocket::close_code::policy_error,
                                     boost::asio::use_awaitable);
        co_return false;
    }

    boost::asio::awaitable<ClientMessage> next() {
        boost::beast::flat_buffer buffer;
        (void)co_await socket_.async_read(buffer, boost::asio::use_awaitable);
        text_ = boost::beast::buffers_to_string(buffer.data());
        co_return client_message(text_);
    }

    void take(const ClientMessage& message) {
        if (message.kind == ClientMessage::Kind::Shown) on_way_ = false;
        if (message.kind == ClientMessage::Kind::Stop) {
            pending_.reset();
            if (stop_) stop_->request();
            (void)handler_({"/stop", text_, nullptr, {}});
        }
        if (message.kind == ClientMessage::Kind::Wish) {
            pending_ = Wish{message.id, message.moving, std::move(text_)};
            if (stop_ && !working_.moving) stop_->request();
        }
        step();
    }

    /// Polls the state now and periodically.
    void look() {
        if (gone_) return;
        if (!state_) say_state();
        looks_.expires_after(kLook);
        looks_.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
            if (!error) self->look();
        });
    }

    void say_state() {
        Response state = handler_({"/state", {}, nullptr, known_});
        if (state.body == last_state_ && Clock::now() - said_ < kSignOfLife) return;
        last_state_ = state.body;
        known_ = std::move(state.tag);
        said_ = Clock::now();
        state_ = std::move(state.body);
        step();
    }

    void step() {
        if (!writing_ && state_) {
            sent_ = {std::move(*state_), {}};
            state_.reset();
            send(false);
        }
        if (!writing_ && ready_ && !on_way_) {
            sent_ = std::move(*ready_);
            ready_.reset();
            on_way_ = true;
            send(true);
        }
        if (pending_ && !stop_) work();
    }

    void work() {
        working_ = std::move(*pending_);
        pending_.reset();
        stop_ = std::make_shared<StopFlag>();
        boost::asio::post(workers_, [self = shared_from_this()] {
            Response made = self->handler_({"/frame", self->working_.body, self->stop_, {}});
            boost::asio::post(self->socket_.get_executor(),
                              [self, made = std::move(made)]() mutable { self->made(made); });
        });
    }

    void made(Response& made) {
        stop_.reset();
        if (gone_) return;
        ready_ = Picture{picture_head(working_.id, made), std::move(made.body)};
        step();
    }

    void send(bool binary) {
        writing_ = true;
        socket_.binary(binary);
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
        looks_.cancel();
        if (stop_) stop_->request();
    }

    boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
    boost::asio::steady_timer looks_;
    boost::asio::io_context& workers_;
    const Handler& handler_;
    std::string text_;                  ///< last message
    std::optional<Wish> pending_;       ///< newest request, not started
    Wish working_;                      ///< running request, if there is `stop_`
    std::shared_ptr<StopFlag> stop_;    ///< stop flag of the running request
    std::optional<Picture> ready_;      ///< rendered, not yet sent
    std::optional<std::string> state_;  ///< to be sent
    std::string last_state_, known_;    ///< last state sent, and the tag that the client knows
    Clock::time_point said_{};          ///< time of the last state
    Picture sent_;
    bool on_way_ = false, writing_ = false, gone_ = false;
};

}  // namespace alhazen::viewer

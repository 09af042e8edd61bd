#include "http_server.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/status.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <optional>
#include <thread>

#include "alhazen/base/error.h"
#include "frame_socket.h"

namespace alhazen::viewer {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using tcp = asio::ip::tcp;

namespace {

constexpr int kMostClients = 8;
constexpr int kMostGuests = 4;  // further ones, which get the files of the page
constexpr std::string_view kFull =
    "This server has 8 clients at most, and each page is one: close another, then load this one "
    "again.\n";
constexpr auto kPatience = std::chrono::seconds(5);
constexpr std::uint32_t kMostHeader = 8 * 1024;
constexpr std::uint64_t kMostBody = 1024 * 1024;

using HttpRequest = http::request<http::string_body>;

/// Written as text, because Beast's serializer takes long to compile.
struct HttpResponse {
    int status = 200;
    std::string type, body;
    std::string facts = {};  ///< of the picture in `body`
};

std::string random_token() {
    std::array<unsigned char, 16> bytes{};
    if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
        throw Error(ErrorKind::Resource, "the system gives no random numbers for the token");
    }
    std::string text;
    for (const unsigned char b : bytes) text += fmt::format("{:02x}", b);
    return text;
}

asio::ip::address address_of(const std::string& text) {
    boost::system::error_code error;
    const asio::ip::address address = asio::ip::make_address(text, error);
    if (error || address.is_unspecified()) {
        throw Error(ErrorKind::Usage,
                    fmt::format("--serve '{}': expected the address of one interface, such as "
                                "127.0.0.1 or ::1",
                                text));
    }
    return address;
}

std::string_view view_of(beast::string_view s) {
    return {s.data(), s.size()};
}

}  // namespace

bool is_loopback(const std::string& address) {
    return address_of(address).is_loopback();
}

bool same_secret(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) return false;
    unsigned char different = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        different = static_cast<unsigned char>(different | (a[i] ^ b[i]));
    }
    return different == 0;
}

struct HttpServer::State {
    explicit State(ServerOptions given)
        : options(std::move(given)), token(random_token()), acceptor(io) {
        const asio::ip::address address = address_of(options.address);
        const tcp::endpoint end(address, options.port);
        boost::system::error_code error;
        const auto check = [&] {
            if (!error) return;
            throw Error(ErrorKind::File,
                        fmt::format("cannot listen at {}: {}", options.address, error.message()));
        };
        (void)acceptor.open(end.protocol(), error);
        check();
        // A given port can be used again as soon as the previous server has ended.
        (void)acceptor.set_option(tcp::acceptor::reuse_address(true), error);
        check();
        (void)acceptor.bind(end, error);
        check();
        (void)acceptor.listen(kMostClients, error);
        check();
        // The browser that is started must not inherit the port.
        (void)fcntl(acceptor.native_handle(), F_SETFD, FD_CLOEXEC);
        port = acceptor.local_endpoint().port();
        const std::string name = address.is_v6() ? "[" + options.address + "]" : options.address;
        hosts.push_back(fmt::format("{}:{}", name, port));
        if (address.is_loopback()) {
            for (const char* loopback : {"127.0.0.1", "localhost", "[::1]"}) {
                hosts.push_back(fmt::format("{}:{}", loopback, port));
            }
        }
    }

    ServerOptions options;
    std::string token;
    asio::io_context io;
    tcp::acceptor acceptor;
    std::uint16_t port = 0;
    std::vector<std::string> hosts;  ///< names of this server
    std::atomic<int> clients{0};

    [[nodiscard]] bool is_own_host(std::string_view host) const {
        return std::find(hosts.begin(), hosts.end(), host) != hosts.end();
    }

    static HttpResponse plain(int status, std::string text) {
        return {status, "text/plain; charset=utf-8", std::move(text)};
    }

    static bool is_upgrade(const HttpRequest& request) {
        return beast::websocket::is_upgrade(request) && request.target() == "/frames";
    }

    /// The response to a request for another server or from another page.
    [[nodiscard]] std::optional<HttpResponse> refusal(const HttpRequest& request) const {
        const std::string_view host = view_of(request[http::field::host]);
        if (!is_own_host(host) || request.count(http::field::host) != 1) {
            return plain(403, "this is not the server of that name\n");
        }
        const bool post = request.method() == http::verb::post;
        const std::string_view origin = view_of(request[http::field::origin]);
        const std::size_t origins = request.count(http::field::origin);
        const bool needs_origin = post || origins > 0 || is_upgrade(request);
        if (origins > 1 || (needs_origin && origin != "http://" + std::string(host))) {
            return plain(403, "requests of other pages are refused\n");
        }
        if (!post && request.method() != http::verb::get) {
            return plain(405, "expected GET or POST\n");
        }
        return std::nullopt;
    }

    /// The response to a request that is not refused.
    [[nodiscard]] HttpResponse answer(const HttpRequest& request) const {
        const bool post = request.method() == http::verb::post;
        const std::string path(view_of(request.target()));
        if (!post) return file(path);
        const std::string_view given = view_of(request[http::field::authorization]);
        if (!same_secret(given, "Bearer " + token)) return plain(401, "wrong token\n");
        Response made = options.handler({path, request.body(), nullptr, {}});
        return {made.status, made.type, std::move(made.body), made.facts};
    }

    [[nodiscard]] HttpResponse file(const std::string& path) const {
        for (const Asset& asset : options.assets) {
            if (asset.path == path) return {200, asset.type, std::string(asset.text)};
        }
        return plain(404, "there is no such file\n");
    }

    /// Exact addresses: 'self' would allow a WebSocket to any path. Policies have no addresses of
    /// IPv6 (Content Security Policy Level 3, host-part).
    static std::string connections(const std::string& host) {
        return host.front() == '[' ? "'self'" : "http://" + host + " ws://" + host + "/frames";
    }

    /// `host`: name by which the page calls this server; empty: the request is refused.
    static std::string text_of(const HttpResponse& response, bool keep, const std::string& host) {
        const std::string ways = host.empty() ? "'none'" : connections(host);
        const beast::string_view reason =
            http::obsolete_reason(http::int_to_status(static_cast<unsigned>(response.status)));
        std::string text = fmt::format("HTTP/1.1 {} {}\r\n", response.status, view_of(reason));
        const auto set = [&text](std::string_view name, std::string_view value) {
            text.append(name).append(": ").append(value).append("\r\n");
        };
        set("Content-Type", response.type);
        if (!response.facts.empty()) set("X-Alhazen", response.facts);
        if (!keep) set("Connection", "close");
        set("Content-Security-Policy",
            "default-src 'self'; connect-src " + ways +
                "; img-src 'self' blob: data:; base-uri 'none'; form-action 'none'; "
                "frame-ancestors 'none'");
        set("X-Content-Type-Options", "nosniff");
        set("Cross-Origin-Resource-Policy", "same-origin");
        set("Referrer-Policy", "no-referrer");
        set("Cache-Control", "no-store");
        set("Content-Length", std::to_string(response.body.size()));
        return text.append("\r\n").append(response.body);
    }

    asio::awaitable<void> send(beast::tcp_stream& stream, HttpResponse response, bool keep,
                               std::string host = {}) {
        const std::string text = text_of(response, keep, host);
        stream.expires_after(kPatience);
        co_await asio::async_write(stream, asio::buffer(text), asio::use_awaitable);
    }

    static int status_of(const boost::system::error_code& error) {
        if (error == http::error::body_limit) return 413;
        if (error == http::error::header_limit || error == http::error::buffer_overflow) return 431;
        return error.category() == http::make_error_code(http::error::bad_method).category() &&
                       error != http::error::end_of_stream && error != http::error::partial_message
                   ? 400
                   : 0;
    }

    /// `guest`: only the files of the page are served, once.
    asio::awaitable<void> serve(beast::tcp_stream stream, bool guest) {
        beast::flat_buffer buffer(kMostHeader + kMostBody);
        for (bool keep = true; keep;) {
            http::request_parser<http::string_body> parser;
            parser.header_limit(kMostHeader);
            parser.body_limit(kMostBody);
            stream.expires_after(kPatience);
            boost::system::error_code error;
            co_await http::async_read(stream, buffer, parser,
                                      asio::redirect_error(asio::use_awaitable, error));
            if (error) {
                const int status = status_of(error);
                if (status != 0) co_await send(stream, plain(status, error.message()), false);
                break;
            }
            stream.expires_never();
            const HttpRequest& request = parser.get();
            // The last place is given back at once, to the socket of the same page for example.
            keep = request.keep_alive() && clients.load() < kMostClients;
            std::optional<HttpResponse> refused = refusal(request);
            if (!refused && guest &&
                (request.method() == http::verb::post || is_upgrade(request))) {
                refused = plain(503, std::string(kFull));
            }
            if (!refused && is_upgrade(request)) {
                // A client that follows the protocol sends nothing before the response.
                if (buffer.size() > 0) break;
                const auto frames =
                    std::make_shared<FrameSocket>(std::move(stream), io, options.handler);
                co_await frames->serve(request, token);
                co_return;
            }
            // A named variable: GCC 12 miscompiles a conditional expression inside co_await.
            std::string host;
            if (!refused) {
                host = view_of(request[http::field::host]);
                refused = answer(request);
            }
            HttpResponse response = std::move(*refused);
            co_await send(stream, std::move(response), keep, std::move(host));
        }
        boost::system::error_code ignored;
        (void)stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
    }

    asio::awaitable<void> client(beast::tcp_stream stream) {
        struct Counted {
            std::atomic<int>& clients;
            ~Counted() { --clients; }
        } const counted{clients};
        try {
            const int count = clients.load();
            if (count > kMostClients + kMostGuests) {
                co_await send(stream, plain(503, std::string(kFull)), false);
            } else {
                co_await serve(std::move(stream), count > kMostClients);
            }
        } catch (const boost::system::system_error&) {
            // The client has disconnected or timed out.
        }
    }

    asio::awaitable<void> accept() {
        for (;;) {
            boost::system::error_code error;
            auto executor = asio::make_strand(io);
            tcp::socket socket(executor);
            co_await acceptor.async_accept(socket,
                                           asio::redirect_error(asio::use_awaitable, error));
            if (error == asio::error::operation_aborted) co_return;
            if (error) {  // no free descriptors, for example: wait for others to leave
                asio::steady_timer pause(io, std::chrono::milliseconds(50));
                co_await pause.async_wait(asio::use_awaitable);
                continue;
            }
            ++clients;
            asio::co_spawn(executor, client(beast::tcp_stream(std::move(socket))), asio::detached);
        }
    }
};

HttpServer::HttpServer(ServerOptions options)
    : state_(std::make_unique<State>(std::move(options))) {}
HttpServer::~HttpServer() = default;

std::uint16_t HttpServer::port() const {
    return state_->port;
}
const std::string& HttpServer::token() const {
    return state_->token;
}
std::string HttpServer::url() const {
    return fmt::format("http://{}/#{}", state_->hosts.front(), state_->token);
}

void HttpServer::run(const std::function<bool()>& ended) {
    asio::co_spawn(state_->io, state_->accept(), asio::detached);
    std::vector<std::jthread> threads;
    // One thread more than clients, which refuses the next client while all of them work.
    for (int i = 0; i < kMostClients + 1; ++i) threads.emplace_back([this] { state_->io.run(); });
    while (!ended()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    if (state_->options.close) state_->options.close();
    state_->io.stop();
}

}  // namespace alhazen::viewer

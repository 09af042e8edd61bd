#pragma once
/// A small HTTP server for a page on the same machine, closed to everybody else.
///
/// Conventions: of each request these are checked, in this order, and the first that fails answers:
/// size of header (8 KiB, 431) and body (1 MiB, 413), form (400); Host is this server (403: other
/// names that lead here are refused, which defeats DNS rebinding); Origin, where there is one, and
/// always for POST, is this server (403); method (405); for all but the files of the page the token
/// in Authorization (401). At most 8 clients (503); 5 s for a request to arrive, and between
/// requests. GET /frames is the way to a WebSocket (frame_socket.h), after the same checks with its
/// Origin; the policy of the page allows connections to that, and to this server, alone. Nothing is
/// read from the file system.
/// Threads: `run` serves every client by a thread; the handler is called from them.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/base/progress.h"

namespace alhazen::viewer {

/// A file of the page.
struct Asset {
    std::string path, type, text;
};

struct Request {
    std::string path;
    std::string_view body;
    std::shared_ptr<StopFlag> stop = nullptr;  ///< ends the work; null: a new request alone does
    std::string known;                         ///< Response::tag of what the client has of it
};
struct Response {
    int status = 200;
    std::string type = "application/json";
    std::string body;
    std::string facts;  ///< header X-Alhazen, JSON in one line; empty: none
    std::string tag;    ///< of what a later answer may leave out
};

struct ServerOptions {
    std::string address = "127.0.0.1";
    std::uint16_t port = 0;  ///< 0: any that is free
    std::vector<Asset> assets;
    /// Answers POST requests that are not refused.
    std::function<Response(const Request&)> handler;
    /// Called once when `run` is to end, so that requests in hand end soon.
    std::function<void()> close;
};

class HttpServer {
  public:
    /// Listens. Throws Error: Usage for an address that is none, File where it cannot listen.
    explicit HttpServer(ServerOptions options);
    ~HttpServer();

    [[nodiscard]] std::uint16_t port() const;
    /// 128 random bits, in hexadecimal digits.
    [[nodiscard]] const std::string& token() const;
    /// The address of the page; the token is behind #, which browsers do not send.
    [[nodiscard]] std::string url() const;
    /// Serves until `ended` says so.
    void run(const std::function<bool()>& ended);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Whether the address is of this machine alone.
[[nodiscard]] bool is_loopback(const std::string& address);

/// Compares in a time that depends on the lengths alone.
[[nodiscard]] bool same_secret(std::string_view a, std::string_view b);

}  // namespace alhazen::viewer

#pragma once
/// A small HTTP server for a page on the same machine, inaccessible to others.
///
/// Conventions: requests are checked in this order, and the first failed check determines the
/// status: size of header (8 KiB, 431) and body (1 MiB, 413), syntax (400); Host is this server
/// (403: refuses other names that resolve here, which defeats DNS rebinding); Origin, if present,
/// and always for POST, is this server (403); method (405); except for the files of the page, the
/// token in Authorization (401). At most 8 clients (503), the last of which is disconnected after a
/// response; four more get files of the page alone, so that it can say that the server is full; 5 s
/// for a request to arrive, and between requests. GET /frames opens a WebSocket (frame_socket.h)
/// after the same checks with its Origin; the policy of the page allows connections only to it and
/// to this server. Nothing is read from the file system.
/// Threads: `run` uses one thread per client; the handler is called from these threads.

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
    std::shared_ptr<StopFlag> stop = nullptr;  ///< ends the work; null: only a newer request does
    std::string known;                         ///< Response::tag of the client's current data
};
struct Response {
    int status = 200;
    std::string type = "application/json";
    std::string body;
    std::string facts;  ///< header X-Alhazen, JSON in one line; empty: none
    std::string tag;    ///< identifies data that a later response may omit
};

struct ServerOptions {
    std::string address = "127.0.0.1";
    std::uint16_t port = 0;  ///< 0: any free port
    std::vector<Asset> assets;
    /// Handles the POST requests that are not refused.
    std::function<Response(const Request&)> handler;
    /// Called once when `run` is about to end, so that running requests end soon.
    std::function<void()> close;
};

class HttpServer {
  public:
    /// Starts to listen. Throws Error: Usage for an invalid address, File if it cannot listen.
    explicit HttpServer(ServerOptions options);
    ~HttpServer();

    [[nodiscard]] std::uint16_t port() const;
    /// 128 random bits as hexadecimal digits.
    [[nodiscard]] const std::string& token() const;
    /// The address of the page; the token follows #, which browsers do not send.
    [[nodiscard]] std::string url() const;
    /// Serves until `ended` returns true.
    void run(const std::function<bool()>& ended);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// True if the address is reachable only from this machine.
[[nodiscard]] bool is_loopback(const std::string& address);

/// Compares in a time that depends only on the lengths.
[[nodiscard]] bool same_secret(std::string_view a, std::string_view b);

}  // namespace alhazen::viewer

#include <fmt/format.h>
#include <spawn.h>

#include <chrono>
#include <exception>
#include <filesystem>
#include <optional>

#include "../viewer/http_server.h"
#include "../viewer/redirect_file.h"
#include "../viewer/view_page.h"
#include "../viewer/view_session.h"
#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/base/heap.h"
#include "commands.h"
#include "messages.h"
#include "options.h"
#include "stop_signals.h"

extern char** environ;

namespace alhazen::cli {

namespace {

/// Time for pages to show why there is no scene before the server ends.
constexpr auto kLastWords = std::chrono::milliseconds(500);

struct ViewArguments {
    SceneArguments scene;
    std::string address = "127.0.0.1";
    int port = 0;
    bool allow_remote = false, no_open = false;
};

/// Opens a page in the user's browser, if there is one.
void open_in_browser(const std::filesystem::path& page) {
    std::string program = "xdg-open", address = page.string();
    char* arguments[] = {program.data(), address.data(), nullptr};
    pid_t child = 0;
    (void)posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ);
}

int run_view(ViewArguments& args) {
    if (!viewer::is_loopback(args.address) && !args.allow_remote) {
        throw Error(ErrorKind::Usage,
                    fmt::format("--serve {}: other machines could reach it; add --allow-remote if "
                                "that is wanted",
                                args.address));
    }
    use_one_heap();  // any thread renders the next frame
    viewer::ViewSession session(args.scene.scene, args.scene.load_options(), args.scene.threads);
    // Most errors are found at once; then no page is opened.
    session.scenes().wait_for_first(std::chrono::milliseconds(300));
    std::optional<viewer::RedirectFile> redirect;
    viewer::HttpServer server({.address = args.address,
                               .port = static_cast<std::uint16_t>(args.port),
                               .assets = viewer::view_page(),
                               .handler =
                                   [&](const viewer::Request& request) {
                                       if (redirect) redirect->remove();  // the page has its token
                                       return session.answer(request);
                                   },
                               .close = [&] { session.close(); }});
    print("{}\n", server.url());
    (void)std::fflush(stdout);
    // From here on a signal ends `run` and so removes the file.
    const StopFlag& stop = stop_on_signals();
    if (!args.no_open) {
        redirect.emplace(server.url());
        open_in_browser(redirect->path());
    }
    std::exception_ptr failure;
    std::chrono::steady_clock::time_point failed;
    server.run([&] {
        const auto now = std::chrono::steady_clock::now();
        if (!failure) {
            failure = session.scenes().failure();
            failed = now;
        }
        return stop.requested() || (failure && now - failed > kLastWords);
    });
    if (failure && !stop.requested()) std::rethrow_exception(failure);
    return kDone;
}

}  // namespace

void add_view(CLI::App& app, int& exit_status) {
    CLI::App* command = app.add_subcommand(
        "view",
        "Look at a scene in the browser: walk, switch renderers, click a pixel and see why");
    const auto args = std::make_shared<ViewArguments>();
    args->scene.add_to(*command, kDefaultAccelerator);
    command->add_option("--serve", args->address, "Address of this machine to listen at")
        ->capture_default_str()
        ->type_name("ADDRESS");
    command->add_option("--port", args->port, "Port to listen at; 0: any that is free")
        ->type_name("N")
        ->capture_default_str()
        ->check(CLI::Range(0, 65535));
    command->add_flag("--allow-remote", args->allow_remote,
                      "Allow an address that other machines reach; the way is not encrypted");
    command->add_flag("--no-open", args->no_open, "Only print the address of the page");
    command->callback([args, command, &exit_status] {
        if (args->allow_remote && command->count("--serve") == 0) {
            throw Error(ErrorKind::Usage, "--allow-remote needs --serve");
        }
        exit_status = run_view(*args);
    });
}

}  // namespace alhazen::cli

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/session/scene_info/info.h"
#include "commands.h"
#include "messages.h"
#include "options.h"

namespace alhazen::cli {

namespace {

using json = nlohmann::ordered_json;

}  // namespace

void add_info(CLI::App& app, int& exit_status) {
    struct Arguments {
        SceneArguments scene;
        bool json = false, all = false;
    };
    CLI::App* command = app.add_subcommand("info", "Say what is in a scene");
    const auto args = std::make_shared<Arguments>();
    args->scene.add_to(*command, kDefaultAccelerator);
    command->add_flag("--json", args->json, "Print JSON");
    command->add_flag("--all", args->all,
                      "Do not cut lists short; also look whether meshes of more than two million "
                      "triangles are closed");
    command->callback([args, &exit_status] {
        const LoadedScene loaded = load(args->scene.scene, args->scene.load_options());
        const json info = scene_info(args->scene.scene, loaded, {args->all});
        // Names come from the file: invalid UTF-8 is replaced, and non-ASCII characters (some
        // control terminals) are escaped.
        print("{}", args->json ? info.dump(2, ' ', true, json::error_handler_t::replace) + "\n"
                               : info_text(info, args->all));
        exit_status = kDone;
    });
}

}  // namespace alhazen::cli

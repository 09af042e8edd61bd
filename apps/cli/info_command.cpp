#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "alhazen/scene/accelerator_table.h"
#include "alhazen/session/info.h"
#include "commands.h"
#include "options.h"

namespace alhazen::cli {

void add_info(CLI::App& app, int& exit_status) {
    struct Arguments {
        SceneArguments scene;
        bool json = false;
    };
    CLI::App* command = app.add_subcommand("info", "Say what is in a scene");
    const auto args = std::make_shared<Arguments>();
    args->scene.add_to(*command, kDefaultAccelerator);
    command->add_flag("--json", args->json, "As JSON");
    command->callback([args, &exit_status] {
        const LoadedScene loaded = load(args->scene.scene, args->scene.load_options());
        const nlohmann::ordered_json info = scene_info(args->scene.scene, loaded);
        fmt::print("{}", args->json ? info.dump(2) + "\n" : info_text(info));
        exit_status = kDone;
    });
}

}  // namespace alhazen::cli

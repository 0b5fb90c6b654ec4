// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt_assets --out DIR: makes our own game data. Same program, same bytes, on every machine.
#include "tools/asset_generator/output.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <iostream>

using namespace vkpt::tools;

int main(int argc, char** argv)
{
    struct Subject {
        const char* name;
        void (*write)(const Output&);
    };
    constexpr std::array subjects {
        Subject { "base", write_palette_and_font },
        Subject { "pictures", write_pictures },
        Subject { "sky", write_sky },
        Subject { "models", write_weapon_models },
        Subject { "models", write_item_models },
        Subject { "models", write_player_models },
        Subject { "models", write_effect_models },
        Subject { "lights", write_light_models },
        Subject { "sounds", write_sounds },
        Subject { "textures", write_textures },
    };

    CLI::App app { "Makes the free game data: pictures, textures, sky, models and sounds." };
    std::string folder, only;
    app.add_option("--out", folder, "the game folder to fill, e.g. build/game/baseq2")->required();
    app.add_option("--only", only, "make one subject: base, pictures, textures, sky, models, lights or sounds");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        const Output out(folder);
        bool found = only.empty();
        for (const Subject& subject : subjects) {
            if (only.empty() || only == subject.name) {
                subject.write(out);
                found = true;
            }
        }
        if (!found) {
            std::cerr << "vkpt_assets: no subject is called '" << only << "'; see --help\n";
            return 2;
        }
    } catch (const std::exception& error) {
        std::cerr << "vkpt_assets: " << error.what() << '\n';
        return 1;
    }
    return 0;
}

// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/lights.hpp"

#include "ref_vkpt/files/output_folder.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <span>

namespace vkpt::game {

namespace {

constexpr size_t longest_history = 64;
constexpr float farthest_crosshair = 8192;
constexpr float spot_radius = 1; // its light has to fit into the shade

constexpr std::string_view light_usage
    = "light add [COLOUR] [VALUE] [RADIUS] [pulse|flicker|sputter] [spot DEGREES] [orbit "
      "RADIUS [SECONDS]], light set ..., light move|aim|copy|delete|grab|edit, light "
      "list|clear|undo, light save|load [NAME]";

const Edict& player_of(const Command& command)
{
    if (!command.player)
        throw TextError("nobody plays whose crosshair could say where");
    return *command.player;
}

float clearance(const Light& light) { return light.cone > 0 ? 4 : light.radius + 1; }

// Where the crosshair meets a wall, and away from it as far as the light needs.
glm::vec3 find_crosshair(const Host& host, const Edict& player, float away)
{
    const Eye eye = eye_of(player);
    const Trace hit = host.trace(eye.origin, eye.origin + eye.forward * farthest_crosshair, {}, &player, mask_solid);
    return to_vec3(hit.end) + to_vec3(hit.plane.normal) * away;
}

glm::vec3 angles_of(glm::vec3 direction)
{
    const float level = std::hypot(direction.x, direction.y);
    return { glm::degrees(std::atan2(-direction.z, level)), glm::degrees(std::atan2(direction.y, direction.x)), 0 };
}

int frame_of_cone(int degrees)
{
    size_t nearest = 0;
    for (size_t i = 1; i < formats::spot_cones.size(); i++)
        if (std::abs(formats::spot_cones[i] - degrees) < std::abs(formats::spot_cones[nearest] - degrees))
            nearest = i;
    return int(nearest);
}

// Engines go to the folder of saved games before they tell the game a file's name.
std::filesystem::path folder_of(const std::filesystem::path& file)
{
    return file.has_parent_path() ? file.parent_path() : ".";
}

std::string place_text(glm::vec3 p) { return fmt::format("{:.0f} {:.0f} {:.0f}", p.x, p.y, p.z); }

} // namespace

void Lights::run(const Command& command)
{
    const std::string verb = command.word(0);
    if (verb == "add")
        add(command);
    else if (verb == "list")
        list(command);
    else if (verb == "save")
        save(command);
    else if (verb == "load")
        load(command);
    else if (verb == "undo")
        undo(command);
    else if (verb == "grab")
        grab(command);
    else if (verb == "clear") {
        const size_t count = placed_.size();
        replace({});
        host_.say(command.sender, fmt::format("{} lights removed; light undo brings them back", count));
    } else if (verb == "edit") {
        is_editing_ = !is_editing_;
        for (Placed& placed : placed_)
            show(placed);
        host_.say(command.sender, is_editing_ ? "lights are shown" : "lights are hidden");
    } else if (verb == "move" || verb == "copy" || verb == "delete" || verb == "aim" || verb == "set") {
        const size_t which = find_aimed(command);
        std::vector<Light> lights = list_lights();
        Light light = lights[which];
        if (verb == "move" || verb == "copy")
            light.origin = find_crosshair(host_, *command.player, clearance(light));
        else if (verb == "aim")
            light.angles = angles_of(find_crosshair(host_, *command.player, 0) - light.origin);
        else if (verb == "set")
            parse_light_words(std::span(command.words).subspan(1), light);
        if (verb == "delete")
            lights.erase(lights.begin() + std::ptrdiff_t(which));
        else if (verb == "copy")
            lights.push_back(light);
        else
            lights[which] = light;
        replace(std::move(lights));
        host_.say(command.sender, fmt::format("{}: {} at {}", verb, describe_light(light), place_text(light.origin)));
    } else {
        throw TextError(std::string(light_usage));
    }
}

void Lights::add(const Command& command)
{
    Light light;
    parse_light_words(std::span(command.words).subspan(1), light);
    const Edict& player = player_of(command);
    const Eye eye = eye_of(player);
    light.origin = find_crosshair(host_, player, clearance(light));
    light.angles = angles_of(eye.origin - light.origin); // a spot looks back until it is aimed
    std::vector<Light> lights = list_lights();
    lights.push_back(light);
    replace(std::move(lights));
    host_.say(command.sender,
        fmt::format("light {}: {} at {}", placed_.size(), describe_light(light), place_text(light.origin)));
}

void Lights::list(const Command& command) const
{
    for (size_t i = 0; i < placed_.size(); i++)
        host_.say(command.sender,
            fmt::format(
                "{:3} at {}: {}", i + 1, place_text(placed_[i].light.origin), describe_light(placed_[i].light)));
    host_.say(command.sender, fmt::format("{} of {} lights", placed_.size(), max_lights));
}

TextFiles Lights::files() const
{
    if (host_.write_folder.empty())
        throw FileError("the engine's writable folder was not found");
    return TextFiles(host_.write_folder, "lights", std::string(light_file_mark));
}

void Lights::save(const Command& command) const
{
    const std::string name = command.words.size() > 1 ? command.words[1] : host_.map;
    files().write(name, write_light_file(list_lights(), host_.map));
    host_.say(command.sender, fmt::format("{} lights saved in {}", placed_.size(), files().describe(name)));
}

void Lights::load(const Command& command)
{
    const std::string name = command.words.size() > 1 ? command.words[1] : host_.map;
    replace(parse_light_file(files().read(name), files().describe(name)));
    host_.say(command.sender, fmt::format("{} lights loaded from {}", placed_.size(), files().describe(name)));
}

void Lights::grab(const Command& command)
{
    if (grabbed_ >= 0) {
        grabbed_ = -1;
        host_.say(command.sender, "let go");
        return;
    }
    remember();
    const size_t which = find_aimed(command);
    grabbed_ = int(which);
    grab_distance_ = glm::distance(eye_of(*command.player).origin, placed_[which].light.origin);
    host_.say(command.sender, "the light follows your view; light grab lets it go");
}

void Lights::undo(const Command& command)
{
    if (history_.empty())
        throw TextError("there is nothing to undo");
    std::vector<Light> lights = std::move(history_.back());
    history_.pop_back();
    replace(std::move(lights), false);
    host_.say(command.sender, fmt::format("{} lights", placed_.size()));
}

std::vector<Light> Lights::list_lights() const
{
    std::vector<Light> lights;
    for (const Placed& placed : placed_)
        lights.push_back(placed.light);
    return lights;
}

void Lights::remember()
{
    history_.push_back(list_lights());
    if (history_.size() > longest_history)
        history_.erase(history_.begin());
}

void Lights::replace(std::vector<Light> lights, bool with_undo)
{
    if (lights.size() > max_lights)
        throw TextError(fmt::format("there are {} lights already, as many as go: light delete", max_lights));
    if (with_undo)
        remember();
    grabbed_ = -1;
    while (placed_.size() > lights.size()) {
        if (placed_.back().entity >= 0)
            host_.entities.remove(placed_.back().entity);
        placed_.pop_back();
    }
    for (size_t i = 0; i < lights.size(); i++) {
        if (i == placed_.size())
            placed_.push_back({ lights[i], host_.entities.add() });
        else if (placed_[i].light == lights[i])
            continue;
        placed_[i].light = lights[i];
        show(placed_[i]);
    }
}

void Lights::show(Placed& placed)
{
    if (placed.entity < 0)
        return;
    const Light& light = placed.light;
    const bool is_spot = light.cone > 0;
    formats::CodedLight coded = code_light(light, uint32_t(placed.entity));
    if (is_spot)
        coded.radius = std::min(coded.radius, spot_radius);
    EntityState& state = host_.entities.state(placed.entity);
    const auto model = is_spot ? formats::LightModel::spot : formats::LightModel::bulb;
    state.model = host_.engine.model_index(std::string(formats::light_models[size_t(model)]).c_str());
    state.skin = formats::encode_light(coded);
    state.frame = is_spot ? frame_of_cone(light.cone) : 0;
    state.render_flags = is_editing_ ? RF_FULLBRIGHT : 0; // a bulb's marker shows with it
    put(light.angles, state.angles);
    put(light.origin, state.origin);
    put(light.origin, state.old_origin);
    // Its light may be in view where it is not itself.
    host_.entities.touch(placed.entity, std::max(1024.0f, light.value * 3));
}

size_t Lights::find_aimed(const Command& command) const
{
    const Eye eye = eye_of(player_of(command));
    if (placed_.empty())
        throw TextError("there are no lights; light add makes one");
    size_t best = 0;
    float best_cosine = -2;
    for (size_t i = 0; i < placed_.size(); i++) {
        const glm::vec3 to_light = placed_[i].light.origin - eye.origin;
        const float cosine = glm::dot(to_light, eye.forward) / std::max(glm::length(to_light), 1.0f);
        if (cosine > best_cosine) {
            best = i;
            best_cosine = cosine;
        }
    }
    return best;
}

void Lights::begin_level()
{
    placed_.clear();
    history_.clear();
    grabbed_ = -1;
    if (host_.write_folder.empty() || !files().exists(host_.map))
        return;
    try {
        replace(parse_light_file(files().read(host_.map), files().describe(host_.map)), false);
    } catch (const std::exception& error) {
        host_.say(nullptr, fmt::format("vkpt: no lights are loaded: {}", error.what()));
    }
}

void Lights::update(const Edict* viewer)
{
    if (grabbed_ >= 0 && viewer) {
        Placed& placed = placed_[size_t(grabbed_)];
        const Eye eye = eye_of(*viewer);
        placed.light.origin = eye.origin + eye.forward * grab_distance_;
        show(placed);
    }
    for (const Placed& placed : placed_) {
        if (placed.light.orbit_radius <= 0 || placed.entity < 0)
            continue;
        const float turn = glm::radians(360 * float(host_.frame) * frame_seconds / placed.light.orbit_seconds);
        EntityState& state = host_.entities.state(placed.entity);
        put(to_vec3(state.origin), state.old_origin);
        put(placed.light.origin + placed.light.orbit_radius * glm::vec3(std::cos(turn), std::sin(turn), 0),
            state.origin);
        host_.entities.touch(placed.entity, std::max(1024.0f, placed.light.value * 3));
    }
}

std::string Lights::own_file(const std::string& level_file) const
{
    return level_file.substr(0, level_file.rfind('.')) + ".lights.sav"; // the engine copies and removes *.sav
}

// No link is followed, and no file of somebody else's replaced, in the folder of saved games either.
void Lights::write_level(const std::string& file) const
{
    const std::filesystem::path path = own_file(file);
    const std::string text = write_light_file(list_lights(), host_.map);
    try {
        OutputFolder(folder_of(path), {})
            .write(path.filename().string(), std::as_bytes(std::span(text)), light_file_mark);
    } catch (const std::exception& error) {
        host_.say(nullptr, fmt::format("vkpt: the saved game has no lights: {}", error.what()));
    }
}

void Lights::read_level(const std::string& file)
{
    const std::filesystem::path path = own_file(file);
    std::error_code error_code;
    if (!std::filesystem::exists(std::filesystem::symlink_status(path, error_code)))
        return; // saved without this module
    try {
        const std::string text = OutputFolder(folder_of(path), {}).read(path.filename().string(), TextFiles::max_bytes);
        replace(parse_light_file(text, path.string()), false);
    } catch (const std::exception& error) {
        host_.say(nullptr, fmt::format("vkpt: the saved game's lights cannot be read: {}", error.what()));
    }
}

} // namespace vkpt::game

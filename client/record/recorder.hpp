// SPDX-License-Identifier: GPL-2.0-or-later
// What the recording module knows: the trace, the handles that the engine got, and which files that took.
#pragma once

#include "common/trace/trace_writer.hpp"
#include "formats/model.hpp"
#include "ref_vkpt/scene/texture_files.hpp"

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt {

// Answers the engine as ref_vkpt would with the same files, so that the engine goes on in the same way.
class Recorder {
public:
    explicit Recorder(const std::string& trace_path);

    void note_start(int width, int height);
    void write(trace::Call call);
    void begin_frame(float camera_separation);
    void end_frame();
    void write_view(const engine::RefDef& refdef);
    void finish();
    const trace::TraceTotals& totals() const { return writer_.totals(); }

    void begin_registration(std::string_view map);
    void* register_model(std::string_view name);
    void* register_skin(std::string_view name);
    void find_sky(std::string_view name);
    struct PictureSize {
        int width = -1, height = -1; // -1: there is none
    };
    PictureSize find_pic(std::string_view name);
    // What the engine gets for a picture: a handle that only differs from nullptr.
    static void* picture_handle(const PictureSize& size);

private:
    void note_settings();
    std::optional<std::vector<std::byte>> load_file(const std::string& path);
    bool is_usable_model(const std::string& name);
    bool note_replacement(const std::string& name);
    void number_skins(const std::vector<formats::Md2Model>& surfaces);
    uint32_t number_picture(std::string_view name, TextureUse use);
    static void* to_handle(uint32_t number);
    static uint32_t to_number(const void* handle);

    void write_start(bool with_drawings);

    trace::TraceWriter writer_;
    std::vector<trace::Call> start_; // of a frame that may be the first one with a view
    TextureFiles pictures_;
    bool retexturing_;
    std::set<std::string> noted_files_;
    std::map<std::string, std::string, std::less<>> settings_; // as last written
    std::string map_; // "maps/NAME.bsp"
    size_t brush_models_ = 0; // of the map
    std::map<std::string, uint32_t, std::less<>> models_;
    uint32_t model_count_ = 0, picture_count_ = 0;
    std::map<std::pair<TextureUse, std::string>, std::pair<uint32_t, PictureSize>> known_pictures_;
};

} // namespace vkpt

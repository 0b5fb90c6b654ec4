// SPDX-License-Identifier: GPL-2.0-or-later
// The pictures of an exported scene: what surfaces show, and the sky.
#pragma once

#include "client/analysis/linear_image.hpp"
#include "client/host/file_system.hpp"
#include "formats/image.hpp"
#include "ref_vkpt/extension.hpp"

#include <map>
#include <string>
#include <vector>

namespace vkpt::client {

// Reads the game's pictures as the module does.
class ScenePictures {
public:
    explicit ScenePictures(const FileSystem& files);

    // Finds every picture of the scene's materials and gives each a name in the exported folder.
    void add(const SceneContents& scene);

    struct Written {
        std::string name; // in the exported folder
        formats::Image image;
    };
    const std::vector<Written>& written() const { return written_; }
    // The exported name of a game's picture, empty: it is in no file.
    std::string name_of(const std::string& picture) const;
    // What could not be read.
    const std::vector<std::string>& notes() const { return notes_; }

    // Linear colours of the sky's cube before rotation and scale, equirectangular: the middle shows +x, a quarter to
    // the left +y, the top +z. Empty: there are no pictures of the sky.
    analysis::LinearImage sky(const SceneSky& sky, int width);

private:
    const formats::Image* find(const std::string& picture);

    const FileSystem& files_;
    formats::Palette palette_ {};
    std::map<std::string, formats::Image> images_; // by the game's path; empty ones could not be read
    std::map<std::string, std::string> names_;
    std::vector<Written> written_;
    std::vector<std::string> notes_;
};

} // namespace vkpt::client

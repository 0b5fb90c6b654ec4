// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/model.hpp"

namespace formats {

std::vector<Md2Model> read_mesh(Bytes file, std::string_view name)
{
    if (name.ends_with(".md3"))
        return read_md3(file, name);
    std::vector<Md2Model> meshes;
    meshes.push_back(read_md2(file, name));
    return meshes;
}

std::string replacement_of_mesh(std::string_view name)
{
    constexpr std::string_view ending = ".md2";
    if (!name.ends_with(ending))
        return {};
    return std::string(name.substr(0, name.size() - ending.size())) + ".md3";
}

} // namespace formats

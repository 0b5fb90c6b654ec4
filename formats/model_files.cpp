// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/model.hpp"
#include "formats/model_iqm.hpp"

namespace formats {

std::vector<Md2Model> read_mesh(Bytes file, std::string_view name)
{
    if (is_iqm(file) || name.ends_with(".iqm"))
        return read_iqm(file, name);
    if (name.ends_with(".md3"))
        return read_md3(file, name);
    std::vector<Md2Model> meshes;
    meshes.push_back(read_md2(file, name));
    return meshes;
}

std::vector<std::string> replacements_of_mesh(std::string_view name)
{
    constexpr std::string_view ending = ".md2";
    if (!name.ends_with(ending))
        return {};
    const std::string stem(name.substr(0, name.size() - ending.size()));
    return { stem + ".md3", stem + ".iqm" };
}

} // namespace formats

// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/asset_generator/output.hpp"

#include <fstream>
#include <stdexcept>

namespace vkpt::tools {

void Output::write(std::string_view path, formats::Bytes bytes) const
{
    const std::filesystem::path file = root_ / path;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    stream.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    stream.close();
    if (!stream)
        throw std::runtime_error("cannot write " + file.string() + ": is the disk full or the folder read-only?");
}

} // namespace vkpt::tools

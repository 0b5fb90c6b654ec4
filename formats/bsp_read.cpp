// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/bsp_convert.hpp"

#include <algorithm>
#include <cstring>

namespace formats {

using namespace bsp_disk;

namespace {

BspFormat read_format(ByteReader& reader)
{
    const auto found_ident = reader.read<Ident>();
    if (found_ident != ident && found_ident != extended_ident)
        reader.fail_at(0, "not a BSP file (no \"IBSP\" or \"QBSP\")");
    if (const auto found = reader.read<int32_t>(); found != version)
        reader.fail_at(4, "BSP version " + std::to_string(found) + "; Quake II's maps have version 38");
    return found_ident == extended_ident ? BspFormat::qbsp : BspFormat::ibsp;
}

Directory read_directory(ByteReader& reader)
{
    const auto directory = reader.read<Directory>();
    size_t total = 0;
    for (size_t lump = 0; lump < LumpCount; lump++) {
        const auto [offset, size] = directory[lump];
        if (size > 0 && (offset > reader.size() || size > reader.size() - offset))
            reader.fail_at(directory_at + lump * sizeof(LumpEntry),
                std::string("lump ") + lump_names[lump] + " reaches past the end of the file");
        total += size;
    }
    if (total > reader.size())
        reader.fail_at(
            directory_at, "its lumps hold " + std::to_string(total) + " bytes, more than the file: they overlap");
    return directory;
}

template <class T> std::vector<T> read_lump(ByteReader& reader, const Directory& directory, Lump lump)
{
    const auto [offset, size] = directory[lump];
    if (size == 0)
        return {};
    if (size % sizeof(T) != 0)
        reader.fail_at(offset,
            std::string("lump ") + lump_names[lump] + ": " + std::to_string(size) + " bytes are not a multiple of "
                + std::to_string(sizeof(T)));
    return reader.read_array<T>(offset, size / sizeof(T), lump_names[lump]);
}

std::string text_until_zero(const char* data, size_t size)
{
    return std::string(data, std::find(data, data + size, '\0'));
}

template <BspFormat format> void read_records(ByteReader& reader, const Directory& directory, Bsp& bsp)
{
    for_each_lump(bsp, [&]<class T>(Lump lump, std::vector<T>& records) {
        using Record = typename OnDisk<format, T>::Record;
        if constexpr (std::is_same_v<Record, T>) {
            records = read_lump<T>(reader, directory, lump);
        } else {
            const std::vector<Record> stored = read_lump<Record>(reader, directory, lump);
            records.resize(stored.size());
            for (size_t i = 0; i < stored.size(); i++)
                convert_record(stored[i], records[i]);
        }
    });
}

} // namespace

Bsp read_bsp(Bytes file, std::string_view name)
{
    ByteReader reader(file, name);
    Bsp bsp;
    bsp.name = name;
    bsp.file_size = file.size();
    bsp.format = read_format(reader);
    const Directory directory = read_directory(reader);
    const auto entity_text = read_lump<char>(reader, directory, Entities);
    bsp.entity_text = text_until_zero(entity_text.data(), entity_text.size());
    with_format(bsp.format, [&](auto format) { read_records<format.value>(reader, directory, bsp); });
    if (!bsp.visibility.empty()) {
        if (bsp.visibility.size() < sizeof(int32_t))
            reader.fail_at(directory[Visibility].offset, "lump visibility: too short for its cluster count");
        std::memcpy(&bsp.cluster_count, bsp.visibility.data(), sizeof(int32_t));
    }
    check(bsp, directory, name);
    return bsp;
}

} // namespace formats

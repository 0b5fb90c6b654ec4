// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/bsp_convert.hpp"
#include "formats/byte_writer.hpp"

namespace formats {

using namespace bsp_disk;

namespace {

class LumpWriter {
public:
    explicit LumpWriter(BspFormat format)
    {
        file_.write(format == BspFormat::qbsp ? extended_ident : ident);
        file_.write(version);
        file_.write(directory_);
    }

    template <class T> void add(Lump lump, const std::vector<T>& items)
    {
        file_.align(4);
        directory_[lump] = { uint32_t(file_.position()), uint32_t(items.size() * sizeof(T)) };
        file_.write_array(std::span<const T>(items));
    }

    std::vector<std::byte> finish()
    {
        file_.align(4);
        file_.patch(directory_at, directory_);
        return file_.take();
    }

private:
    ByteWriter file_;
    Directory directory_ {};
};

template <class Record, class T> std::vector<Record> convert_lump(Lump lump, const std::vector<T>& records)
{
    std::vector<Record> stored(records.size());
    for (size_t i = 0; i < records.size(); i++)
        try {
            convert_record(records[i], stored[i]);
        } catch (const DoesNotFit& number) {
            throw std::invalid_argument(std::string("lump ") + lump_names[lump] + ", record " + std::to_string(i) + ": "
                + number.what() + " does not fit into 16 bits; write the map as QBSP");
        }
    return stored;
}

template <BspFormat format> void write_records(LumpWriter& writer, const Bsp& bsp)
{
    for_each_lump(bsp, [&]<class T>(Lump lump, const std::vector<T>& records) {
        using Record = typename OnDisk<format, T>::Record;
        if constexpr (std::is_same_v<Record, T>)
            writer.add(lump, records);
        else
            writer.add(lump, convert_lump<Record>(lump, records));
    });
}

} // namespace

std::vector<std::byte> write_bsp(const Bsp& bsp)
{
    std::vector<char> entity_text(bsp.entity_text.begin(), bsp.entity_text.end());
    entity_text.push_back('\0');
    LumpWriter writer(bsp.format);
    writer.add(Entities, entity_text);
    with_format(bsp.format, [&](auto format) { write_records<format.value>(writer, bsp); });
    return writer.finish();
}

} // namespace formats

// SPDX-License-Identifier: GPL-2.0-or-later
// Traces as files: what is written is what is read, whole, cut off or damaged.
#include "common/trace/trace_reader.hpp"
#include "common/trace/trace_writer.hpp"
#include "common/trace/view_codec.hpp"
#include "tests/client/run_program.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace vkpt::tests {
namespace {

using namespace vkpt::trace;

template <class Record> bool same_bytes(const std::vector<Record>& a, const std::vector<Record>& b)
{
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Record)) == 0);
}

// Bit by bit: a NaN is equal to itself.
void expect_same(const View& a, const View& b)
{
    EXPECT_EQ(std::memcmp(&a.refdef, &b.refdef, offsetof(engine::RefDef, area_bits)), 0);
    ASSERT_EQ(a.entities.size(), b.entities.size());
    for (size_t i = 0; i < a.entities.size(); i++) {
        const engine::Entity &x = a.entities[i].entity, &y = b.entities[i].entity;
        EXPECT_EQ(
            std::memcmp(x.angles, y.angles, offsetof(engine::Entity, alpha) - offsetof(engine::Entity, angles)), 0);
        EXPECT_EQ(std::memcmp(&x.alpha, &y.alpha, sizeof x.alpha), 0);
        EXPECT_EQ(x.flags, y.flags);
        EXPECT_EQ(a.entities[i].model, b.entities[i].model);
        EXPECT_EQ(a.entities[i].skin, b.entities[i].skin);
    }
    EXPECT_TRUE(same_bytes(a.dlights, b.dlights));
    EXPECT_TRUE(same_bytes(a.particles, b.particles));
    EXPECT_EQ(a.has_lightstyles, b.has_lightstyles);
    EXPECT_EQ(a.has_area_bits, b.has_area_bits);
    if (a.has_lightstyles) {
        EXPECT_EQ(std::memcmp(a.lightstyles.data(), b.lightstyles.data(), sizeof a.lightstyles), 0);
    }
    if (a.has_area_bits) {
        EXPECT_EQ(a.area_bits, b.area_bits);
    }
}

// A game of sorts: things come, move, jump and go; now and then a number that is none.
class Game {
public:
    View next()
    {
        time_ += 1.0f / 60;
        View view;
        view.refdef.width = 640;
        view.refdef.fov_x = 90;
        view.refdef.time = time_;
        for (float& x : view.refdef.view_origin)
            x = uniform_(random_) * time_;
        change(entities_, engine::max_entities, [&] {
            View::Entity e {};
            e.model = 1 + random_() % 5;
            e.skin = random_() % 3;
            for (size_t i = 0; i < 3; i++) {
                e.entity.origin[i] = 1000 * uniform_(random_);
                e.entity.previous_origin[i] = e.entity.origin[i] - uniform_(random_);
                e.entity.angles[i] = 180 * uniform_(random_);
            }
            e.entity.frame = int32_t(random_() % 200);
            e.entity.previous_frame = int32_t(random_() % 200);
            e.entity.skin_number = int32_t(random_() % 256);
            e.entity.lightstyle = int32_t(random_() % 64);
            e.entity.alpha = uniform_(random_);
            e.entity.flags = int32_t(random_() % 0x1000000);
            return e;
        });
        for (View::Entity& e : entities_)
            e.entity.origin[0] += 3, e.entity.frame++, e.entity.backlerp = uniform_(random_);
        if (!entities_.empty() && random_() % 8 == 0)
            entities_.front().entity.alpha = std::numeric_limits<float>::quiet_NaN();
        change(particles_, 300, [&] {
            return engine::Particle { { uniform_(random_), 5, -3 }, int32_t(random_() % 4), 1 };
        });
        for (engine::Particle& p : particles_)
            p.origin[2] += time_, p.alpha -= 0.01f;
        view.entities = entities_;
        view.particles = particles_;
        view.dlights.resize(random_() % 4, { { 1, 2, 3 }, { 1, -1, time_ }, 200 });
        view.has_lightstyles = random_() % 5 != 0;
        styles_[random_() % styles_.size()] = { { time_, 1, 1 }, 2 + time_ };
        view.lightstyles = styles_;
        view.has_area_bits = random_() % 5 != 0;
        areas_[random_() % areas_.size()] = uint8_t(random_());
        view.area_bits = areas_;
        return view;
    }

private:
    template <class Thing, class Make> void change(std::vector<Thing>& things, size_t most, Make make)
    {
        std::erase_if(things, [&](const Thing&) { return random_() % 30 == 0; });
        for (size_t i = random_() % 5; i > 0 && things.size() < most; i--)
            things.insert(things.begin() + ptrdiff_t(random_() % (things.size() + 1)), make());
    }

    std::minstd_rand random_ { 7 };
    std::uniform_real_distribution<float> uniform_ { -1, 1 };
    float time_ = 0;
    std::vector<View::Entity> entities_;
    std::vector<engine::Particle> particles_;
    std::array<engine::Lightstyle, engine::max_lightstyles> styles_ {};
    std::array<uint8_t, max_area_bytes> areas_ {};
};

TEST(ViewCodec, GivesBackEveryBit)
{
    Game game;
    ViewCodec writing, reading;
    for (int i = 0; i < 200; i++) {
        SCOPED_TRACE(i);
        View view = game.next(), read;
        Encoder encoder;
        writing.code(encoder, view);
        const std::vector<std::byte> bytes = encoder.take();
        Decoder decoder(bytes, "view");
        reading.code(decoder, read);
        EXPECT_TRUE(decoder.is_at_end());
        expect_same(view, read);
    }
}

// What the engine interpolates is what the coding is made for: uniform motion costs about a byte a number.
TEST(ViewCodec, EvenMotionCostsAByteANumber)
{
    ViewCodec codec;
    View view;
    view.entities.resize(20);
    size_t bytes = 0;
    for (int i = 0; i < 20; i++) {
        for (size_t k = 0; k < view.entities.size(); k++)
            view.entities[k].entity.origin[0] = 600 + 20 * float(k) + 1.25f * float(i);
        Encoder encoder;
        codec.code(encoder, view);
        bytes = encoder.size();
    }
    EXPECT_LT(bytes, view.entities.size() * 20 + 60);
}

constexpr int sample_frames = 150; // more than one chunk

// A loading frame, a map, frames with HUD; a second map from frame 100 on.
std::vector<View> write_sample(const std::filesystem::path& path, bool finish = true)
{
    Game game;
    std::vector<View> views;
    TraceWriter writer(path);
    writer.write(make_call(CallKind::begin_frame));
    writer.write(make_call(CallKind::draw_fade));
    writer.write(make_call(CallKind::end_frame));
    writer.write(make_call(CallKind::begin_registration, "one"));
    writer.write(make_call(CallKind::register_model, "maps/one.bsp", { 1 }));
    writer.write(make_call(CallKind::end_registration));
    for (int i = 0; i < sample_frames; i++) {
        if (i == 100)
            writer.write(make_call(CallKind::begin_registration, "two"));
        writer.write(make_call(CallKind::begin_frame));
        views.push_back(game.next());
        writer.write(views.back());
        if (i == 50)
            writer.write(make_call(CallKind::register_skin, "skin.pcx", { 2 }));
        writer.write(make_call(CallKind::find_pic, "num_" + std::to_string(i % 10)));
        writer.write(make_call(CallKind::end_frame));
    }
    if (finish)
        writer.finish();
    return views;
}

TEST(Trace, AnyFrameInAnyOrder)
{
    const ScratchFolder folder;
    const std::vector<View> views = write_sample(folder.path() / "a.rtrace");
    TraceReader reader(folder.path() / "a.rtrace");
    EXPECT_EQ(reader.cut_at(), 0u);
    ASSERT_EQ(reader.frame_count(), size_t(sample_frames));
    EXPECT_EQ(reader.totals().frames, uint32_t(sample_frames) + 1);
    for (const int i : { 0, 149, 64, 63, 1, 50, 148, 2 }) {
        SCOPED_TRACE(i);
        const Frame& frame = reader.frame(size_t(i));
        ASSERT_EQ(frame.views.size(), 1u);
        expect_same(frame.views[0], views[size_t(i)]);
        ASSERT_EQ(frame.calls.size(), i == 50 ? 5u : 4u);
        EXPECT_EQ(frame.calls.front().kind, CallKind::begin_frame);
        EXPECT_EQ(frame.calls[frame.calls.size() - 2].name, "num_" + std::to_string(i % 10));
        EXPECT_EQ(reader.time(size_t(i)), views[size_t(i)].refdef.time);
    }
}

TEST(Trace, WhatLastsKnowsItsFrame)
{
    const ScratchFolder folder;
    write_sample(folder.path() / "a.rtrace");
    const TraceReader reader(folder.path() / "a.rtrace");
    const std::vector<LastingCall>& calls = reader.lasting_calls();
    ASSERT_EQ(calls.size(), 5u);
    EXPECT_EQ(calls[0].call.name, "one");
    EXPECT_EQ(calls[0].frame, 0u);
    EXPECT_FALSE(calls[0].is_inside);
    EXPECT_EQ(calls[1].call.numbers[0], 1);
    EXPECT_EQ(calls[3].call.name, "skin.pcx");
    EXPECT_EQ(calls[3].frame, 50u);
    EXPECT_TRUE(calls[3].is_inside);
    EXPECT_EQ(calls[4].call.name, "two");
    EXPECT_EQ(calls[4].frame, 100u);
    EXPECT_FALSE(calls[4].is_inside);
}

TEST(Trace, TheSameCallsMakeTheSameFile)
{
    const ScratchFolder folder;
    write_sample(folder.path() / "a.rtrace");
    write_sample(folder.path() / "b.rtrace");
    EXPECT_EQ(folder.read("a.rtrace"), folder.read("b.rtrace"));
}

TEST(Trace, CutFilePlaysUpToTheCut)
{
    const ScratchFolder folder;
    const std::vector<View> views = write_sample(folder.path() / "a.rtrace");
    const std::string whole = folder.read("a.rtrace");
    size_t most = 0;
    for (size_t length = sizeof(FileHeader); length < whole.size(); length += whole.size() / 61 + 1) {
        SCOPED_TRACE(length);
        folder.write("cut.rtrace", whole.substr(0, length));
        TraceReader reader(folder.path() / "cut.rtrace");
        EXPECT_NE(reader.cut_at(), 0u);
        EXPECT_GE(reader.frame_count(), most) << "a longer file holds more";
        most = reader.frame_count();
        if (most > 0)
            expect_same(reader.frame(most - 1).views[0], views[most - 1]);
    }
    EXPECT_GE(most, size_t(sample_frames) / 2);
}

TEST(Trace, DeadWriterLeavesWholeChunks)
{
    const ScratchFolder folder;
    write_sample(folder.path() / "a.rtrace", false);
    const TraceReader reader(folder.path() / "a.rtrace");
    EXPECT_NE(reader.cut_at(), 0u);
    EXPECT_GE(reader.frame_count(), 128u);
}

std::string error_of(const std::filesystem::path& path)
{
    try {
        const TraceReader reader(path);
    } catch (const std::exception& error) {
        return error.what();
    }
    return "(none)";
}

TEST(Trace, EveryDamagedByteIsFound)
{
    const ScratchFolder folder;
    write_sample(folder.path() / "a.rtrace");
    const std::string whole = folder.read("a.rtrace");
    for (size_t at = 0; at < whole.size(); at += at < 64 ? 1 : whole.size() / 97 + 1) {
        SCOPED_TRACE(at);
        std::string damaged = whole;
        damaged[at] = char(damaged[at] ^ 0x10);
        folder.write("damaged.rtrace", damaged);
        const std::string error = error_of(folder.path() / "damaged.rtrace");
        EXPECT_NE(error.find("damaged.rtrace"), std::string::npos) << error;
    }
    folder.write("long.rtrace", whole + "x");
    EXPECT_NE(error_of(folder.path() / "long.rtrace").find("more data"), std::string::npos);
}

template <class Header> std::string bytes_of(Header header)
{
    header.crc = header_crc(header);
    return { reinterpret_cast<const char*>(&header), sizeof header };
}

TEST(Trace, ForeignNewerAndLyingFilesAreRefused)
{
    const ScratchFolder folder;
    const auto path = folder.path() / "a.rtrace";
    EXPECT_NE(error_of(path).find("No such file"), std::string::npos) << error_of(path);
    folder.write("a.rtrace", "RIFF, which is something else altogether");
    EXPECT_NE(error_of(path).find("not a trace"), std::string::npos) << error_of(path);
    folder.write("a.rtrace", "");
    EXPECT_NE(error_of(path).find("not a trace"), std::string::npos) << error_of(path);
    FileHeader newer;
    newer.version = file_version + 1;
    folder.write("a.rtrace", bytes_of(newer));
    EXPECT_NE(error_of(path).find("newer"), std::string::npos) << error_of(path);
    ChunkHeader huge { tag_calls, 8, 0xfffffff0, 1, 0, 0 };
    folder.write("a.rtrace", bytes_of(FileHeader()) + bytes_of(huge) + "12345678");
    EXPECT_NE(error_of(path).find("impossible size"), std::string::npos) << error_of(path);
    ChunkHeader unknown { chunk_tag("WHAT"), 0, 0, 0, 0, 0 };
    folder.write("a.rtrace", bytes_of(FileHeader()) + bytes_of(unknown));
    EXPECT_NE(error_of(path).find("unknown type"), std::string::npos) << error_of(path);
}

std::string pack_chunk(const std::string& raw, uint32_t wrong_bits = 0)
{
    std::string packed(compressBound(uLong(raw.size())), '\0');
    uLongf size = uLong(packed.size());
    compress(
        reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(raw.data()), uLong(raw.size()));
    packed.resize(size);
    const ChunkHeader header { tag_calls, uint32_t(size), uint32_t(raw.size()), 0, crc_of(packed) ^ wrong_bits, 0 };
    return bytes_of(header) + packed;
}

std::string code_calls(std::initializer_list<Call> calls)
{
    Encoder encoder;
    CallCodec codec;
    for (Call call : calls)
        codec.code(encoder, call);
    const std::vector<std::byte> bytes = encoder.take();
    return { reinterpret_cast<const char*>(bytes.data()), bytes.size() };
}

// zlib's own sum, which is right here, would let it pass.
TEST(Trace, PayloadsOwnSumCounts)
{
    const ScratchFolder folder;
    const std::string raw = code_calls({ make_call(CallKind::draw_fade) });
    folder.write("a.rtrace", bytes_of(FileHeader()) + pack_chunk(raw));
    EXPECT_EQ(error_of(folder.path() / "a.rtrace"), "(none)");
    folder.write("a.rtrace", bytes_of(FileHeader()) + pack_chunk(raw, 0x10000));
    EXPECT_EQ(error_of(folder.path() / "a.rtrace"),
        (folder.path() / "a.rtrace").string() + ": at byte 16: the file is damaged here; record it again");
}

// A variable of the module's can name files to write.
TEST(Trace, OnlyRecordedSettingsAreTaken)
{
    const ScratchFolder folder;
    const auto error_with = [&](const std::string& name) {
        folder.write("a.rtrace",
            bytes_of(FileHeader())
                + pack_chunk(code_calls({ make_call(CallKind::setting, name), make_call(CallKind::draw_fade) })));
        return error_of(folder.path() / "a.rtrace");
    };
    for (const RecordedSetting& setting : recorded_settings)
        EXPECT_EQ(error_with(setting.name), "(none)");
    for (const char* name : { "pt_bench_json", "pt_capture_dir", "Hand", "hand ", "" }) {
        const std::string error = error_with(name);
        EXPECT_NE(error.find("a.rtrace, chunk at byte 16: at byte "), std::string::npos) << error;
        EXPECT_NE(error.find("a setting that no recorder writes"), std::string::npos) << error;
    }
}

// Sums that are right over contents that no recorder writes.
TEST(Trace, NonsenseWithARightSumIsRefused)
{
    const ScratchFolder folder;
    std::minstd_rand random(3);
    for (int round = 0; round < 300; round++) {
        std::vector<std::byte> raw(1 + random() % 200);
        for (std::byte& byte : raw)
            byte = std::byte(random() % 4 == 0 ? random() : random() % 24);
        std::vector<std::byte> packed(compressBound(uLong(raw.size())));
        uLongf size = uLong(packed.size());
        ASSERT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
                      uLong(raw.size())),
            Z_OK);
        packed.resize(size);
        const ChunkHeader header { tag_calls, uint32_t(size), uint32_t(raw.size()), 0, crc_of(packed), 0 };
        folder.write("a.rtrace",
            bytes_of(FileHeader()) + bytes_of(header)
                + std::string(reinterpret_cast<const char*>(packed.data()), size));
        try {
            TraceReader reader(folder.path() / "a.rtrace");
            for (size_t i = 0; i < reader.frame_count(); i++)
                reader.frame(i);
        } catch (const formats::FormatError& error) {
            EXPECT_NE(std::string(error.what()).find("a.rtrace"), std::string::npos);
        }
    }
}

} // namespace
} // namespace vkpt::tests

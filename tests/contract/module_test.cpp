// SPDX-License-Identifier: GPL-2.0-or-later
// Loads modules as the engine does, once per release: what GetRefAPI writes, and what it leaves alone.
#include "ref_vkpt/extension.hpp"
#include "tests/contract/mock_engine.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <new>
#include <set>
#include <sstream>

namespace vkpt::tests {
namespace {

constexpr std::byte guard { 0xa7 };
constexpr size_t slot_bytes = 512;

// Returned like the module's own class: through a pointer to the caller's slot, here a slot with room to see what is
// written.
struct Slot {
    std::array<std::byte, slot_bytes> bytes;
    Slot() = delete;
    Slot(const Slot&) = delete;
    ~Slot() { }
};
using GetSlot = Slot (*)(engine::Imports);

void return_into(void* slot, GetSlot get, const engine::Imports& imports) { new (slot) Slot(get(imports)); }
// Called through a volatile pointer, so that the compiler cannot drop the guard bytes as overwritten.
void (*volatile opaque_return_into)(void*, GetSlot, const engine::Imports&) = return_into;

class Module {
public:
    explicit Module(const char* path)
        : library_(dlopen(path, RTLD_NOW | RTLD_LOCAL))
    {
        if (!library_)
            throw std::runtime_error(dlerror());
    }
    ~Module() { dlclose(library_); }
    Module(const Module&) = delete;
    Module& operator=(const Module&) = delete;

    void* symbol(const char* name) const { return dlsym(library_, name); }
    std::array<std::byte, slot_bytes> get_ref_api(const MockEngine& mock) const
    {
        alignas(16) std::array<std::byte, slot_bytes> bytes;
        bytes.fill(guard);
        opaque_return_into(bytes.data(), reinterpret_cast<GetSlot>(symbol("GetRefAPI")), mock.imports());
        return bytes;
    }

private:
    void* library_;
};

struct Release {
    const char* version;
    int api;
    size_t bytes; // of its export struct, as its own renderers are compiled
};
constexpr Release releases[] = {
    { "8.00 x86_64 Linux", 5, 208 },
    { "8.10", 5, 208 },
    { "8.20 x86_64 Jan  1 2023 Linux", 5, 208 },
    { "8.30", 6, 216 },
    { "8.40", 7, 216 },
    { "8.50", 7, 216 },
    { "8.60", 7, 216 },
    { "8.61pre", 7, 216 },
    { "8.70 x86_64", 8, 224 },
};

int read_int(const std::array<std::byte, slot_bytes>& bytes, size_t offset)
{
    int value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

void (*read_function(const std::array<std::byte, slot_bytes>& bytes, size_t place))()
{
    void (*function)();
    std::memcpy(&function, bytes.data() + 8 + place * sizeof function, sizeof function);
    return function;
}

class EveryModule : public testing::TestWithParam<const char*> { };
INSTANTIATE_TEST_SUITE_P(Fake, EveryModule, testing::Values(FAKE_MODULE));
INSTANTIATE_TEST_SUITE_P(Record, EveryModule, testing::Values(RECORD_MODULE));
#ifdef REAL_MODULE
INSTANTIATE_TEST_SUITE_P(Real, EveryModule, testing::Values(REAL_MODULE));
#endif
// Those with a door for hosts of ours.
class HostedModule : public testing::TestWithParam<const char*> { };
INSTANTIATE_TEST_SUITE_P(Fake, HostedModule, testing::Values(FAKE_MODULE));
#ifdef REAL_MODULE
INSTANTIATE_TEST_SUITE_P(Real, HostedModule, testing::Values(REAL_MODULE));
#endif

TEST_P(EveryModule, WritesExactlyTheStructOfEachRelease)
{
    for (const Release& release : releases) {
        SCOPED_TRACE(release.version);
        const MockEngine mock(release.version);
        const Module module(GetParam());
        const auto bytes = module.get_ref_api(mock);
        EXPECT_EQ(read_int(bytes, 0), release.api);
        EXPECT_EQ(mock.restart, int(engine::Restart::none));
        if (release.api >= 7) {
            EXPECT_EQ(read_int(bytes, 4), 2) << "no SDL3 in this process";
        }
        const size_t functions = (release.bytes - 8) / sizeof(void*);
        for (size_t place = 0; place < functions; place++)
            EXPECT_NE(read_function(bytes, place), nullptr) << "function " << place;
        const auto rest = std::find_if(
            bytes.begin() + ptrdiff_t(release.bytes), bytes.end(), [](std::byte b) { return b != guard; });
        EXPECT_EQ(rest - bytes.begin(), ptrdiff_t(slot_bytes)) << "written behind the end";
        // A later pointer is not only non-null but ours: all of them differ.
        std::set<void (*)()> distinct;
        for (size_t place = 0; place < functions; place++)
            distinct.insert(read_function(bytes, place));
        EXPECT_EQ(distinct.size(), functions);
    }
}

TEST_P(EveryModule, WritesOnlyTheCommonPartForAnUnknownEngine)
{
    for (const char* version : { "", "garbage", "7.45 x86_64", "9.00", "8", "8.", "-8.20", "8.x" }) {
        SCOPED_TRACE(version);
        const MockEngine mock(version);
        const Module module(GetParam());
        const auto bytes = module.get_ref_api(mock);
        EXPECT_EQ(read_int(bytes, 0), 0);
        EXPECT_NE(read_function(bytes, 0), nullptr);
        EXPECT_NE(read_function(bytes, 1), nullptr);
        const auto rest = std::find_if(bytes.begin() + 24, bytes.end(), [](std::byte b) { return b != guard; });
        EXPECT_EQ(rest - bytes.begin(), ptrdiff_t(slot_bytes)) << "written behind the common part";
        ASSERT_EQ(mock.console.size(), 1u);
        EXPECT_NE(mock.console[0].find("version"), std::string::npos) << mock.console[0];
    }
}

TEST_P(EveryModule, ShowsItsDoorsOnly)
{
    const std::string command = std::string("nm -D --defined-only '") + GetParam() + "'";
    std::string output;
    FILE* pipe = popen(command.c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    for (char buffer[4096]; size_t count = std::fread(buffer, 1, sizeof buffer, pipe);)
        output.append(buffer, count);
    ASSERT_EQ(pclose(pipe), 0) << command;
    std::set<std::string> names;
    std::istringstream lines(output);
    for (std::string line; std::getline(lines, line);)
        names.insert(line.substr(line.rfind(' ') + 1));
    names.erase("vkpt_extension"); // of those that have it
    EXPECT_EQ(names, (std::set<std::string> { "GetRefAPI" })) << output;
}

TEST_P(HostedModule, ServesOneExtensionVersion)
{
    const Module module(GetParam());
    const auto get = reinterpret_cast<GetExtension>(module.symbol("vkpt_extension"));
    ASSERT_NE(get, nullptr);
    const Extension* extension = get(extension_version);
    ASSERT_NE(extension, nullptr);
    EXPECT_EQ(extension->version, extension_version);
    EXPECT_EQ(extension->struct_size, sizeof(Extension));
    EXPECT_EQ(get(extension_version + 1), nullptr);
    EXPECT_EQ(get(0), nullptr);
}

} // namespace
} // namespace vkpt::tests

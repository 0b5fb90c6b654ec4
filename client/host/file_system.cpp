// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/file_system.hpp"

#include "client/host/errors.hpp"
#include "client/host/hash.hpp"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <physfs.h>

namespace vkpt::client {

namespace fs = std::filesystem;

namespace {

std::string lower_case(std::string_view text)
{
    std::string lower(text);
    for (char& c : lower)
        c = c >= 'A' && c <= 'Z' ? char(c + ('a' - 'A')) : c == '\\' ? '/' : c;
    return lower;
}

std::string index_key(std::string_view game_path)
{
    std::string key = lower_case(game_path);
    key.erase(0, std::min(key.find_first_not_of('/'), key.size()));
    return key;
}

const char* last_error() { return PHYSFS_getErrorByCode(PHYSFS_getLastErrorCode()); }

std::vector<fs::path> usual_places()
{
    std::error_code ignored;
    std::vector<fs::path> places;
    if (const char* named = std::getenv("VKPT_BASEDIR"))
        places.emplace_back(named);
    places.emplace_back(".");
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    places.push_back(program);
    places.push_back(program.parent_path());
    if (const char* home = std::getenv("HOME"))
        places.push_back(fs::path(home) / ".yq2");
    places.emplace_back("/usr/share/games/quake2");
    return places;
}

fs::path find_base()
{
    std::error_code ignored;
    std::string looked;
    for (const fs::path& place : usual_places()) {
        if (fs::is_directory(place / "baseq2", ignored))
            return place;
        looked += "\n  " + (place / "baseq2").string();
    }
    throw Failure(
        "no game data found; looked for" + looked + "\nName the folder that holds \"baseq2\" with --basedir DIR.");
}

bool is_archive(const fs::path& file)
{
    static constexpr std::string_view endings[] = { ".pak", ".pk2", ".pk3", ".zip", ".pkz" };
    return std::ranges::find(endings, lower_case(file.extension().string())) != std::end(endings);
}

// pak0.pak .. pak9.pak: these come below all other archives.
bool is_numbered(const fs::path& file)
{
    const std::string name = lower_case(file.filename().string());
    return name.size() == 8 && name.starts_with("pak") && name[3] >= '0' && name[3] <= '9' && name.ends_with(".pak");
}

// Strongest first.
std::vector<fs::path> find_archives(const fs::path& folder)
{
    std::vector<fs::path> archives;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && is_archive(entry.path()))
            archives.push_back(entry.path());
    std::ranges::sort(archives, [](const fs::path& a, const fs::path& b) {
        return is_numbered(a) != is_numbered(b) ? is_numbered(b) : lower_case(a.string()) > lower_case(b.string());
    });
    return archives;
}

} // namespace

FileSystem::FileSystem(const fs::path& base, const std::string& game)
{
    if (!PHYSFS_init(nullptr))
        throw Failure(fmt::format("cannot start PhysicsFS: {}", last_error()));
    try {
        PHYSFS_permitSymbolicLinks(1);
        base_folder_ = base.empty() ? find_base() : base;
        if (!game.empty() && game != "baseq2")
            mount(base_folder_ / game);
        mount(base_folder_ / "baseq2");
        index_files();
    } catch (...) {
        PHYSFS_deinit();
        throw;
    }
}

FileSystem::~FileSystem() { PHYSFS_deinit(); }

void FileSystem::mount(const fs::path& folder)
{
    if (!fs::is_directory(folder))
        throw Failure(fmt::format(
            "no folder {}: name the folder that holds \"baseq2\" (and the game) with --basedir DIR", folder.string()));
    std::vector<fs::path> places = find_archives(folder);
    places.push_back(folder);
    for (const fs::path& place : places) {
        if (!PHYSFS_mount(place.c_str(), nullptr, 1))
            throw Failure(fmt::format("cannot read {}: {}", place.string(), last_error()));
        search_path_.push_back(place.string());
    }
}

void FileSystem::index_files()
{
    const auto rank = [&](const std::string& path) {
        const char* place = PHYSFS_getRealDir(path.c_str());
        return std::ranges::find(search_path_, place ? place : "") - search_path_.begin();
    };
    std::vector<std::string> folders = { "" };
    while (!folders.empty()) {
        const std::string folder = std::move(folders.back());
        folders.pop_back();
        char** const names = PHYSFS_enumerateFiles(folder.c_str());
        for (char** name = names; name && *name; name++) {
            std::string path = folder.empty() ? *name : folder + "/" + *name;
            PHYSFS_Stat stat;
            if (!PHYSFS_stat(path.c_str(), &stat))
                continue;
            if (stat.filetype == PHYSFS_FILETYPE_DIRECTORY) {
                folders.push_back(std::move(path));
                continue;
            }
            std::string& known = index_[lower_case(path)];
            if (known.empty() || rank(path) < rank(known))
                known = std::move(path);
        }
        PHYSFS_freeList(names);
    }
}

void FileSystem::add_file(std::string_view game_path, const fs::path& file) { added_[index_key(game_path)] = file; }

bool FileSystem::exists(std::string_view game_path) const
{
    const std::string key = index_key(game_path);
    return added_.contains(key) || index_.contains(key);
}

std::optional<std::vector<std::byte>> FileSystem::read(std::string_view game_path) const
{
    std::string key = index_key(game_path);
    auto bytes = read_bytes(key, game_path);
    const uint64_t hash = bytes ? hash_bytes(*bytes, hash_bytes(std::as_bytes(std::span(key)))) : 0;
    read_.insert_or_assign(std::move(key), hash);
    return bytes;
}

uint64_t FileSystem::content_hash() const
{
    uint64_t hash = hash_start;
    for (const auto& [key, file] : read_)
        hash = hash_bytes(std::as_bytes(std::span(&file, 1)), hash);
    return hash;
}

std::optional<std::vector<std::byte>> FileSystem::read_bytes(const std::string& key, std::string_view game_path) const
{
    if (const auto added = added_.find(key); added != added_.end()) {
        std::ifstream stream(added->second, std::ios::binary);
        if (!stream)
            return std::nullopt;
        const std::string text { std::istreambuf_iterator<char>(stream), {} };
        const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
        return std::vector<std::byte>(bytes, bytes + text.size());
    }
    const auto found = index_.find(key);
    PHYSFS_File* file = found == index_.end() ? nullptr : PHYSFS_openRead(found->second.c_str());
    if (!file)
        return std::nullopt;
    const PHYSFS_sint64 size = PHYSFS_fileLength(file);
    std::vector<std::byte> bytes(size > 0 ? size_t(size) : 0);
    const PHYSFS_sint64 got = PHYSFS_readBytes(file, bytes.data(), bytes.size());
    PHYSFS_close(file);
    if (got != PHYSFS_sint64(bytes.size()))
        throw Failure(
            fmt::format("cannot read {} in {}: {}", game_path, PHYSFS_getRealDir(found->second.c_str()), last_error()));
    return bytes;
}

std::vector<std::string> FileSystem::list(std::string_view folder, std::string_view ending) const
{
    const std::string prefix = index_key(folder) + "/";
    std::vector<std::string> files;
    for (const auto& [key, path] : index_)
        if (key.starts_with(prefix) && key.ends_with(ending))
            files.push_back(path);
    return files;
}

} // namespace vkpt::client

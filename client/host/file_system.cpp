// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/host/file_system.hpp"

#include "client/host/archive_check.hpp"
#include "client/host/errors.hpp"
#include "common/hash.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <memory>
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

// What a file of an archive may unpack to: any archive 64 MB, which holds the largest textures and maps; more only in
// proportion to the archive, as a file of zeros packs to a thousandth.
constexpr size_t max_unpacked_bytes = size_t(64) << 20, max_unpacked_ratio = 8;
// Folders within folders, against links that lead round in circles. The engine's names have 128 bytes.
constexpr size_t max_folder_depth = 32, max_folders = 100000;

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
    places.push_back(program.parent_path() / "share/games/ref-vkpt"); // the package's free game
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
        "no game data found; looked for" + looked + "\nName the folder that contains \"baseq2\" with --basedir DIR.");
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

FileSystem::FileSystem(const fs::path& base, const std::string& game, Warn warn)
    : warn_(std::move(warn))
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
        throw Failure(
            fmt::format("no folder {}: name the folder that contains \"baseq2\" (and the game) with --basedir DIR",
                folder.string()));
    for (const fs::path& archive : find_archives(folder))
        mount_archive(archive);
    mount_place(folder);
}

void FileSystem::mount_archive(const fs::path& archive)
{
    try {
        if (const std::string fault = find_archive_fault(archive); !fault.empty())
            throw Failure(fault);
        mount_place(archive);
    } catch (const Failure& failure) {
        warn_(fmt::format("{} is left out: {}; download it again, or move it out of the game's folder",
            archive.string(), failure.what()));
    }
}

void FileSystem::mount_place(const fs::path& place)
{
    if (!PHYSFS_mount(place.c_str(), nullptr, 1))
        throw Failure(fmt::format("cannot read {}: {}", place.string(), last_error()));
    search_path_.push_back(place.string());
}

namespace {

// Whether the folder of a link lies within the one that it leads to.
bool leads_back(const fs::path& link)
{
    std::error_code error;
    const fs::path target = fs::canonical(link, error), home = fs::canonical(link.parent_path(), error);
    return error || std::ranges::mismatch(target, home).in1 == target.end();
}

// PhysicsFS tells links as links, wherever they lead.
bool is_folder(const std::string& path, const PHYSFS_Stat& stat)
{
    if (stat.filetype != PHYSFS_FILETYPE_SYMLINK)
        return stat.filetype == PHYSFS_FILETYPE_DIRECTORY;
    const char* place = PHYSFS_getRealDir(path.c_str());
    std::error_code ignored;
    return place && fs::is_directory(fs::path(place) / path, ignored);
}

bool is_worth_entering(const std::string& path, const PHYSFS_Stat& stat)
{
    const char* place = PHYSFS_getRealDir(path.c_str());
    return size_t(std::ranges::count(path, '/')) < max_folder_depth
        && !(stat.filetype == PHYSFS_FILETYPE_SYMLINK && place && leads_back(fs::path(place) / path));
}

} // namespace

void FileSystem::index_files()
{
    const auto rank = [&](const std::string& path) {
        const char* place = PHYSFS_getRealDir(path.c_str());
        return std::ranges::find(search_path_, place ? place : "") - search_path_.begin();
    };
    std::vector<std::string> folders = { "" };
    size_t entered = 0;
    while (!folders.empty()) {
        const std::string folder = std::move(folders.back());
        folders.pop_back();
        if (++entered > max_folders) {
            warn_(fmt::format("only the first {} folders of {} are searched: do links form a loop?", max_folders,
                base_folder_.string()));
            return;
        }
        for (const std::string& name : names_in(folder)) {
            std::string path = folder.empty() ? name : folder + "/" + name;
            PHYSFS_Stat stat;
            if (!PHYSFS_stat(path.c_str(), &stat))
                continue;
            if (is_folder(path, stat)) {
                if (is_worth_entering(path, stat))
                    folders.push_back(std::move(path));
                continue;
            }
            std::string& known = index_[lower_case(path)];
            if (known.empty() || rank(path) < rank(known))
                known = std::move(path);
        }
    }
}

// PhysicsFS opens files behind a link to a folder, but does not list them.
std::set<std::string> FileSystem::names_in(const std::string& folder) const
{
    std::set<std::string> names;
    char** const listed = PHYSFS_enumerateFiles(folder.c_str());
    for (char** name = listed; name && *name; name++)
        names.insert(*name);
    PHYSFS_freeList(listed);
    std::error_code ignored;
    for (const std::string& place : search_path_) {
        const fs::path path = fs::path(place) / folder;
        if (!folder.empty() && fs::is_symlink(path, ignored) && fs::is_directory(path, ignored) && !leads_back(path))
            for (const fs::directory_entry& entry : fs::directory_iterator(path, ignored))
                names.insert(entry.path().filename().string());
    }
    return names;
}

void FileSystem::add_file(std::string_view game_path, const fs::path& file) { added_[index_key(game_path)] = file; }

bool FileSystem::exists(std::string_view game_path) const
{
    const std::string key = index_key(game_path);
    return added_.contains(key) || index_.contains(key);
}

std::optional<uint64_t> FileSystem::size(std::string_view game_path) const
{
    const std::string key = index_key(game_path);
    if (const auto added = added_.find(key); added != added_.end()) {
        std::error_code error;
        const uintmax_t bytes = fs::file_size(added->second, error);
        return error ? std::nullopt : std::optional<uint64_t>(bytes);
    }
    const auto found = index_.find(key);
    PHYSFS_Stat stat;
    if (found == index_.end() || !PHYSFS_stat(found->second.c_str(), &stat))
        return std::nullopt;
    return uint64_t(std::max<PHYSFS_sint64>(stat.filesize, 0));
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
    return found == index_.end() ? std::nullopt : read_mounted(found->second, game_path);
}

// Piece by piece: the size that an archive tells may be a lie.
std::optional<std::vector<std::byte>> FileSystem::read_mounted(
    const std::string& path, std::string_view game_path) const
{
    const std::unique_ptr<PHYSFS_File, decltype(&PHYSFS_close)> file(PHYSFS_openRead(path.c_str()), PHYSFS_close);
    if (!file)
        return std::nullopt;
    const char* place = PHYSFS_getRealDir(path.c_str());
    const auto refuse = [&](const std::string& why) {
        warn_(fmt::format("{} in {} is not read: {}", game_path, place ? place : "?", why));
        return std::nullopt;
    };
    const PHYSFS_sint64 size = PHYSFS_fileLength(file.get());
    std::error_code no_file;
    const uintmax_t archive_bytes = place && !fs::is_directory(place, no_file) ? fs::file_size(place, no_file) : 0;
    if (archive_bytes && !no_file
        && size > PHYSFS_sint64(std::max(max_unpacked_bytes, archive_bytes * max_unpacked_ratio)))
        return refuse(fmt::format("its directory claims {} bytes, but the archive has {}", size, archive_bytes));
    constexpr size_t piece_bytes = size_t(1) << 20;
    std::vector<std::byte> bytes;
    for (size_t done = 0; PHYSFS_sint64(done) < size;) {
        const size_t wanted = std::min(piece_bytes, size_t(size) - done);
        bytes.resize(done + wanted);
        if (PHYSFS_readBytes(file.get(), bytes.data() + done, wanted) != PHYSFS_sint64(wanted))
            return refuse(
                fmt::format("it ends before the {} bytes that its directory claims ({})", size, last_error()));
        done += wanted;
    }
    return bytes;
}

void FileSystem::warn_on_stderr(const std::string& line) { std::fprintf(stderr, "vkpt: warning: %s\n", line.c_str()); }

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

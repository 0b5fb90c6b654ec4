// SPDX-License-Identifier: GPL-2.0-or-later
// The game's files as the engine finds them: the game's folder over baseq2, in each the archives over the loose files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt::client {

class FileSystem {
public:
    // base: the folder that holds "baseq2", empty: the first of the usual places that does. game: a folder beside
    // baseq2, empty: none. One FileSystem at a time. Throws Failure where no such folder is. A damaged archive is left
    // out, and `warn` gets a line that names it.
    using Warn = std::function<void(const std::string& line)>;
    FileSystem(const std::filesystem::path& base, const std::string& game, Warn warn = warn_on_stderr);
    ~FileSystem();
    FileSystem(const FileSystem&) = delete;
    FileSystem& operator=(const FileSystem&) = delete;

    // Makes a file on the disk appear under a game path, over everything else.
    void add_file(std::string_view game_path, const std::filesystem::path& file);

    // Paths do not mind case, as in archives.
    bool exists(std::string_view game_path) const;
    // As the folder or archive tells it, without reading; nothing: no such file.
    std::optional<uint64_t> size(std::string_view game_path) const;
    // Nothing, and a line for `warn`: a file of an archive that is damaged, or unpacks to much more than the archive
    // holds.
    std::optional<std::vector<std::byte>> read(std::string_view game_path) const;
    // Files in `folder` with this ending, sorted.
    std::vector<std::string> list(std::string_view folder, std::string_view ending) const;

    const std::filesystem::path& base_folder() const { return base_folder_; }
    // Of names and bytes of everything that has been read so far, in whatever order: what a picture of it depends on.
    uint64_t content_hash() const;

    // What is searched, first one first: for messages.
    const std::vector<std::string>& search_path() const { return search_path_; }

private:
    static void warn_on_stderr(const std::string& line);
    void mount(const std::filesystem::path& folder);
    void mount_archive(const std::filesystem::path& archive);
    void mount_place(const std::filesystem::path& place);
    void index_files();
    std::set<std::string> names_in(const std::string& folder) const;
    std::optional<std::vector<std::byte>> read_mounted(const std::string& path, std::string_view game_path) const;
    std::optional<std::vector<std::byte>> read_bytes(const std::string& key, std::string_view game_path) const;

    Warn warn_;
    std::filesystem::path base_folder_;
    std::vector<std::string> search_path_;
    std::map<std::string, std::string, std::less<>> index_; // lower case -> as written
    std::map<std::string, std::filesystem::path, std::less<>> added_; // lower case -> on the disk
    mutable std::map<std::string, uint64_t, std::less<>> read_; // lower case -> hash
};

} // namespace vkpt::client

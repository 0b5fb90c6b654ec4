// SPDX-License-Identifier: GPL-2.0-or-later
// Files that the module writes into the engine's game folder. Servers put files there, too, and can run console
// commands: so all goes into folders of the module's own, and never over a file of somebody else's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace vkpt {

// Says which file or folder, and why.
class FileError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// Letters, digits, "_" and "-", at most 64 of them: what players may call files and folders.
bool is_plain_name(std::string_view name);

inline constexpr uint64_t mebibyte = 1 << 20;

// For files that the player asks for: `pt_capture_mib`.
struct FileRoom {
    std::string_view what; // captures, photos
    std::filesystem::path folder; // of all of them
    uint64_t used = 0, most = 0; // bytes
};

class OutputFolder {
public:
    // base/names[0]/names[1]/..., made where they are missing. `base` may be reached through links, the others may be
    // none. Throws FileError.
    OutputFolder(const std::filesystem::path& base, std::initializer_list<std::string_view> names);
    OutputFolder(OutputFolder&& other) noexcept;
    OutputFolder& operator=(OutputFolder&&) = delete;
    ~OutputFolder();

    const std::filesystem::path& path() const { return path_; }

    // A folder in this one that was not there before: `name`, or name-2, name-3 ... Throws FileError.
    OutputFolder make_new(std::string_view name) const;
    // Under its name there is either all of the file or nothing of it. What is there already is replaced only if it
    // begins with `mark`, as files of the module's own do; an empty mark: never. Throws FileError.
    void write(const std::string& name, std::span<const std::byte> bytes, std::string_view mark = {}) const;
    // Whether anything has this name: a file, a folder, a link to nowhere.
    bool has(const std::string& name) const;
    // All of a file, which may be no link. Throws FileError, also where it is longer than `most` bytes.
    std::string read(const std::string& name, size_t most) const;

    // Of all files in this folder and below.
    uint64_t bytes() const;
    // That its file system has left for users.
    uint64_t free_bytes() const;
    // Throws FileError where `bytes` more would be too many for the room, or for the disk.
    void check_room(uint64_t bytes, const FileRoom& room) const;

private:
    OutputFolder(int descriptor, std::filesystem::path path);
    void check_replaceable(const std::string& name, std::string_view mark) const;
    [[noreturn]] void fail(const std::string& name, std::string_view reason) const;

    int descriptor_;
    std::filesystem::path path_;
};

} // namespace vkpt

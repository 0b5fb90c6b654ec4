// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/shader_folder.hpp"

#include "common/read_text.hpp"
#include "common/temporary_folder.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

namespace vkpt {

namespace fs = std::filesystem;

namespace {

// The one include that is no file of the folder: it stands for the sampler that a shader is built with.
constexpr std::string_view selected_sampler = "selected_light_sampler.glsl";

// The exit status; -1: there is no such program. `log` gets what the program says.
int run_program(const std::vector<std::string>& words, const fs::path& log)
{
    std::vector<char*> arguments;
    for (const std::string& word : words)
        arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
    pid_t process = 0;
    const int error = posix_spawnp(&process, arguments[0], &files, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (error != 0)
        return -1;
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) { }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 255;
}

// "#include "NAME"" with any spaces: NAME; "": the line is none.
std::string included_name(std::string_view line)
{
    const auto skip_spaces = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
    for (const std::string_view word : { "#", "include" }) {
        skip_spaces();
        if (!line.starts_with(word))
            return {};
        line.remove_prefix(word.size());
    }
    skip_spaces();
    if (line.empty() || (line[0] != '"' && line[0] != '<'))
        return {};
    line.remove_prefix(1);
    return std::string(line.substr(0, line.find_first_of("\">")));
}

// `options` have spaces between.
void append(std::vector<std::string>& words, std::vector<std::string>::iterator place, std::string_view options)
{
    std::istringstream stream { std::string(options) };
    words.insert(place, std::istream_iterator<std::string>(stream), {});
}

// As the build does, so that code of unchanged sources is the same. Without spirv-opt it stays as it is, and works,
// too.
void optimize(const fs::path& code, const fs::path& log)
{
    std::vector<std::string> words { "spirv-opt", code.string(), "-o", code.string() };
    append(words, words.begin() + 1, shader_optimizations);
    if (const int status = run_program(words, log); status > 0)
        throw ShaderError(fmt::format("spirv-opt ended with {}: {}", status, read_text(log)));
}

TemporaryFolder make_folder()
{
    try {
        return TemporaryFolder("ref_vkpt-shader-");
    } catch (const fs::filesystem_error& error) {
        throw ShaderError(error.what());
    }
}

// Lines fit the screen without the folder before every name.
std::string shorten_paths(std::string text, const std::string& folder)
{
    for (size_t place; (place = text.find(folder)) != std::string::npos;)
        text.erase(place, folder.size());
    return text;
}

bool is_below(const fs::path& folder, const fs::path& path)
{
    return std::ranges::mismatch(folder, path).in1 == folder.end();
}

} // namespace

ShaderFolder::ShaderFolder(const fs::path& folder)
{
    std::error_code error;
    folder_ = fs::canonical(folder, error);
    if (error || !fs::is_directory(folder_, error))
        throw ShaderError(fmt::format("pt_shader_dir \"{}\" is not a folder", folder.string()));
}

const ShaderFolder::File& ShaderFolder::look_at(const fs::path& path)
{
    std::error_code error;
    const fs::file_time_type changed = fs::last_write_time(path, error);
    File& file = known_[path.string()];
    if (file.changed == changed)
        return file;
    file = { changed, {} };
    std::istringstream text(read_text(path));
    for (std::string line; std::getline(text, line);)
        if (std::string name = included_name(line); !name.empty())
            file.includes.push_back(std::move(name));
    return file;
}

void ShaderFolder::collect(const fs::path& path, const ShaderBuild& build, Files& found)
{
    std::error_code error;
    const fs::path real = fs::canonical(path, error);
    if (error) // only C++ includes it, or the compiler will say what it misses
        return;
    if (!is_below(folder_, real))
        throw ShaderError(fmt::format("{} is not in {}", path.string(), folder_.string()));
    const File& file = look_at(real);
    if (!found.emplace(real.string(), file.changed).second)
        return;
    for (const std::string& name : std::vector(file.includes)) {
        const fs::path beside = path.parent_path() / name;
        if (name == selected_sampler)
            collect(folder_ / "light_samplers" / fmt::format("{}.glsl", build.light_sampler), build, found);
        else
            collect(fs::exists(beside, error) ? beside : folder_ / name, build, found);
    }
}

ShaderFolder::Files ShaderFolder::find_files(std::string_view shader)
{
    const ShaderBuild build = find_shader_build(shader);
    Files files;
    collect(folder_ / build.file, build, files);
    return files;
}

std::vector<uint32_t> ShaderFolder::compile(std::string_view shader) const
{
    const ShaderBuild build = find_shader_build(shader);
    const TemporaryFolder temporary = make_folder();
    const fs::path code = temporary.path() / "code.spv", log = temporary.path() / "log.txt";
    std::ofstream(temporary.path() / selected_sampler)
        << fmt::format("#include \"light_samplers/{}.glsl\"\n", build.light_sampler);
    std::vector<std::string> words { "glslangValidator", "--quiet", "-I" + folder_.string(),
        "-I" + temporary.path().string(), "-o", code.string(), (folder_ / build.file).string() };
    append(words, words.begin() + 2, build.options);
    int status = run_program(words, log);
    if (status == -1) {
        words[0] = "glslang";
        status = run_program(words, log);
    }
    if (status == -1)
        throw ShaderError("shaders are compiled by glslangValidator, which is not there: install the package "
                          "glslang-tools");
    if (status != 0)
        throw ShaderError(shorten_paths(read_text(log), folder_.string() + '/'));
    optimize(code, log);
    const std::string bytes = read_text(code);
    std::vector<uint32_t> words_of_code(bytes.size() / sizeof(uint32_t));
    std::memcpy(words_of_code.data(), bytes.data(), words_of_code.size() * sizeof(uint32_t));
    return words_of_code;
}

} // namespace vkpt

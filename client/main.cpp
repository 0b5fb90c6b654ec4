// SPDX-License-Identifier: GPL-2.0-or-later
// vkpt: hosts the refresh module without the engine. One file per subcommand.
#include "client/host/errors.hpp"
#include "client/manual.hpp"
#include "client/options.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <new>

namespace {

enum ExitStatus { done = 0, failed = 1, wrong_use = 2 };

// What a command has printed counts once it is written: a full disk may show only here.
int finish(ExitStatus status)
{
    std::cout.flush();
    if (std::cout && std::fflush(stdout) == 0 && !std::ferror(stdout))
        return status;
    std::fprintf(stderr, "vkpt: cannot write to standard output: %s\n", std::strerror(errno));
    return std::max(status, failed);
}

int report(ExitStatus status, const char* text)
{
    std::fprintf(stderr, "vkpt: %s\n", text);
    return status;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App program(
        "Path tracing for Quake II without the engine: pictures and measurements of maps and recorded games.", "vkpt");
    program.footer("Exit status: 0 done, 1 failed, 2 wrong use.");
    program.require_subcommand(1);
    vkpt::client::add_info_command(program);
    vkpt::client::add_record_command(program);
    vkpt::client::add_render_command(program);
    vkpt::client::add_film_command(program);
    vkpt::client::add_bench_command(program);
    vkpt::client::add_report_command(program);
    vkpt::client::add_manual_options(program);
    vkpt::client::add_compare_command(program);
    vkpt::client::add_diff_command(program);
    vkpt::client::add_export_command(program);
    vkpt::client::add_view_command(program);
    try {
        program.parse(argc, argv);
        return finish(done);
    } catch (const CLI::ParseError& error) {
        return finish(program.exit(error) == 0 ? done : wrong_use);
    } catch (const vkpt::client::WrongUse& error) {
        return report(wrong_use, error.what());
    } catch (const std::bad_alloc&) {
        return report(failed, "out of memory: close other programs, or ask for a smaller --size");
    } catch (const std::exception& error) {
        return report(failed, error.what());
    }
}

// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/manual.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vkpt::client {

namespace {

std::vector<CLI::App*> commands_of(CLI::App& program)
{
    return program.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<CLI::Option*> options_of(CLI::App& app)
{
    return app.get_options([](const CLI::Option*) { return true; });
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

std::vector<std::string> spellings(const CLI::Option& option)
{
    std::vector<std::string> names;
    for (const std::string& name : option.get_snames())
        names.push_back("-" + name);
    for (const std::string& name : option.get_lnames())
        names.push_back("--" + name);
    return names;
}

// troff takes lines that begin with a dot or an apostrophe, and backslashes and hyphens, for its own.
std::string escape(std::string_view text)
{
    std::string escaped;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (escaped.empty() || escaped.back() == '\n'))
            escaped += "\\&";
        if (c == '\\')
            escaped += "\\e";
        else if (c == '-')
            escaped += "\\-";
        else
            escaped += c;
    }
    return escaped;
}

std::string describe_option(const CLI::Option& option)
{
    const std::vector<std::string> names = spellings(option);
    std::string line = names.empty() ? option.get_name() : fmt::format("{}", fmt::join(names, ", "));
    if (!names.empty() && takes_value(option))
        line += " " + option.get_type_name();
    return fmt::format(".TP\n.B {}\n{}\n", escape(line), escape(option.get_description()));
}

} // namespace

std::string make_man_page(CLI::App& program)
{
    std::string page
        = fmt::format(".TH VKPT 1\n.SH NAME\nvkpt \\- {}\n.SH SYNOPSIS\n.B vkpt\nCOMMAND [OPTION]...\n.SH COMMANDS\n",
            escape(program.get_description()));
    for (CLI::App* command : commands_of(program)) {
        page += fmt::format(".SS vkpt {}\n{}\n", command->get_name(), escape(command->get_description()));
        for (const CLI::Option* option : options_of(*command))
            page += describe_option(*option);
        if (!command->get_footer().empty())
            page += fmt::format(".PP\n.nf\n{}\n.fi\n", escape(command->get_footer()));
    }
    page += ".SH EXIT STATUS\n0 done, 1 failed, 2 wrong use.\n"
            ".SH ENVIRONMENT\n.TP\n.B VKPT_MODULE\nThe refresh module to load.\n"
            ".TP\n.B VKPT_BASEDIR\nThe folder that contains baseq2.\n"
            ".TP\n.B VKPT_ENGINE\nThe engine to record with.\n"
            ".TP\n.B VKPT_CACHE_DIR\nWhere driver and module keep compiled shaders.\n";
    return page;
}

std::string make_bash_completion(CLI::App& program)
{
    std::string commands, cases, with_value;
    for (CLI::App* command : commands_of(program)) {
        std::vector<std::string> words;
        for (const CLI::Option* option : options_of(*command))
            for (const std::string& name : spellings(*option)) {
                words.push_back(name);
                // What follows is a file or of the user's own making.
                if (takes_value(*option) && with_value.find(" " + name + " ") == std::string::npos)
                    with_value += " " + name + " ";
            }
        commands += (commands.empty() ? "" : " ") + command->get_name();
        cases += fmt::format("    {}) words='{}' ;;\n", command->get_name(), fmt::join(words, " "));
    }
    return fmt::format("# bash completion of vkpt; written by `vkpt --completion`\n"
                       "_vkpt() {{\n"
                       "    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} words=\n"
                       "    COMPREPLY=()\n"
                       "    if ((COMP_CWORD == 1)); then\n"
                       "        COMPREPLY=($(compgen -W '{} --help' -- \"$word\"))\n"
                       "        return\n"
                       "    fi\n"
                       "    case ${{COMP_WORDS[1]}} in\n{}    esac\n"
                       "    case '{}' in *\" $before \"*) return ;; esac\n"
                       "    [[ $word == -* ]] && COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
                       "}}\n"
                       "complete -o default -F _vkpt vkpt\n",
        commands, cases, with_value);
}

void add_manual_options(CLI::App& program)
{
    const auto add = [&](const char* name, std::string (*make)(CLI::App&), const char* help) {
        program.add_flag_callback(
            name,
            [&program, make] {
                fmt::print("{}", make(program));
                throw CLI::Success();
            },
            help);
    };
    add("--man-page", make_man_page, "Print the manual page for man(1)");
    add("--completion", make_bash_completion, "Print the bash completion: source <(vkpt --completion)");
}

} // namespace vkpt::client

#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace weave::loomlink {

/// An option or a place that names a design, a person or a machine, held to what a server takes for a name
/// before it is asked: nothing empty, no `/`, no `..`. `value` must outlive the command.
CLI::Option* add_name(CLI::App* command, const std::string& name, std::string& value,
                      const std::string& help);

/// The same of a loom, whose name may have spaces within.
CLI::Option* add_loom_name(CLI::App* command, const std::string& name, std::string& value,
                           const std::string& help);

/// What holds a word to the name of a loom, for options that are lists.
CLI::Validator loom_name();

/// What holds words for people, which the server keeps, to UTF-8.
CLI::Validator utf8_words();

/// What a person has to say, such as the reason of a step, held to what a server takes (check_text()) before it
/// is asked.
CLI::Option* add_said(CLI::App* command, const std::string& name, std::string& value,
                      const std::string& help);

}  // namespace weave::loomlink

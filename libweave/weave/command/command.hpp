#pragma once

#include <weave/command/command_outcome.hpp>

#include <CLI/CLI.hpp>

#include <functional>
#include <string>
#include <vector>

namespace weave {

/// Prepares a program before its commands are added: --help, --version, and that one command must follow.
/// Every command's help ends with what the exit status means.
void prepare_program(CLI::App& app, const std::string& version);

/// Adds a command with --json; its help shows the example, if any, a whole line as a person types it.
CLI::App* add_command(CLI::App& app, CommandOutcome& outcome, const std::string& name,
                      const std::string& help, const std::string& example = {});

/// Holds a word to a few; a refusal tells them, as the option's help has to.
CLI::Validator one_of(const std::vector<std::string>& choices);

/// Lets `run` be the command's work: its error, if any, is told and becomes the exit code.
void on_run(CLI::App* command, CommandOutcome& outcome, std::function<Status()> run);

/// Runs the command that the words of a call name; what is wrong with a call, and what is thrown, is told as
/// an error. What the library tells besides its results (core/log.hpp) goes to standard error meanwhile.
/// Gives the exit status.
int run_program(CLI::App& app, CommandOutcome& outcome, int count, char** words);

}  // namespace weave

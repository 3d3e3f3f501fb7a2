#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>

#include <CLI/CLI.hpp>

#include <functional>
#include <string>

namespace weave::loomlink {

/// Exit codes that scripts rely on: 0 done, 1 findings, 2 usage, 3 bad input, 4 refused, 5 a fault.
int exit_code_of(ErrorCode code);

/// What every command of `loomlink` has: whether a program reads along, and how it ended.
struct CommandOutcome {
    bool json = false;
    int exit_code = 0;

    /// Tells the error and remembers its exit code. A program that reads along gets it as the answer,
    /// `{"error": …}`, unless it has had one.
    void fail(const Error& error);
    /// A line for people on standard error.
    static void note(const std::string& line);
    /// The answer: one line of JSON if a program reads along, else these words, on standard output.
    void answer(const Json& json_answer, const std::string& words);

  private:
    bool m_answered = false;
};

/// Adds a command with --json.
CLI::App* add_command(CLI::App& app, CommandOutcome& outcome, const std::string& name,
                      const std::string& help);

/// Lets `run` be the command's work: its error, if any, is told and becomes the exit code.
void on_run(CLI::App* command, CommandOutcome& outcome, std::function<Status()> run);

/// The commands, one file each.
void add_init_command(CLI::App& app, CommandOutcome& outcome);
void add_serve_command(CLI::App& app, CommandOutcome& outcome);

}  // namespace weave::loomlink

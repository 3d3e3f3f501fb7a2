#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace weave::loomlink {

/// What every command of `loomlink` has: whether a program reads along, and how it ended.
struct CommandOutcome {
    bool json = false;
    int exit_code = 0;

    /// Tells the error and remembers its exit code. A program that reads along gets it as the answer,
    /// `{"error": …}`, unless it has had one.
    void fail(const Error& error);
    /// Remembers that the command was done and found something: exit code 1.
    void found_something() { exit_code = 1; }
    /// A line for people on standard error.
    static void note(const std::string& line);
    /// The answer: one line of JSON if a program reads along, else these words, on standard output. Names
    /// from outside must come through on_one_line() in `words`, whose line breaks are kept.
    void answer(const Json& json_answer, const std::string& words);

  private:
    bool m_answered = false;
};

/// Adds a command with --json; its help shows the example, a whole line as a person types it.
CLI::App* add_command(CLI::App& app, CommandOutcome& outcome, const std::string& name,
                      const std::string& help, const std::string& example = {});

/// Adds a command that has commands of its own, one of which must follow.
CLI::App& add_group(CLI::App& app, const std::string& name, const std::string& help);

/// Lets `run` be the command's work: its error, if any, is told and becomes the exit code.
void on_run(CLI::App* command, CommandOutcome& outcome, std::function<Status()> run);

/// An option or a place that is a whole number from 1 on, in decimal digits. `value` must outlive the
/// command.
CLI::Option* add_number(CLI::App* command, const std::string& name, std::optional<std::int64_t>& value,
                        const std::string& help);

/// An option that is a list of them, such as 2,1,3, and may be repeated. `values` must outlive the command.
CLI::Option* add_numbers(CLI::App* command, const std::string& name, std::vector<std::int64_t>& values,
                         const std::string& help);

/// An option or a place that is a text; it must not be empty. `value` must outlive the command.
CLI::Option* add_text(CLI::App* command, const std::string& name, std::string& value,
                      const std::string& help);

/// What is wrong with a call that could not be parsed, in a sentence.
std::string usage_trouble(const CLI::App& app, const CLI::ParseError& trouble);

/// The commands, one group a file.
void add_init_command(CLI::App& app, CommandOutcome& outcome);
void add_serve_command(CLI::App& app, CommandOutcome& outcome);
void add_upkeep_commands(CLI::App& app, CommandOutcome& outcome);       // verify, backup, restore
void add_session_commands(CLI::App& app, CommandOutcome& outcome);      // login, logout, me
void add_user_commands(CLI::App& app, CommandOutcome& outcome);         // user
void add_policy_command(CLI::App& app, CommandOutcome& outcome);        // policy
void add_trust_commands(CLI::App& app, CommandOutcome& outcome);        // trust, key
void add_signer_commands(CLI::App& app, CommandOutcome& outcome);       // signer
void add_loom_commands(CLI::App& app, CommandOutcome& outcome);         // loom, faults
void add_design_commands(CLI::App& app, CommandOutcome& outcome);       // design, save, export, diff
void add_step_commands(CLI::App& app, CommandOutcome& outcome);         // submit … approve
void add_evidence_commands(CLI::App& app, CommandOutcome& outcome);     // evidence
void add_release_commands(CLI::App& app, CommandOutcome& outcome);      // release, sign, withdraw
void add_pull_command(CLI::App& app, CommandOutcome& outcome);          // pull
void add_verify_files_command(CLI::App& app, CommandOutcome& outcome);  // verify-files
void add_log_commands(CLI::App& app, CommandOutcome& outcome);          // log, audit

}  // namespace weave::loomlink

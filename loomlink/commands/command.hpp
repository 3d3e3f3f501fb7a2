#pragma once

#include <weave/command/command.hpp>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace weave::loomlink {

/// Adds a command that has commands of its own, one of which must follow.
CLI::App& add_group(CLI::App& app, const std::string& name, const std::string& help);

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

/// The same of words for people, which the server keeps: they must be UTF-8.
CLI::Option* add_words(CLI::App* command, const std::string& name, std::string& value,
                       const std::string& help);

/// `-r,--reason`, which every signed step takes.
void add_reason(CLI::App* command, std::string& reason);

/// The commands, one group a file.
void add_init_command(CLI::App& app, CommandOutcome& outcome);
void add_serve_command(CLI::App& app, CommandOutcome& outcome);
void add_upkeep_commands(CLI::App& app, CommandOutcome& outcome);       // verify, backup, restore
void add_migrate_store_command(CLI::App& app, CommandOutcome& outcome);  // migrate-store
void add_session_commands(CLI::App& app, CommandOutcome& outcome);      // login, logout, me
void add_token_command(CLI::App& app, CommandOutcome& outcome);         // token
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

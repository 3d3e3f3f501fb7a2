// The program `loomlink`: versions, approval, audit and loom files, as a service and on its command line.

#include <loomlink/commands/command.hpp>

namespace {

/// Help lists commands by who needs them, as README.md does.
void by_person(CLI::App& app) {
    const std::pair<const char*, std::vector<const char*>> people[]{
        {"A site, on its own machine", {"init", "serve", "verify", "backup", "restore", "migrate-store"}},
        {"Who you are", {"login", "logout", "me", "token"}},
        {"Administrators, and for everybody to join", {"user", "policy", "trust", "signer"}},
        {"Designers", {"design", "save", "check", "submit", "comment", "faults"}},
        {"Approvers", {"approve", "request-changes", "waive", "release", "sign", "withdraw"}},
        {"At the loom", {"loom", "pull", "verify-files"}},
        {"Engineers", {"export", "diff", "log", "audit", "key", "evidence"}}};
    for (const auto& [who, names] : people)
        for (const char* name : names) app.get_subcommand(name)->group(who);
}

}  // namespace

int main(int count, char** words) {
    weave::CommandOutcome outcome("loomlink", weave::JsonLayout::on_one_line);
    CLI::App app("Keeps designs, their approval and their release to looms.\n", "loomlink");
    weave::prepare_program(app, WEAVE_VERSION);
    for (const auto add : {weave::loomlink::add_init_command, weave::loomlink::add_serve_command,
                           weave::loomlink::add_session_commands, weave::loomlink::add_token_command, weave::loomlink::add_user_commands,
                           weave::loomlink::add_policy_command, weave::loomlink::add_trust_commands,
                           weave::loomlink::add_signer_commands, weave::loomlink::add_loom_commands,
                           weave::loomlink::add_design_commands, weave::loomlink::add_step_commands,
                           weave::loomlink::add_evidence_commands, weave::loomlink::add_release_commands,
                           weave::loomlink::add_pull_command, weave::loomlink::add_verify_files_command,
                           weave::loomlink::add_log_commands, weave::loomlink::add_upkeep_commands, weave::loomlink::add_migrate_store_command})
        add(app, outcome);
    by_person(app);
    return weave::run_program(app, outcome, count, words);
}

// The program `loomlink`: versions, approval, audit and loom files, as a service and on its command line.

#include <loomlink/commands/command.hpp>

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
    return weave::run_program(app, outcome, count, words);
}

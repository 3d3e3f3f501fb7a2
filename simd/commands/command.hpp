#pragma once

#include <weave/command/command.hpp>

namespace weave::simd {

void add_serve_command(CLI::App& app, CommandOutcome& outcome);
void add_token_commands(CLI::App& app, CommandOutcome& outcome);   // token add, token remove, token list
void add_status_commands(CLI::App& app, CommandOutcome& outcome);  // status, top

}  // namespace weave::simd

#include <weave/core/text.hpp>

#include <iostream>
#include <loomlink/commands/command.hpp>

namespace weave::loomlink {

namespace {

const char* word_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::usage:
            return "usage";
        case ErrorCode::bad_input:
            return "bad input";
        case ErrorCode::invalid:
            return "invalid";
        case ErrorCode::refused:
            return "refused";
        case ErrorCode::system:
            break;
    }
    return "system";
}

}  // namespace

int exit_code_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::usage:
            return 2;
        case ErrorCode::bad_input:
            return 3;
        case ErrorCode::invalid:
            return 1;
        case ErrorCode::refused:
            return 4;
        case ErrorCode::system:
            break;
    }
    return 5;
}

void CommandOutcome::fail(const Error& error) {
    exit_code = exit_code_of(error.code);
    note(error.text());
    if (json && !m_answered)
        answer({{"error",
                 {{"kind", word_of(error.code)},
                  {"where", error.where},
                  {"message", error.message},
                  {"exit", exit_code}}}},
               "");
}

void CommandOutcome::note(const std::string& line) {
    std::cerr << "loomlink: " << on_one_line(line) << '\n';
}

void CommandOutcome::answer(const Json& json_answer, const std::string& words) {
    m_answered = true;
    if (json)  // in ASCII: a terminal obeys some characters beyond it
        std::cout << json_answer.dump(-1, ' ', true, Json::error_handler_t::replace) << '\n';
    else
        std::cout << words;
    std::cout.flush();
}

CLI::App* add_command(CLI::App& app, CommandOutcome& outcome, const std::string& name,
                      const std::string& help) {
    CLI::App* command = app.add_subcommand(name, help)->group("Commands");
    command->add_flag("--json", outcome.json, "answer with one JSON object on standard output");
    return command;
}

void on_run(CLI::App* command, CommandOutcome& outcome, std::function<Status()> run) {
    command->callback([&outcome, run = std::move(run)] {
        if (Status status = run(); !status) outcome.fail(status.error());
    });
}

}  // namespace weave::loomlink

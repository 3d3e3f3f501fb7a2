#include <weave/core/exit_code.hpp>
#include <weave/core/text.hpp>

#include <iostream>
#include <loomlink/commands/command.hpp>

namespace weave::loomlink {

namespace {

/// The whole number from 1 on that a word is; decimal, whatever it begins with.
std::int64_t number_of(const std::string& option, const std::string& word) {
    constexpr std::int64_t most = std::int64_t{1} << 30;
    const auto number = parse_whole(word);
    if (!number || *number < 1 || *number > most)
        throw CLI::ValidationError(option, "'" + word + "' is not a whole number from 1 on");
    return *number;
}

}  // namespace

void CommandOutcome::fail(const Error& error) {
    exit_code = exit_code_of(error.code);
    note(error.text());
    if (json && !m_answered) answer({{"error", error_json(error)}}, "");
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
                      const std::string& help, const std::string& example) {
    CLI::App* command = app.add_subcommand(name, help)->group("Commands");
    command->add_flag("--json", outcome.json, "answer with one JSON object on standard output");
    if (!example.empty()) command->footer("Example: " + example + "\n" + command->get_footer());
    return command;
}

CLI::App& add_group(CLI::App& app, const std::string& name, const std::string& help) {
    return *app.add_subcommand(name, help)->group("Commands")->require_subcommand(1);
}

void on_run(CLI::App* command, CommandOutcome& outcome, std::function<Status()> run) {
    command->callback([&outcome, run = std::move(run)] {
        if (Status status = run(); !status) outcome.fail(status.error());
    });
}

CLI::Option* add_number(CLI::App* command, const std::string& name, std::optional<std::int64_t>& value,
                        const std::string& help) {
    const auto read = [name, &value](const std::string& word) { value = number_of(name, word); };
    return command->add_option_function<std::string>(name, read, help)->type_name("N");
}

CLI::Option* add_numbers(CLI::App* command, const std::string& name, std::vector<std::int64_t>& values,
                         const std::string& help) {
    const auto read = [name, &values](const std::vector<std::string>& words) {
        for (const std::string& word : words) values.push_back(number_of(name, word));
    };
    return command->add_option_function<std::vector<std::string>>(name, read, help)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("N,N,");
}

CLI::Option* add_text(CLI::App* command, const std::string& name, std::string& value,
                      const std::string& help) {
    const auto filled = [](std::string& word) {
        return word.empty() ? std::string("must not be empty") : "";
    };
    return command->add_option(name, value, help)->check(CLI::Validator(filled, ""));
}

/// CLI11 asks for a command before it looks at words it does not know.
std::string usage_trouble(const CLI::App& app, const CLI::ParseError& trouble) {
    const CLI::App* last = &app;
    while (!last->get_subcommands().empty()) last = last->get_subcommands().front();
    if (last->get_require_subcommand_min() == 0) return trouble.what();
    const auto unknown = last->remaining();
    if (unknown.empty())
        return last == &app ? "name a command" : "name what to do: " + last->get_name() + " --help";
    const bool option = unknown.front().starts_with('-');
    return "there is no " + std::string(option ? "option" : "command") + " '" + unknown.front() + "'" +
           (last == &app ? "" : " of " + last->get_name());
}

}  // namespace weave::loomlink

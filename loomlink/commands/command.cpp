#include <loomlink/commands/command.hpp>

#include <loomlink/commands/names.hpp>

#include <weave/core/text.hpp>

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

CLI::App& add_group(CLI::App& app, const std::string& name, const std::string& help) {
    return *app.add_subcommand(name, help)->group("Commands")->require_subcommand(1);
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

CLI::Option* add_words(CLI::App* command, const std::string& name, std::string& value,
                       const std::string& help) {
    return add_text(command, name, value, help)->check(utf8_words());
}

void add_reason(CLI::App* command, std::string& reason) {
    add_said(command, "-r,--reason", reason, "why; it stands in the log")->type_name("WHY");
}

}  // namespace weave::loomlink

#include <loomlink/commands/names.hpp>

#include <weave/core/text.hpp>

#include <loomlink/workflow/names.hpp>

namespace weave::loomlink {

namespace {

CLI::Validator name_check(bool spaces) {
    const auto check = [spaces](std::string& word) {
        const Status named = check_name(word, "", spaces);
        return named ? std::string() : "'" + on_one_line(word) + "' is no name: it " + named.error().message;
    };
    return {check, ""};
}

std::string said_check(std::string& text) {
    const Status said = check_text(text, "");
    return said ? std::string() : said.error().message;
}

}  // namespace

CLI::Option* add_name(CLI::App* command, const std::string& name, std::string& value,
                      const std::string& help) {
    return command->add_option(name, value, help)->check(name_check(false));
}

CLI::Option* add_loom_name(CLI::App* command, const std::string& name, std::string& value,
                           const std::string& help) {
    return command->add_option(name, value, help)->check(name_check(true));
}

CLI::Validator loom_name() {
    return name_check(true);
}

CLI::Option* add_said(CLI::App* command, const std::string& name, std::string& value,
                      const std::string& help) {
    return command->add_option(name, value, help)->check(CLI::Validator(said_check, ""))->required();
}

}  // namespace weave::loomlink

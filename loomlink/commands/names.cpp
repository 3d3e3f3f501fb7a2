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

/// What stands for an option's value in the help; a place has its own name.
const char* word_for(const std::string& option, const char* word) {
    return option.starts_with('-') ? word : "";
}

std::string said_check(std::string& text) {
    const Status said = check_text(text, "");
    return said ? std::string() : said.error().message;
}

}  // namespace

CLI::Option* add_name(CLI::App* command, const std::string& name, std::string& value,
                      const std::string& help) {
    return command->add_option(name, value, help)->check(name_check(false))->type_name(word_for(name, "NAME"));
}

CLI::Option* add_loom_name(CLI::App* command, const std::string& name, std::string& value,
                           const std::string& help) {
    return command->add_option(name, value, help)->check(name_check(true))->type_name(word_for(name, "LOOM"));
}

CLI::Validator loom_name() {
    return name_check(true);
}

CLI::Validator utf8_words() {
    return {[](std::string& words) { return is_utf8(words) ? std::string() : "'" + on_one_line(words) + "' is not UTF-8"; }, ""};
}

CLI::Option* add_said(CLI::App* command, const std::string& name, std::string& value,
                      const std::string& help) {
    return command->add_option(name, value, help)->check(utf8_words())->check(CLI::Validator(said_check, ""))->required();
}

}  // namespace weave::loomlink

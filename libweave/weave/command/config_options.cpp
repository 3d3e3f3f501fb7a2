#include <weave/command/config_options.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <utility>

namespace weave {

ConfigOptions::ConfigOptions(CLI::App* command, const std::string& more) : m_command(command) {
    command->add_option("--config", m_file, "a file of JSON with what else stands here, and more (" + more + ")")->type_name("FILE");
    command->add_flag("--check-config", m_check_only,
                      "say whether it could be served so, as far as that can be seen without serving; and end");
}

void ConfigOptions::add_service(ServiceConfig& config) {
    add("--address", "address", config.address, "the address to listen on (" + config.address + ")")->type_name("ADDRESS");
    add("--port", "port", config.port, "the port to listen on (" + std::to_string(config.port) + "); 0: any free one")->type_name("N");
    add("--host", "hosts", config.hosts, "a name or address that clients use; may be repeated")->type_name("HOST");
    add("--cert", "certificate", config.certificate, "a certificate (PEM) in place of a self-made one")->type_name("FILE");
    add("--key", "key", config.key, "the key of that certificate (PEM)")->type_name("FILE");
    m_command->add_flag_callback(
        "--plain", [this, &config] { give("--plain", "plain", [&config] { config.plain = true; }); },
        "HTTP without TLS, on this machine alone");
}

CLI::Validator ConfigOptions::whole_up_to(std::uint64_t most) {
    return {[most](std::string& word) -> std::string {
                const auto number = parse_whole(word);
                if (number && *number >= 0 && static_cast<std::uint64_t>(*number) <= most) {
                    word = std::to_string(*number);  // a 0 in front does not make it octal
                    return {};
                }
                const bool is_small = most <= std::numeric_limits<std::uint32_t>::max();
                return "'" + word + "' is not a whole number from 0 " + (is_small ? "to " + std::to_string(most) : "on");
            },
            ""};
}

bool ConfigOptions::only_checks(CommandOutcome& outcome) const {
    if (m_check_only) outcome.answer({{"valid", true}}, "The configuration is valid.\n");
    return m_check_only;
}

void ConfigOptions::give(const std::string& option, const std::string& member, std::function<void()> set) {
    m_given.push_back(std::move(set));
    m_options[member] = option;
}

Error ConfigOptions::told(Error error) const {
    const std::size_t end = std::min(error.where.find_first_of(".[:"), error.where.size());
    const auto option = m_options.find(error.where.substr(0, end));
    if (option != m_options.end()) {
        error.where.replace(0, end, option->second);
        return error;
    }
    return m_file.empty() ? error : std::move(error).in(m_file);
}

}  // namespace weave

#pragma once

#include <weave/command/command_outcome.hpp>
#include <weave/command/service_config.hpp>
#include <weave/core/file.hpp>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

namespace weave {

/// What the call of a service says of its configuration: its file, and options, each in place of a member of the file. It and
/// the configuration must outlive the command.
class ConfigOptions {
  public:
    /// Adds --config and --check-config; `more` says where the file's members are told.
    ConfigOptions(CLI::App* command, const std::string& more);
    ConfigOptions(const ConfigOptions&) = delete;
    ConfigOptions& operator=(const ConfigOptions&) = delete;

    /// Adds an option in place of the member `member`, which is kept at `place`.
    template <class Value>
    CLI::Option* add(const std::string& option, const std::string& member, Value& place, const std::string& help) {
        CLI::Option* const added = m_command->add_option_function<Value>(
            option,
            [this, option, member, &place](const Value& value) {
                give(option, member, [&place, value] { place = value; });
            },
            help);
        if constexpr (std::is_integral_v<Value>) added->transform(whole_up_to(std::numeric_limits<Value>::max()));
        return added;
    }
    /// Adds the options for what every service is told.
    void add_service(ServiceConfig& config);

    [[nodiscard]] bool is_check() const { return m_check_only; }
    /// Whether nothing is to be served; if so, answers that the configuration is valid.
    [[nodiscard]] bool only_checks(CommandOutcome& outcome) const;

    /// Makes `config` what its file says, if there is one, and then the options; `check` asks for all the rest. Errors name
    /// the file and the member in it, or the option in place of the member.
    template <class Config>
    Status complete(Config& config, Result<Config> (*parse)(std::string_view text, const std::filesystem::path& folder),
                    const std::function<Status(const Config&)>& check) const {
        if (!m_file.empty()) {
            WEAVE_TRY(const std::string text, read_file(m_file, most_bytes));
            auto read = parse(text, std::filesystem::path(m_file).parent_path());
            if (!read) return std::move(read).error().in(m_file);
            config = *std::move(read);
        }
        for (const auto& set : m_given) set();
        Status sound = check(config);
        return sound ? Status() : told(std::move(sound).error());
    }

  private:
    static constexpr std::uint64_t most_bytes = 65536;
    /// A whole number from 0 on, as it fits into the member.
    static CLI::Validator whole_up_to(std::uint64_t most);
    void give(const std::string& option, const std::string& member, std::function<void()> set);
    [[nodiscard]] Error told(Error error) const;

    CLI::App* m_command;
    std::string m_file;
    bool m_check_only = false;
    std::vector<std::function<void()>> m_given;
    std::map<std::string, std::string> m_options;  ///< members that were given by one
};

}  // namespace weave

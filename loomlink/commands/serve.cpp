#include <weave/command/serving.hpp>
#include <weave/core/log.hpp>
#include <weave/core/text.hpp>
#include <weave/net/server.hpp>

#include <loomlink/commands/command.hpp>
#include <loomlink/commands/running_site.hpp>
#include <memory>

namespace weave::loomlink {

namespace {

struct ServeOptions {
    std::string folder = ".";
    std::string config_file;
    bool check_only = false;
    ServeConfig given;  ///< by options, in place of what the file says
    CLI::App* command = nullptr;
};

/// The configuration of file and options together; options count more.
Result<ServeConfig> whole_config(const ServeOptions& options) {
    ServeConfig config;
    if (!options.config_file.empty()) {
        WEAVE_TRY(config, load_config(options.config_file));
    }
    const auto take = [&](const char* option, auto member) {
        if (options.command->count(option) > 0) config.*member = options.given.*member;
    };
    take("--site", &ServeConfig::site);
    take("--address", &ServeConfig::address);
    take("--port", &ServeConfig::port);
    take("--host", &ServeConfig::hosts);
    take("--cert", &ServeConfig::certificate);
    take("--key", &ServeConfig::key);
    take("--plain", &ServeConfig::plain);
    WEAVE_CHECK_OK(check_config(config));
    return config;
}

std::string words_of(const Json& started) {
    std::string words;
    if (started.contains("made_in"))
        words += "There was no site in " + on_one_line(started["made_in"].get<std::string>()) +
                 ": made a new, empty one\n";
    words += "loomlink serves " + started.value("site", std::string()) + " at " +
             started.value("url", std::string()) + "\n";
    if (started.contains("certificate_sha256"))
        words += "certificate (SHA-256): " + started["certificate_sha256"].get<std::string>() + "\n";
    if (started.contains("trust_sha256"))
        words += "trust (SHA-256): " + started["trust_sha256"].get<std::string>() + "\n";
    words += "access key for simd (public): " + started.value("access_public", std::string()) + "\n";
    if (started.contains("invitation"))
        words +=
            "The first administrator joins here, once: " + started["invitation"].get<std::string>() + "\n";
    return words;
}

Status serve(const ServeOptions& options, CommandOutcome& outcome) {
    WEAVE_TRY(const ServeConfig config, whole_config(options));
    if (options.check_only) {
        WEAVE_CHECK_OK(check_places(config));
        outcome.answer({{"valid", true}}, "The configuration is valid.\n");
        return {};
    }
    const EndingSignals signals;
    log_to_stderr();
    WEAVE_TRY(const auto site, RunningSite::start({options.folder}, config));
    WEAVE_TRY(const Json started, site->introduction());
    outcome.answer(started, words_of(started));
    log(LogLevel::info, "serving on port " + std::to_string(site->port()));
    signals.wait();
    log(LogLevel::info, "ending, asked to by a signal");
    site->stop();
    log(LogLevel::info, "ended");
    return {};
}

}  // namespace

void add_serve_command(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* const command = add_command(
        app, outcome, "serve", "Serve a site; where the folder is empty or missing, make a new one first");
    auto options = std::make_shared<ServeOptions>();
    options->command = command;
    add_text(command, "folder", options->folder, "the folder of the site; the current one if not given");
    command->add_option("--config", options->config_file, "a file of JSON with what else stands here");
    command->add_flag("--check-config", options->check_only,
                      "say whether the configuration is valid, and end");
    command->add_option("--site", options->given.site, "the name of a site that is made");
    command->add_option("--address", options->given.address, "the address to listen on (127.0.0.1)");
    command->add_option("--port", options->given.port, "the port to listen on (8443); 0: any free one");
    command->add_option("--host", options->given.hosts,
                        "a name or address that clients use; may be repeated");
    command->add_option("--cert", options->given.certificate,
                        "a certificate (PEM) in place of a self-made one");
    command->add_option("--key", options->given.key, "the key of that certificate (PEM)");
    command->add_flag("--plain", options->given.plain, "HTTP without TLS, on this machine alone");
    on_run(command, outcome, [options, &outcome] { return serve(*options, outcome); });
}

}  // namespace weave::loomlink

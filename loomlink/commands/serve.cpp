#include <weave/command/config_options.hpp>
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
    explicit ServeOptions(CLI::App* command) : words(command, "loomlink/README.md") {}
    std::string folder = ".";
    ServeConfig config;
    ConfigOptions words;
};

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

Status serve(ServeOptions& options, CommandOutcome& outcome) {
    const EndingSignals signals;
    const auto check = [](const ServeConfig& config) -> Status {
        WEAVE_CHECK_OK(check_config(config));
        return check_places(config);
    };
    WEAVE_CHECK_OK(options.words.complete<ServeConfig>(options.config, parse_config, check));
    WEAVE_CHECK_OK(check_service_folder(options.folder));
    if (options.words.is_check()) WEAVE_CHECK_OK(check_site({options.folder}, options.config));
    if (options.words.only_checks(outcome)) return {};
    log_to_stderr();
    WEAVE_TRY(const auto site, RunningSite::start({options.folder}, options.config));
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
    auto options = std::make_shared<ServeOptions>(command);
    add_text(command, "FOLDER", options->folder, "the folder of the site; the current one if not given");
    options->words.add("--site", "site", options->config.site, "the name of a site that is made")->type_name("NAME");
    options->words.add("--store", "store", options->config.store,
                       "connection string of the PostgreSQL database for a site that is made (postgresql://HOST/DATABASE); a file if not given")
        ->type_name("CONNECTION");
    options->words.add("--standby", "standby", options->config.standby,
                       "connection string of a server that follows that database, to read from")->type_name("CONNECTION");
    options->words.add_service(options->config);
    on_run(command, outcome, [options, &outcome] { return serve(*options, outcome); });
}

}  // namespace weave::loomlink

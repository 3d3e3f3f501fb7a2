#include <weave/command/serving.hpp>
#include <weave/core/log.hpp>
#include <weave/core/text.hpp>

#include <filesystem>
#include <memory>
#include <simd/commands/command.hpp>
#include <simd/commands/running_daemon.hpp>
#include <simd/daemon/room.hpp>

namespace weave::simd {

namespace {

struct ServeOptions {
    std::string folder = ".", config_file;
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
    take("--address", &ServeConfig::address);
    take("--port", &ServeConfig::port);
    take("--host", &ServeConfig::hosts);
    take("--cert", &ServeConfig::certificate);
    take("--key", &ServeConfig::key);
    take("--plain", &ServeConfig::plain);
    take("--socket", &ServeConfig::unix_socket);
    take("--threads", &ServeConfig::threads);
    WEAVE_CHECK_OK(check_config(config));
    return config;
}

std::string words_of(const Json& started) {
    std::string words = "simd serves";
    if (started.contains("url")) words += " at " + started.at("url").get<std::string>() + " and";
    words += " on " + on_one_line(started.at("unix_socket").get<std::string>()) + ", with " +
             counted(started.at("threads").get<std::size_t>(), "thread") + " and " + memory_text(started.at("memory_bytes")) + "\n";
    if (started.contains("certificate_sha256")) words += "certificate (SHA-256): " + started.at("certificate_sha256").get<std::string>() + "\n";
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
    WEAVE_TRY(const auto daemon, RunningDaemon::start({options.folder}, config, std::filesystem::read_symlink("/proc/self/exe")));
    const Json started = daemon->introduction();
    outcome.answer(started, words_of(started));
    signals.wait();
    log(LogLevel::info, "ending, asked to by a signal: sessions and jobs are put away");
    daemon->stop();
    log(LogLevel::info, "ended");
    return {};
}

}  // namespace

void add_serve_command(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* const command = add_command(app, outcome, "serve", "Serve from a folder; where it is missing, make it",
                                          "simd serve box --address 0.0.0.0 --host box.mill");
    auto options = std::make_shared<ServeOptions>();
    options->command = command;
    command->add_option("folder", options->folder, "the folder of its sessions and jobs; the current one if not given");
    command->add_option("--config", options->config_file, "a file of JSON with what else stands here, and more (simd/README.md)");
    command->add_flag("--check-config", options->check_only, "say whether the configuration is valid, and end");
    command->add_option("--address", options->given.address, "the address to listen on (127.0.0.1); empty: on the Unix socket alone");
    command->add_option("--port", options->given.port, "the port to listen on (8444); 0: any free one");
    command->add_option("--host", options->given.hosts, "a name or address that clients use; may be repeated");
    command->add_option("--cert", options->given.certificate, "a certificate (PEM) in place of a self-made one");
    command->add_option("--key", options->given.key, "the key of that certificate (PEM)");
    command->add_flag("--plain", options->given.plain, "HTTP without TLS, on this machine alone");
    command->add_option("--socket", options->given.unix_socket, "the Unix socket for this machine (simd.sock in the folder)");
    command->add_option("--threads", options->given.threads, "threads that compute; 0: one a core");
    on_run(command, outcome, [options, &outcome] { return serve(*options, outcome); });
}

}  // namespace weave::simd

#include <weave/command/config_options.hpp>
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
    explicit ServeOptions(CLI::App* command) : words(command, "simd/README.md") {}
    std::string folder = ".";
    ServeConfig config;
    ConfigOptions words;
};

std::string words_of(const Json& started) {
    std::string words = "simd serves";
    if (started.contains("url")) words += " at " + started.at("url").get<std::string>() + " and";
    words += " on " + on_one_line(started.at("unix_socket").get<std::string>()) + ", with " +
             counted(started.at("threads").get<std::size_t>(), "thread") + " and " + memory_text(started.at("memory_bytes")) + "\n";
    if (started.contains("certificate_sha256")) words += "certificate (SHA-256): " + started.at("certificate_sha256").get<std::string>() + "\n";
    return words;
}

Status serve(ServeOptions& options, CommandOutcome& outcome) {
    const EndingSignals signals;
    const DaemonFolder folder{options.folder};
    const auto check = [&](const ServeConfig& config) -> Status {
        WEAVE_CHECK_OK(check_config(config));
        return check_places(folder, config);
    };
    WEAVE_CHECK_OK(check_service_folder(options.folder));
    WEAVE_CHECK_OK(options.words.complete<ServeConfig>(options.config, parse_config, check));
    if (memory_of(options.config) > machine_memory())
        outcome.note("memory_mib: is more than this machine has (" + memory_text(machine_memory()) + "): the system may end workers for want of it");
    if (options.words.only_checks(outcome)) return {};
    log_to_stderr();
    WEAVE_TRY(const auto daemon, RunningDaemon::start(folder, options.config, std::filesystem::read_symlink("/proc/self/exe")));
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
    auto options = std::make_shared<ServeOptions>(command);
    ServeConfig& config = options->config;
    command->add_option("FOLDER", options->folder, "the folder of its sessions and jobs; the current one if not given");
    options->words.add_service(config);
    options->words.add("--socket", "unix_socket", config.unix_socket, "the Unix socket for this machine (simd.sock in the folder)")->type_name("PATH");
    options->words.add("--threads", "threads", config.threads, "threads that compute; 0: one a core")->type_name("N");
    options->words.add("--backend", "backend", config.backend, "what computes: auto (a CUDA device where there is one that can), cpu or cuda")->type_name("WORD");
    on_run(command, outcome, [options, &outcome] { return serve(*options, outcome); });
}

}  // namespace weave::simd

#include <simd/commands/running_daemon.hpp>

#include <weave/command/serving.hpp>
#include <weave/core/log.hpp>
#include <weave/keys/signer.hpp>
#include <weave/net/certificate.hpp>
#include <weave/net/server.hpp>
#include <weave/wire/evidence.hpp>

#include <atomic>
#include <chrono>
#include <optional>
#include <simd/daemon/daemon.hpp>
#include <simd/service/routes.hpp>
#include <simd/slurm/process.hpp>
#include <simd/store/store.hpp>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace weave::simd {

struct RunningDaemon::Parts {
    FolderLock lock;
    DaemonFolder folder;
    ServeConfig config;
    std::filesystem::path socket;
    std::shared_ptr<net::Metrics> metrics;
    std::optional<net::TlsFiles> tls;
    std::unique_ptr<Daemon> daemon;
    std::unique_ptr<Doorkeeper> doorkeeper;
    std::optional<net::Server> server;  ///< last, so that it ends first
};

namespace {

constexpr std::chrono::seconds connections_end_in{3}, work_is_put_away_in{20};

/// Refused: a folder with anything in it but what simd makes.
Status check_folder(const DaemonFolder& folder) {
    std::error_code trouble;
    if (std::filesystem::exists(folder.store(), trouble)) return {};
    std::filesystem::directory_iterator entries(folder.path, trouble);
    if (trouble) return system_fault("cannot be read: " + trouble.message(), folder.path.string());
    for (const auto& entry : entries) {
        const std::filesystem::path name = entry.path().filename();
        if (name != ".lock" && name != folder.tokens().filename())
            return Error{ErrorCode::refused, "holds no store of simd, and is not empty", folder.path.string()};
    }
    return {};
}

std::filesystem::path socket_of(const DaemonFolder& folder, const ServeConfig& config) {
    return config.unix_socket.empty() ? folder.socket() : config.unix_socket;
}

/// What signs the evidence of jobs; null where nothing does.
Result<std::function<std::optional<std::string>(const Json&)>> signing(const ServeConfig& config) {
    using Sign = std::function<std::optional<std::string>(const Json&)>;
    if (config.evidence_key.empty()) return Sign();
    WEAVE_TRY(Signer signer, load_signer(config.evidence_key));
    return Sign([signer = std::make_shared<Signer>(std::move(signer))](const Json& report) -> std::optional<std::string> {
        const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
        const auto evidence = wire::sign_evidence(signer->key, signer->site, canonical_json(report), now);
        if (evidence) return wire::write_evidence(*evidence);
        log(LogLevel::warning, "no evidence could be signed: " + evidence.error().text());
        return {};
    });
}

/// Nodes are told of places as they are from anywhere.
SlurmCrew::Rules slurm_rules(const SlurmConfig& config, const DaemonFolder& folder, const std::string& backend, const std::filesystem::path& program) {
    SlurmCrew::Rules rules;
    rules.wishes = config.wishes;
    rules.shared = std::filesystem::absolute(config.folder).lexically_normal();
    rules.program = std::filesystem::absolute(config.program.empty() ? program : config.program).lexically_normal();
    rules.home = folder.path / "jobs";
    rules.backend = backend;
    rules.watch = std::chrono::seconds(config.watch_seconds);
    rules.checkpoint = std::chrono::seconds(config.checkpoint_seconds);
    rules.jobs_at_once = config.jobs_at_once;
    return rules;
}

/// Whether jobs could be handed to Slurm from here; whether it answers just now is another matter.
Status check_slurm(const SlurmConfig& config) {
    const std::atomic<bool> goes_on{false};
    for (const char* program : {"sbatch", "squeue", "scancel", "scontrol"}) {
        constexpr std::chrono::seconds patience{10};
        auto there = run_command({program, "--version"}, patience, goes_on);
        if (!there) return std::move(there).error().in("slurm");
    }
    std::error_code code;
    if (std::filesystem::exists(config.folder, code) && !std::filesystem::is_directory(config.folder, code)) return bad_input("is no folder: " + config.folder.string(), "slurm.folder");
    return {};
}

DaemonSettings settings_of(const DaemonFolder& folder, const ServeConfig& config, const std::filesystem::path& program) {
    DaemonSettings settings;
    settings.folder = folder.path;
    settings.crew.program = program;
    settings.crew.turns.threads = threads_of(config);
    settings.crew.backend = config.backend;
    settings.crew.memory_bytes = memory_of(config);
    settings.crew.stall = std::chrono::seconds(config.stall_seconds);
    settings.most_sessions = config.sessions;
    settings.sessions_per_person = config.sessions_per_person;
    settings.jobs_at_once = config.jobs_at_once;
    settings.jobs_per_person = config.jobs_per_person;
    settings.expire = std::chrono::seconds(config.expire_seconds);
    if (config.slurm) settings.slurm = slurm_rules(*config.slurm, folder, config.backend, program);
    return settings;
}

}  // namespace

Status check_places(const DaemonFolder& folder, const ServeConfig& config) {
    WEAVE_CHECK_OK(check_service_places(config));
    WEAVE_CHECK_OK(check_unix_socket(socket_of(folder, config), config.unix_socket.empty()));
    if (config.slurm) WEAVE_CHECK_OK(check_slurm(*config.slurm));
    if (config.evidence_key.empty()) return {};
    auto signer = load_signer(config.evidence_key);
    return signer ? Status() : Status(std::move(signer).error().in("evidence_key"));
}

RunningDaemon::RunningDaemon(std::unique_ptr<Parts> parts) : m_parts(std::move(parts)) {}
RunningDaemon::~RunningDaemon() = default;

Result<std::unique_ptr<RunningDaemon>> RunningDaemon::start(const DaemonFolder& folder, const ServeConfig& config, const std::filesystem::path& program) {
    ::umask(0077);  // designs are nobody else's, whoever made the folder
    WEAVE_CHECK_OK(make_service_folder(folder.path));
    WEAVE_CHECK_OK(check_folder(folder));
    WEAVE_TRY(FolderLock lock, FolderLock::take(folder.path, "simd"));
    auto parts = std::make_unique<Parts>(Parts{std::move(lock), folder, config, {}, std::make_shared<net::Metrics>(), {}, {}, {}, {}});
    parts->socket = socket_of(folder, config);
    WEAVE_TRY(parts->tls, tls_of(folder.tls(), config));
    DaemonSettings settings = settings_of(folder, config, program);
    settings.metrics = parts->metrics;
    WEAVE_TRY(settings.sign, signing(config));
    WEAVE_TRY(auto store, Store::open(folder.store()));
    WEAVE_TRY(parts->daemon, Daemon::start(std::move(store), settings));
    parts->doorkeeper = std::make_unique<Doorkeeper>(TokenRules{config.site, config.access_keys, folder.tokens()});
    WEAVE_TRY(net::Router routes, service_routes({*parts->daemon, *parts->doorkeeper, parts->metrics, WEAVE_VERSION, config.workers}));
    net::ServerOptions options = server_options(config, parts->tls);
    options.metrics = parts->metrics;
    options.unix_socket = parts->socket;
    WEAVE_TRY(net::Server server, net::Server::start(std::move(routes), std::move(options)));
    parts->server.emplace(std::move(server));
    return std::unique_ptr<RunningDaemon>(new RunningDaemon(std::move(parts)));
}

std::uint16_t RunningDaemon::port() const {
    return m_parts->server->port();
}

Json RunningDaemon::introduction() const {
    const ServeConfig& config = m_parts->config;
    Json told{{"unix_socket", std::filesystem::absolute(m_parts->socket).string()}, {"threads", threads_of(config)}, {"memory_bytes", memory_of(config)}};
    if (!config.address.empty()) told["url"] = origin_of(config, port());
    if (!m_parts->tls) return told;
    if (const auto certificate = net::read_certificate(m_parts->tls->certificate)) told["certificate_sha256"] = certificate->fingerprint;
    return told;
}

void RunningDaemon::stop() {
    m_parts->server->stop(connections_end_in);
    m_parts->daemon->stop(work_is_put_away_in);
}

}  // namespace weave::simd

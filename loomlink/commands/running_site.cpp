#include <weave/net/server.hpp>

#include <chrono>
#include <loomlink/commands/running_site.hpp>
#include <loomlink/service/handlers.hpp>
#include <loomlink/service/service.hpp>
#include <optional>
#include <utility>

namespace weave::loomlink {

struct RunningSite::Parts {
    Parts(OpenSite site, ServeConfig config_, const DeskSettings& settings)
        : lock(std::move(site.lock)),
          config(std::move(config_)),
          desk(std::move(site.store), std::move(site.keys), site.name, settings, system_clock()) {}

    ApiHandlers handlers() {
        ApiHandlers all;
        add_account_handlers(all, accounts);
        add_design_handlers(all, designs);
        add_step_handlers(all, steps);
        add_evidence_handlers(all, evidence);
        add_release_handlers(all, releases, watchers);
        add_trust_handlers(all, trust, watchers);
        add_watch_handler(all, desk, accounts, watchers);
        return all;
    }

    FolderLock lock;
    ServeConfig config;
    Desk desk;
    ClothShelf shelf;
    Accounts accounts{desk};
    DesignDesk designs{desk, shelf};
    Steps steps{desk, shelf};
    EvidenceDesk evidence{desk};
    ReleaseDesk releases{desk, shelf};
    TrustChain trust{desk};
    Watchers watchers;
    std::optional<net::TlsFiles> tls;
    std::optional<net::Server> server;  ///< last, so that it ends first
};

namespace {

constexpr std::chrono::seconds patience{10};

std::string origin_of(const ServeConfig& config, std::uint16_t port) {
    std::string host = config.plain ? config.address : client_hosts(config).front();
    if (host.find(':') != std::string::npos) host = "[" + host + "]";
    return (config.plain ? "http://" : "https://") + host + ":" + std::to_string(port);
}

}  // namespace

RunningSite::RunningSite(std::unique_ptr<Parts> parts) : m_parts(std::move(parts)) {}

RunningSite::~RunningSite() = default;

Result<std::unique_ptr<RunningSite>> RunningSite::start(const SiteFolder& folder, const ServeConfig& config,
                                                        const DeskSettings& settings) {
    WEAVE_TRY(OpenSite site, open_site(folder, config));
    WEAVE_TRY(const auto tls, tls_of(folder, config));
    auto parts = std::make_unique<Parts>(std::move(site), config, settings);
    ServiceParts service;
    service.handlers = parts->handlers();
    service.session = [&accounts = parts->accounts](const std::string& token) { return accounts.who(token); };
    service.health = {{"store", [&desk = parts->desk]() -> Status {
                           const auto name =
                               desk.store().read([](const Reader& reader) { return reader.site(); });
                           return name ? Status() : Status(name.error());
                       }}};
    service.metrics = std::make_shared<net::Metrics>();
    service.version = WEAVE_VERSION;
    WEAVE_TRY(net::Router routes, service_routes(service));
    net::ServerOptions options;
    options.address = config.address;
    options.port = config.port;
    options.tls = tls;
    options.hosts = config.hosts;
    options.workers = config.workers;
    options.metrics = service.metrics;
    WEAVE_TRY(net::Server server, net::Server::start(std::move(routes), std::move(options)));
    parts->tls = tls;
    parts->server.emplace(std::move(server));
    return std::unique_ptr<RunningSite>(new RunningSite(std::move(parts)));
}

std::uint16_t RunningSite::port() const {
    return m_parts->server->port();
}

Result<Json> RunningSite::introduction() {
    const std::string url = origin_of(m_parts->config, port());
    Json told{{"site", m_parts->desk.site()}, {"url", url}};
    if (m_parts->tls) {
        WEAVE_TRY(const auto certificate, net::read_certificate(m_parts->tls->certificate));
        told["certificate_sha256"] = certificate.fingerprint;
    }
    WEAVE_TRY(const auto trust, m_parts->desk.store().read(newest_trust));
    if (trust) told["trust_sha256"] = trust->fingerprint();
    const auto invitation = m_parts->accounts.first_invitation();
    if (invitation)
        told["invitation"] = url + "/join#" + invitation->value("code", std::string());
    else if (denial_of(invitation.error()) != Denial::conflict)
        return invitation.error();
    return told;
}

void RunningSite::stop() {
    m_parts->server->stop(patience);
}

}  // namespace weave::loomlink

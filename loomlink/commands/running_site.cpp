#include <loomlink/commands/running_site.hpp>

#include <weave/command/service_places.hpp>
#include <weave/core/descriptor.hpp>
#include <weave/net/certificate.hpp>
#include <weave/net/server.hpp>

#include <chrono>
#include <loomlink/commands/head_keeper.hpp>
#include <loomlink/service/handlers.hpp>
#include <loomlink/service/service.hpp>
#include <optional>
#include <unistd.h>
#include <utility>

namespace weave::loomlink {

struct RunningSite::Parts {
    FolderLock lock;
    ServeConfig config;
    std::string name;
    std::string made_in;  ///< the folder of a site that is new; else empty
    std::unique_ptr<Workflow> workflow;
    std::optional<net::TlsFiles> tls;
    std::unique_ptr<HeadKeeper> heads;  ///< where a second place is configured
    Watchers watchers;
    std::optional<net::Server> server;  ///< last, so that it ends first
};

namespace {

constexpr std::chrono::seconds patience{10};

Status check_store(Workflow& workflow) {
    const auto name = workflow.store().read([](const Reader& reader) { return reader.site(); });
    return name ? Status() : Status(name.error());
}

ServiceParts service_of(Workflow& workflow, const Watchers& watchers, const HeadKeeper* heads) {
    ServiceParts service;
    service.handlers = workflow_handlers(workflow, watchers);
    service.session = [&workflow](const std::string& token) { return workflow.accounts().who(token); };
    service.refused = [&workflow](const Caller& caller, const std::string& request, const Deed& attempt,
                                  const Error& error) {
        static_cast<void>(workflow.refuse(caller, request, attempt, error));
    };
    service.health = {{"store", [&workflow] { return check_store(workflow); }},
                      {"writes", [&workflow] { return workflow.store().last_write(); }}};
    if (heads != nullptr) service.health.push_back({"heads", [heads] { return heads->status(); }});
    service.metrics = std::make_shared<net::Metrics>();
    service.version = WEAVE_VERSION;
    return service;
}

Status check_heads(const std::filesystem::path& heads) {
    std::error_code code;
    const auto folder = heads.has_parent_path() ? heads.parent_path() : ".";
    if (!std::filesystem::is_directory(folder, code) || std::filesystem::is_directory(heads, code))
        return bad_input("must be a file in a folder that is there", "heads: " + heads.string());
    const bool there = std::filesystem::exists(heads, code);
    if (::access(there ? heads.c_str() : folder.c_str(), there ? R_OK | W_OK : W_OK | X_OK) == 0) return {};
    return file_fault(heads, "write").in("heads");
}

}  // namespace

Status check_places(const ServeConfig& config) {
    WEAVE_CHECK_OK(check_service_places(config));
    return config.heads.empty() ? Status() : check_heads(config.heads);
}

RunningSite::RunningSite(std::unique_ptr<Parts> parts) : m_parts(std::move(parts)) {}

RunningSite::~RunningSite() = default;

Result<std::unique_ptr<RunningSite>> RunningSite::start(const SiteFolder& folder, const ServeConfig& config,
                                                        const DeskSettings& settings) {
    WEAVE_TRY(OpenSite site, open_site(folder, config));
    WEAVE_TRY(const auto tls, tls_of(folder.tls(), config));
    WEAVE_TRY(auto workflow, Workflow::open(std::move(site.store), std::move(site.keys), settings));
    auto parts = std::make_unique<Parts>(
        Parts{std::move(site.lock), config, std::move(site.name), {}, std::move(workflow), tls, {}, {}, {}});
    if (site.is_new) parts->made_in = folder.whole_path();
    if (!config.heads.empty()) {
        WEAVE_TRY(parts->heads, HeadKeeper::start(config.heads, [&flow = *parts->workflow] {
                      return flow.log_head();
                  }));
    }
    const ServiceParts service = service_of(*parts->workflow, parts->watchers, parts->heads.get());
    WEAVE_TRY(net::Router routes, service_routes(service));
    net::ServerOptions options = server_options(config, tls);
    options.metrics = service.metrics;
    WEAVE_TRY(net::Server server, net::Server::start(std::move(routes), std::move(options)));
    parts->server.emplace(std::move(server));
    return std::unique_ptr<RunningSite>(new RunningSite(std::move(parts)));
}

std::uint16_t RunningSite::port() const {
    return m_parts->server->port();
}

Result<Json> RunningSite::introduction() {
    const std::string url = origin_of(m_parts->config, port());
    Json told{{"site", m_parts->name}, {"url", url}};
    if (!m_parts->made_in.empty()) told["made_in"] = m_parts->made_in;
    if (m_parts->tls) {
        WEAVE_TRY(const auto certificate, net::read_certificate(m_parts->tls->certificate));
        told["certificate_sha256"] = certificate.fingerprint;
    }
    WEAVE_TRY(const auto trust, m_parts->workflow->store().read(newest_trust));
    if (trust) told["trust_sha256"] = trust->fingerprint();
    told["access_public"] = m_parts->workflow->accounts().access_key().at("public");
    const auto invitation = m_parts->workflow->accounts().first_invitation();
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

#include <loomlink/service/service.hpp>

#include <loomlink/service/gate.hpp>
#include <loomlink/service/page.hpp>
#include <utility>

namespace weave::loomlink {

namespace {

using net::Request;
using net::Response;

net::Route health_route(const std::vector<net::HealthCheck>& checks) {
    return {"health",
            "GET",
            "/healthz",
            "Whether the service can do its work",
            0,
            [checks](const Request&) {
                Response response = net::health_answer(checks);
                response.headers.set("Cache-Control", "no-store");
                return response;
            },
            {}};
}

net::Route metrics_route(const std::shared_ptr<net::Metrics>& metrics) {
    return {"metrics",
            "GET",
            "/metrics",
            "Numbers about the service, for Prometheus",
            0,
            [metrics](const Request&) {
                return net::answer(200, "text/plain; version=0.0.4; charset=utf-8",
                                   net::make_bytes(metrics->text()));
            },
            {}};
}

ApiHandler document_handler(const std::vector<ApiRoute>& table, const std::string& version) {
    const Response response = net::json_answer(200, openapi_document(table, version));
    return [response](const ApiCall&) { return response; };
}

}  // namespace

Result<net::Router> service_routes(const ServiceParts& parts) {
    const std::vector<ApiRoute> table = api_table();
    ApiHandlers handlers = parts.handlers;
    handlers.answers["openapi"] = document_handler(table, parts.version);
    const Gate gate(parts.session, parts.refused, parts.strangers);
    net::Router router;
    for (const ApiRoute& line : table) {
        WEAVE_TRY(net::Route route, gate.guarded(line, handlers));
        WEAVE_CHECK_OK(router.add(std::move(route)));
    }
    WEAVE_CHECK_OK(router.add(health_route(parts.health)));
    WEAVE_CHECK_OK(router.add(metrics_route(parts.metrics)));
    for (net::Route& route : page_routes()) WEAVE_CHECK_OK(router.add(std::move(route)));
    return router;
}

}  // namespace weave::loomlink

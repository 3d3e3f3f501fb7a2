#pragma once

#include <weave/net/health.hpp>
#include <weave/net/metrics.hpp>
#include <weave/net/router.hpp>
#include <weave/net/throttle.hpp>

#include <loomlink/service/table.hpp>
#include <memory>
#include <string>
#include <vector>

namespace weave::loomlink {

/// What the routes of the service are made from.
struct ServiceParts {
    ApiHandlers handlers;
    FindSession session;
    NoteRefusal refused;
    std::vector<net::HealthCheck> health;
    std::shared_ptr<net::Metrics> metrics;  ///< given out as /metrics
    std::string version;                    ///< of the program, for the API document
    /// How often one address may sign in, join or enrol.
    net::ThrottleRate strangers{60, 1, 10000};
};

/// All routes: the API of the table, its document, /healthz, /metrics, and the page. Error (system): a line
/// of the table has no handler.
Result<net::Router> service_routes(const ServiceParts& parts);

}  // namespace weave::loomlink

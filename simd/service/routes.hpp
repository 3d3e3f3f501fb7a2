#pragma once

#include <weave/net/metrics.hpp>
#include <weave/net/router.hpp>

#include <cstddef>
#include <memory>
#include <simd/daemon/daemon.hpp>
#include <simd/service/visitors.hpp>
#include <string>

namespace weave::simd {

/// What is served of a daemon: the protocol, files, its state for people and for machines, and a page. All must outlive the routes.
struct ServiceParts {
    Daemon& daemon;
    Doorkeeper& doorkeeper;
    std::shared_ptr<net::Metrics> metrics;
    std::string version;  ///< of the program
    std::size_t workers;  ///< threads that answer
};

Result<net::Router> service_routes(const ServiceParts& parts);

}  // namespace weave::simd

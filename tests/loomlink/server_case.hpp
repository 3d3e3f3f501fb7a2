#pragma once

// Tests of what only a server has: they start servers of their own, whatever WEAVE_TEST_STORE says.

#include "flow_case.hpp"

#include <support/postgres_server.hpp>

namespace weave::loomlink::testing {

/// Where it is true the test is over, and says so.
inline bool there_is_no_server() {
    if (!PostgresServer::is_installed()) WARN("skipped: no PostgreSQL server, or built without libpq");
    return !PostgresServer::is_installed();
}

/// A store on a server, and what is asked of it.
inline std::uint64_t log_size_of(const Store& store) {
    return got(store.read([](const Reader& reader) { return reader.log_size(); }));
}

}  // namespace weave::loomlink::testing

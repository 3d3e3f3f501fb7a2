#pragma once

#include <weave/net/message.hpp>

#include <functional>
#include <string>
#include <vector>

namespace weave::net {

/// One thing that must hold for the service to do its work, such as `store` or `disk`.
struct HealthCheck {
    std::string name;
    std::function<Status()> check;  ///< quick; an error says what is wrong
};

/// The answer of /healthz: 200 if all checks hold, else 503; `{"healthy": true, "checks": {"store": true}}`.
/// It says which check failed; why is told to the log alone, since anyone may ask.
Response health_answer(const std::vector<HealthCheck>& checks);

}  // namespace weave::net

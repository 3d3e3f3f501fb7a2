#include <weave/net/health.hpp>

#include <weave/core/log.hpp>
#include <weave/core/text.hpp>

namespace weave::net {

Response health_answer(const std::vector<HealthCheck>& checks) {
    bool healthy = true;
    Json results = Json::object();
    for (const HealthCheck& check : checks) {
        const Status status = check.check();
        results[check.name] = static_cast<bool>(status);
        if (status) continue;
        healthy = false;
        log(LogLevel::warning, "health: " + check.name + ": " + on_one_line(status.error().text()));
    }
    return json_answer(healthy ? 200 : 503, {{"healthy", healthy}, {"checks", results}});
}

}  // namespace weave::net

#pragma once

#include <weave/net/message.hpp>
#include <weave/net/websocket.hpp>

#include <functional>
#include <string>
#include <vector>

namespace weave::net {

/// Answers a request. Runs on a worker, so it may block; what it throws becomes a 500 and a line in the log.
using Handler = std::function<Response(const Request&)>;

/// Lets a WebSocket in, or answers why not. Runs on a worker before anything is agreed with the client.
using Admission = std::function<WebSocketAdmission(const Request&)>;

/// One line of the table from which requests are served, the OpenAPI document is made, and metrics take their
/// names.
struct Route {
    std::string name;            ///< unique, such as `design.read`: label of metrics, operationId
    std::string method;          ///< `GET`, `POST`, `PUT`, `PATCH` or `DELETE`; GET serves HEAD as well
    std::string pattern;         ///< `/api/v1/designs/{design}/file`; a {name} stands for one segment
    std::string description;     ///< one sentence for the API document
    std::size_t body_limit = 0;  ///< bytes of a request's body; of one message, if the route is a WebSocket's
    Handler handler;             ///< this one …
    Admission admission;         ///< … or this one, of a WebSocket (method GET)
};

/// Which route a request takes.
struct RouteMatch {
    const Route* route = nullptr;  ///< null: none; lives as long as the Router
    Parameters places;
    std::vector<std::string>
        allowed;  ///< without a route: the methods that the path knows; empty: no such path
};

/// The table of routes.
class Router {
  public:
    /// Adds a route. Errors (usage): a pattern that is malformed or repeats a {name}; a name or a pattern
    /// that is there already; not exactly one of handler and admission.
    Status add(Route route);

    /// The route for a decoded path. Where several patterns fit, the one with the earlier literal segment
    /// wins:
    /// `/designs/new` before `/designs/{design}`.
    [[nodiscard]] RouteMatch match(std::string_view method, std::string_view path) const;

    /// All routes, in the order in which they were added.
    [[nodiscard]] const std::vector<Route>& routes() const { return m_routes; }

  private:
    std::vector<Route> m_routes;
};

}  // namespace weave::net

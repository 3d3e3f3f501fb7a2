#pragma once

#include <weave/net/router.hpp>
#include <weave/wire/mill_client.hpp>

#include <functional>
#include <loomlink/service/fields.hpp>
#include <loomlink/service/visitor.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace weave::loomlink {

/// The place of a path that holds a number: `{n}` of `/designs/{design}/revisions/{n}`.
inline constexpr const char* number_place = "n";

/// A request that has passed the gate: its sender may ask this, and what it brings has the form that the
/// table names. What it asks for may still not be there, or not be the sender's.
struct ApiCall {
    const net::Request& request;
    Visitor visitor;  ///< nobody in particular where the route is open to anyone
    Json body;        ///< the fields of the body; empty for GET
    Json query;       ///< the fields of the query

    /// What stands in the path for {name}.
    [[nodiscard]] const std::string& place(std::string_view name) const { return request.place(name); }
    /// The number that stands in the path for {n}, from 1.
    [[nodiscard]] std::int64_t number() const;
    /// The caller's own id of this request.
    [[nodiscard]] std::string id() const { return body.value("request", std::string()); }
    /// A text of the body; empty where it is missing.
    [[nodiscard]] std::string text(const std::string& field) const;
    /// A number of the body; nothing where it is missing.
    [[nodiscard]] std::optional<std::int64_t> whole(const std::string& field) const;
};

/// One line of the table: routing, rights, the checks of a request, the API document and the names of metrics
/// are made from it alone. What answers it is found by its name.
struct ApiRoute {
    std::string name;  ///< such as `revision.approve`
    std::string method;
    std::string path;  ///< below /api/v1
    Access access;
    std::string description;  ///< a sentence
    std::string answers;      ///< in words, what a success answers
    Fields query{}, body{};
    std::string media = "application/json";  ///< of the answer
    std::size_t body_limit = 16384;          ///< bytes; of routes with a body
    bool is_socket = false;                  ///< a WebSocket

    /// How large a body, or a message of the WebSocket, may be.
    [[nodiscard]] std::size_t body_bytes() const;
};

/// Where the API begins, which its clients know.
inline constexpr const char* api_root = wire::mill_api_root;

/// Answers a call, or lets a WebSocket in.
using ApiHandler = std::function<net::Response(const ApiCall&)>;
using ApiAdmission = std::function<net::WebSocketAdmission(const ApiCall&)>;

/// What answers each line of the table, by its name.
struct ApiHandlers {
    std::map<std::string, ApiHandler> answers;
    std::map<std::string, ApiAdmission> sockets;
};

/// All lines, in the order of API.md.
std::vector<ApiRoute> api_table();

/// The line that serves parts of a card image.
ApiRoute card_route(const std::string& name, const std::string& path, const Access& who);

/// Parts of api_table().
std::vector<ApiRoute> people_table();
std::vector<ApiRoute> design_table();
std::vector<ApiRoute> loom_table();
std::vector<ApiRoute> audit_table();

/// The field that every changing call has, and those given.
Fields with_request(Fields fields);

/// The number that a text of a path stands for: from 1, written in one way only.
std::optional<std::int64_t> place_number(const std::string& text);

/// The names of the places of a path: `design` and `n` of `/designs/{design}/revisions/{n}`.
std::vector<std::string> places_of(const std::string& path);

/// OpenAPI 3.1 of the table.
Json openapi_document(const std::vector<ApiRoute>& table, const std::string& version);

}  // namespace weave::loomlink

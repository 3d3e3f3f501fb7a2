#include <loomlink/service/table.hpp>

#include <weave/core/text.hpp>

#include <loomlink/workflow/caller.hpp>

namespace weave::loomlink {

namespace {

Json roles_of(const Access& access) {
    if (access.kind == Access::Kind::anyone) return "anyone";
    if (access.kind == Access::Kind::signed_in) return "anyone signed in";
    Json roles = Json::array();
    for (const PersonRole role : access.roles) roles.push_back(role_word(role));
    return roles;
}

Json error_answer(const std::string& words) {
    return {{"description", words},
            {"content", {{"application/json", {{"schema", {{"$ref", "#/components/schemas/Error"}}}}}}}};
}

Json answers_of(const ApiRoute& route) {
    Json answers = Json::object();
    if (route.is_socket)
        answers["101"] = {{"description", route.answers}};
    else if (route.media.empty())
        answers["204"] = {{"description", route.answers}};
    else
        answers["200"] = {{"description", route.answers},
                          {"content", {{route.media, {{"schema", Json::object()}}}}}};
    answers["400"] = error_answer("Bad input");
    if (route.access.kind != Access::Kind::anyone) {
        answers["401"] = error_answer("Not signed in");
        answers["403"] = error_answer("Not yours");
    }
    if (route.path.find('{') != std::string::npos) answers["404"] = error_answer("Not there");
    if (!route.body.empty()) {
        answers["409"] = error_answer("The state does not allow it, or somebody else was first");
        answers["413"] = error_answer("Too large");
        answers["422"] = error_answer("The weave does not allow it");
        answers["429"] = error_answer("Too often");
    }
    answers["503"] = error_answer("Busy, or the store is out of reach; nothing was recorded");
    if (route.method != "GET") answers["504"] = error_answer("The store went while it recorded: it may be recorded, or not");
    return answers;
}

Json operation_of(const ApiRoute& route) {
    Json parameters = Json::array();
    for (const std::string& place : places_of(route.path))
        parameters.push_back(
            {{"name", place}, {"in", "path"}, {"required", true}, {"schema", {{"type", "string"}}}});
    for (const Field& field : route.query)
        parameters.push_back({{"name", field.name},
                              {"in", "query"},
                              {"required", field.required},
                              {"schema", schema_of(field)}});
    Json operation{{"operationId", route.name},
                   {"summary", route.description},
                   {"x-roles", roles_of(route.access)},
                   {"parameters", std::move(parameters)}};
    if (!route.body.empty())
        operation["requestBody"] = {{"required", true},
                                    {"content", {{"application/json", {{"schema", schema_of(route.body)}}}}}};
    operation["responses"] = answers_of(route);
    if (route.access.kind == Access::Kind::anyone) operation["security"] = Json::array();
    return operation;
}

Json components() {
    const Json text{{"type", "string"}};
    const Json error{{"type", "object"},
                     {"properties",
                      {{"error",
                        {{"type", "object"},
                         {"properties", {{"kind", text}, {"where", text}, {"message", text}}},
                         {"required", {"kind", "where", "message"}}}}}},
                     {"required", {"error"}}};
    return {{"schemas", {{"Error", error}}},
            {"securitySchemes",
             {{"token", {{"type", "http"}, {"scheme", "bearer"}}},
              {"page",
               {{"type", "apiKey"},
                {"in", "cookie"},
                {"name", "loomlink"},
                {"description", "All but GET need the header X-CSRF-Token beside it"}}}}}};
}

}  // namespace

std::optional<std::int64_t> place_number(const std::string& text) {
    const auto number = parse_whole(text);
    if (!number || *number < 1 || std::to_string(*number) != text) return {};
    return number;
}

std::int64_t ApiCall::number() const {
    return place_number(place(number_place)).value_or(0);  // the gate let nothing else pass
}

std::string ApiCall::text(const std::string& field) const {
    return body.value(field, std::string());
}

std::size_t ApiRoute::body_bytes() const {
    constexpr std::size_t message_bytes = 1024;
    if (is_socket) return message_bytes;
    return body.empty() ? 0 : body_limit;
}

std::optional<std::int64_t> ApiCall::whole(const std::string& field) const {
    if (!body.contains(field)) return {};
    return body[field].get<std::int64_t>();
}

Fields with_request(Fields fields) {
    fields.insert(fields.begin(),
                  {"request",
                   "An id of the caller's choice: the same id again gives the same answer and "
                   "changes nothing",
                   FieldKind::text, true, 8, 64});
    return fields;
}

std::vector<ApiRoute> api_table() {
    std::vector<ApiRoute> table;
    for (auto part : {people_table(), loom_table(), design_table(), audit_table()})
        table.insert(table.end(), part.begin(), part.end());
    return table;
}

std::vector<std::string> places_of(const std::string& path) {
    std::vector<std::string> places;
    for (std::size_t open = path.find('{'); open != std::string::npos; open = path.find('{', open + 1))
        places.push_back(path.substr(open + 1, path.find('}', open) - open - 1));
    return places;
}

Json openapi_document(const std::vector<ApiRoute>& table, const std::string& version) {
    Json paths = Json::object();
    for (const ApiRoute& route : table) {
        std::string method = route.method;
        for (char& c : method) c = static_cast<char>(c - 'A' + 'a');
        paths[route.path][method] = operation_of(route);
    }
    return {{"openapi", "3.1.0"},
            {"info", {{"title", "loomlink"}, {"version", version}}},
            {"servers", Json::array({{{"url", api_root}}})},
            {"security", Json::array({{{"token", Json::array()}}, {{"page", Json::array()}}})},
            {"paths", std::move(paths)},
            {"components", components()}};
}

}  // namespace weave::loomlink

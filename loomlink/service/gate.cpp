#include <loomlink/service/gate.hpp>

#include <weave/core/log.hpp>
#include <weave/core/text.hpp>
#include <weave/keys/secret_bytes.hpp>

#include <loomlink/service/deeds.hpp>
#include <loomlink/store/reach.hpp>
#include <loomlink/workflow/denial.hpp>
#include <utility>
#include <variant>

namespace weave::loomlink {

namespace {

using net::Request;
using net::Response;

Response declined(int status, std::string why, std::string where = {}) {
    Response response = net::error_answer({ErrorCode::refused, std::move(why), std::move(where)}, status);
    if (status == 401) response.headers.set("WWW-Authenticate", "Bearer");
    return response;
}

bool changes_something(const ApiRoute& route) {
    return route.method != "GET";
}

/// The token that a program shows; nothing where there is no such header, empty where it is no such token.
std::optional<std::string> shown_token(const Request& request) {
    std::optional<std::string> token;
    for (const auto& [name, value] : request.headers) {
        if (!net::equal_without_case(name, "Authorization")) continue;
        if (token) return std::string();
        constexpr std::string_view scheme = "Bearer ";
        const bool bearer = value.size() > scheme.size() &&
                            net::equal_without_case(std::string_view(value).substr(0, scheme.size()), scheme);
        token = bearer ? value.substr(scheme.size()) : std::string();
    }
    return token;
}

/// No token is longer, so nothing longer is looked up.
constexpr std::size_t longest_token = 128;

Error turned_away(std::string why, std::string where = {}) {
    return {ErrorCode::refused, std::move(why), std::move(where)};
}

/// The body of a request that is sent away, as far as it can be read; what is large is not looked at.
Json body_of(const Request& request) {
    constexpr std::size_t most_read = 16384;
    if (request.body.size() > most_read) return Json::object();
    const auto read = parse_json(request.body);
    return read && read->is_object() ? *read : Json::object();
}

/// What a request that is sent away asked for, by the places that its path, its query and its body name.
Deed attempt_of(const ApiRoute& route, const Request& request, const Json& body) {
    Deed deed{deed_of_route(route.name), {}, {}, body};
    for (const auto& [name, text] : request.query) deed.data.emplace(name, text);
    const auto path_has = [&](const char* part) { return route.path.find(part) != std::string::npos; };
    for (const std::string& place : places_of(route.path)) {
        const std::string& text = request.place(place);
        if (place == number_place) {
            const auto number = place_number(text);
            deed.data[path_has("/revisions/") ? "revision" : "release"] = number ? Json(*number) : Json(text);
        } else if (place == "name") {
            if (path_has("/files/"))
                deed.data["file"] = text;
            else
                deed.subject = text;
        } else {
            deed.data[place] = text;
        }
    }
    const auto design = deed.data.find("design");
    if (design != deed.data.end() && design->is_string()) {
        deed.subject = design->get<std::string>();
        deed.data.erase(design);
    }
    return deed;
}

}  // namespace

class Gate::Keeper {
  public:
    Keeper(FindSession find, NoteRefusal refused, const net::ThrottleRate& strangers)
        : m_find(std::move(find)), m_refused(std::move(refused)), m_strangers(strangers) {}

    /// The call, or the answer that sends its sender away.
    std::variant<ApiCall, Response> let_in(const ApiRoute& route, const Request& request) {
        std::variant<Visitor, Response> met = meet(route, request);
        if (auto* away = std::get_if<Response>(&met)) return std::move(*away);
        ApiCall call{request, std::move(std::get<Visitor>(met)), Json::object(), Json::object()};
        const Status right = check_right(route, call);
        const Status fits = right ? read_form(route, call) : right;
        if (fits) return call;
        if (call.visitor.caller().id != 0) note(route, call, fits.error());
        const int no_form = route.body.empty() || is_json(request) ? 400 : 415;
        return net::error_answer(fits.error(), right ? no_form : 403);
    }

  private:
    static Status check_right(const ApiRoute& route, const ApiCall& call) {
        const std::string& csrf = call.visitor.session.csrf;
        const bool of_our_page =
            !csrf.empty() && equal_secrets(csrf, call.request.headers.get("X-CSRF-Token"));
        if (call.visitor.by_cookie && changes_something(route) && !of_our_page)
            return turned_away("the page's own token is missing; load the page again", "X-CSRF-Token");
        if (!route.access.allows(call.visitor.caller())) return turned_away("your roles do not allow this");
        return {};
    }

    /// Reads query and body where the request has the form of the route.
    static Status read_form(const ApiRoute& route, ApiCall& call) {
        const Request& request = call.request;
        if (!route.body.empty() && !is_json(request))
            return bad_input("the body must be application/json", "Content-Type");
        if (route.body.empty() && !request.body.empty()) return bad_input("this takes no body");
        for (const std::string& place : places_of(route.path))
            if (place == number_place && !place_number(request.place(place)))
                return bad_input("must be a whole number from 1 on", place);
        WEAVE_TRY(call.query, read_query(request.query, route.query));
        if (route.body.empty()) return {};
        WEAVE_TRY(call.body, read_body(request.body, route.body));
        return {};
    }

    void note(const ApiRoute& route, const ApiCall& call, const Error& error) {
        const Json body = body_of(call.request);
        const auto id = body.find("request");
        m_refused(call.visitor.caller(),
                  id != body.end() && id->is_string() ? id->get<std::string>() : std::string(),
                  attempt_of(route, call.request, body), error);
    }

    static bool is_json(const Request& request) {
        const std::string_view type = request.headers.get("Content-Type");
        const std::string_view media = type.substr(0, type.find(';'));
        return net::equal_without_case(media.substr(0, media.find_last_not_of(' ') + 1), "application/json");
    }

    std::variant<Visitor, Response> meet(const ApiRoute& route, const Request& request) {
        if (changes_something(route) && !net::from_own_pages(request))
            return declined(403, "a page of another server sent this", "Origin");
        if (route.access.kind == Access::Kind::anyone) return stranger(route, request);
        const auto token = shown_token(request);
        const auto kept = token ? std::nullopt : request.cookie(session_cookie);
        if (!token && !kept) return declined(401, "sign in first");
        const std::string& shown = token ? *token : *kept;
        if (shown.empty() || shown.size() > longest_token) return declined(401, "sign in first");
        auto found = m_find(shown);
        if (!found) return trouble_answer(found.error());
        return Visitor{*std::move(found), shown, request.peer, kept.has_value()};
    }

    std::variant<Visitor, Response> stranger(const ApiRoute& route, const Request& request) {
        Visitor nobody;
        nobody.address = request.peer;
        if (!changes_something(route) || m_strangers.take(request.peer)) return nobody;
        Response response = declined(429, "too often from this address; wait a little");
        response.headers.set("Retry-After", std::to_string(m_strangers.wait(request.peer).count()));
        return response;
    }

    FindSession m_find;
    NoteRefusal m_refused;
    net::Throttle m_strangers;
};

namespace {

/// What a person is to do about it; the cause is for the log.
net::Response lost_answer(Lost when, const Error& error) {
    log(LogLevel::warning, "a request failed: " + on_one_line(error.text()));
    if (when == Lost::before)
        return net::error_answer(system_fault("the store is out of reach: nothing was recorded; repeat it once the store is back (the "
                                              "server's log says what is wrong)"),
                                 503);
    return net::error_answer(system_fault("the store went while this was being recorded: it may be recorded, or not; look before you "
                                          "repeat it (the server's log says what is wrong)"),
                             504);
}

}  // namespace

net::Response trouble_answer(const Error& error) {
    if (const auto lost = lost_of(error)) return lost_answer(*lost, error);
    const auto denial = denial_of(error);
    if (!denial) return net::error_answer(error);
    switch (*denial) {
        case Denial::who:
            return declined(401, error.message);
        case Denial::password:
        case Denial::rights:
            break;
        case Denial::absent:
            return net::error_answer(error, 404);
        case Denial::conflict:
            return net::error_answer(error, 409);
        case Denial::often:
            return net::error_answer(error, 429);
    }
    return net::error_answer(error, 403);
}

Gate::Gate(FindSession find, NoteRefusal refused, const net::ThrottleRate& strangers)
    : m_keeper(std::make_shared<Keeper>(std::move(find), std::move(refused), strangers)) {}

Result<net::Route> Gate::guarded(const ApiRoute& route, const ApiHandlers& handlers) const {
    net::Route made{
        route.name, route.method, api_root + route.path, route.description, route.body_bytes(), {}, {}};
    if (route.is_socket) {
        const auto found = handlers.sockets.find(route.name);
        if (found == handlers.sockets.end()) return system_fault("nothing answers this route", route.name);
        made.admission = [keeper = m_keeper, route,
                          admit = found->second](const Request& request) -> net::WebSocketAdmission {
            auto entered = keeper->let_in(route, request);
            if (auto* away = std::get_if<Response>(&entered)) return std::move(*away);
            return admit(std::get<ApiCall>(entered));
        };
        return made;
    }
    const auto found = handlers.answers.find(route.name);
    if (found == handlers.answers.end()) return system_fault("nothing answers this route", route.name);
    made.handler = [keeper = m_keeper, route, answer = found->second](const Request& request) {
        auto entered = keeper->let_in(route, request);
        auto* const away = std::get_if<Response>(&entered);
        Response response = away != nullptr ? std::move(*away) : answer(std::get<ApiCall>(entered));
        if (response.headers.find("Cache-Control") == nullptr)
            response.headers.set("Cache-Control", "no-store");
        return response;
    };
    return made;
}

}  // namespace weave::loomlink

#include "service_case.hpp"

#include <weave/core/file.hpp>
#include <weave/net/websocket_client.hpp>

#include <algorithm>
#include <filesystem>
#include <loomlink/service/deeds.hpp>
#include <loomlink/workflow/refusals.hpp>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;

namespace {

/// Who may what, written from API.md and workflow/README.md, not from the table: d designer, a approver,
/// o operator, e engineer, m admin; `all` is whoever signed in, `any` anybody.
const std::map<std::string, std::string> expected{
    {"POST /login", "any"},
    {"POST /logout", "all"},
    {"GET /me", "all"},
    {"GET /me/waiting", "all"},
    {"POST /me/password", "all"},
    {"POST /access-tokens", "daem"},
    {"GET /access-key", "all"},
    {"POST /invitations", "m"},
    {"POST /invitations/accept", "any"},
    {"GET /people", "m"},
    {"POST /people/{name}/roles", "m"},
    {"POST /people/{name}/disable", "m"},
    {"POST /people/{name}/enable", "m"},
    {"POST /people/{name}/reset", "m"},
    {"GET /policy", "all"},
    {"PUT /policy", "m"},
    {"GET /looms", "all"},
    {"POST /looms", "m"},
    {"GET /looms/{loom}", "all"},
    {"PUT /looms/{loom}/profile", "m"},
    {"PUT /looms/{loom}/operators", "m"},
    {"GET /designs", "dae"},
    {"POST /designs", "d"},
    {"GET /designs/{design}", "dae"},
    {"POST /designs/{design}/revisions", "d"},
    {"GET /designs/{design}/revisions/{n}", "dae"},
    {"GET /designs/{design}/revisions/{n}/document", "dae"},
    {"GET /designs/{design}/revisions/{n}/picture", "dae"},
    {"GET /designs/{design}/revisions/{n}/card", "dae"},
    {"GET /designs/{design}/revisions/{n}/check", "dae"},
    {"GET /designs/{design}/revisions/{n}/bundle", "e"},
    {"POST /designs/{design}/revisions/{n}/submit", "d"},
    {"POST /designs/{design}/revisions/{n}/comment", "da"},
    {"POST /designs/{design}/revisions/{n}/request-changes", "a"},
    {"POST /designs/{design}/revisions/{n}/waive", "a"},
    {"POST /designs/{design}/revisions/{n}/approve", "a"},
    {"POST /designs/{design}/revisions/{n}/evidence", "any"},
    {"GET /designs/{design}/diff", "dae"},
    {"GET /designs/{design}/diff.png", "dae"},
    {"POST /releases", "a"},
    {"POST /looms/{loom}/releases/{n}/sign", "a"},
    {"POST /looms/{loom}/releases/{n}/withdraw", "ae"},
    {"GET /looms/{loom}/index", "daeo"},
    {"GET /looms/{loom}/releases/{n}", "daeo"},
    {"GET /looms/{loom}/releases/{n}/manifest", "daeo"},
    {"GET /looms/{loom}/releases/{n}/files/{name}", "daeo"},
    {"GET /looms/{loom}/releases/{n}/card", "daeo"},
    {"GET /looms/{loom}/releases/{n}/picks", "daeo"},
    {"PUT /looms/{loom}/place", "o"},
    {"POST /looms/{loom}/loaded", "o"},
    {"POST /looms/{loom}/faults", "o"},
    {"GET /looms/{loom}/faults", "daeo"},
    {"GET /looms/{loom}/watch", "daeo"},
    {"GET /events", "e"},
    {"GET /audit/head", "e"},
    {"GET /audit/inclusion", "e"},
    {"GET /audit/consistency", "e"},
    {"GET /audit/bundle", "e"},
    {"GET /signers", "m"},
    {"POST /signers", "m"},
    {"POST /signers/enrol", "any"},
    {"POST /signers/{name}/revoke", "m"},
    {"GET /trust", "all"},
    {"GET /trust/pending", "m"},
    {"POST /trust", "m"},
    {"GET /openapi.json", "any"},
};

const std::map<char, PersonRole> roles{{'d', PersonRole::designer},
                                       {'a', PersonRole::approver},
                                       {'o', PersonRole::operator_},
                                       {'e', PersonRole::engineer},
                                       {'m', PersonRole::administrator}};

/// A request to an operation of the API document as it asks for it.
struct Sample {
    std::string method, target, body;
    net::Headers headers;
};

Sample sample_for(const std::string& path, const std::string& method, const Json& operation) {
    Sample sample{method, api_root + filled(path), {}, {}};
    for (char& c : sample.method) c = static_cast<char>(c - 'a' + 'A');
    char mark = '?';
    for (const auto& parameter : operation.at("parameters")) {
        if (parameter["in"] != "query" || !parameter["required"].get<bool>()) continue;
        const Json value = sample_of(parameter["schema"]);
        sample.target += mark + parameter["name"].get<std::string>() + "=" +
                         (value.is_string() ? value.get<std::string>() : value.dump());
        mark = '&';
    }
    if (operation.contains("requestBody")) {
        sample.body = sample_of(operation["requestBody"]["content"]["application/json"]["schema"]).dump();
        sample.headers.set("Content-Type", "application/json");
    }
    return sample;
}

struct Rights {
    StubService service;
    std::optional<net::HttpClient> client;
    Json document;

    Rights() {
        Id id = 0;
        for (const auto& [letter, role] : roles)
            service.sessions[std::string("token-") + letter] = {
                {++id, std::string(1, letter), "Somebody", {role}}, std::string("csrf-") + letter, ""};
        service.sessions["token-nothing"] = {{++id, "n", "Nobody", {}}, "csrf-nothing", ""};
        service.start();
        client.emplace(service.client_options());
        document = json_of(ask(*client, "GET", "/api/v1/openapi.json"));
    }

    int status(const Sample& sample, const net::Headers& credentials) {
        net::Headers headers = sample.headers;
        for (const auto& [name, value] : credentials) headers.set(name, value);
        return ask(*client, sample.method, sample.target, headers, sample.body).status;
    }
};

bool is_allowed(const std::string& who, char letter) {
    return who == "any" || who == "all" || who.find(letter) != std::string::npos;
}

}  // namespace

TEST_CASE("every route lets in whom it should, by every way to sign in, and nobody else") {
    Rights rights;
    std::size_t operations = 0;
    for (const auto& [path, methods] : rights.document.at("paths").items()) {
        for (const auto& [method, operation] : methods.items()) {
            const Sample sample = sample_for(path, method, operation);
            const std::string line = sample.method + " " + path;
            INFO(line);
            REQUIRE(expected.contains(line));
            const std::string& who = expected.at(line);
            const bool is_open = who == "any", reads = sample.method == "GET";
            // The stub cannot be upgraded to from here: who is let in is told to upgrade.
            const int done = path.ends_with("/watch") ? 426 : 200;
            const auto away = [&](int refusal) { return is_open ? done : done == 426 ? 426 : refusal; };
            ++operations;
            CHECK(rights.status(sample, {}) == away(401));
            for (const char* token : {"Bearer expired", "Bearer ", "Bearer", "Basic dG9rZW4tbTp4", "token-m",
                                      "Bearer token-m x", "Bearer token-"})
                CHECK(rights.status(sample, {{"Authorization", token}}) == away(401));
            CHECK(rights.status(sample, {{"Cookie", "loomlink=expired"}, {"X-CSRF-Token", "csrf-m"}}) ==
                  away(401));
            for (const auto& [letter, role] : roles) {
                const std::string token = std::string("token-") + letter,
                                  csrf = std::string("csrf-") + letter;
                const int mine = is_allowed(who, letter) ? done : away(403);
                const int unasked = reads ? mine : away(403);
                const std::string other = letter == 'm' ? "csrf-d" : "csrf-m";
                CHECK(rights.status(sample, {{"Authorization", "Bearer " + token}}) == mine);
                CHECK(rights.status(sample, {{"Cookie", "loomlink=" + token}, {"X-CSRF-Token", csrf}}) ==
                      mine);
                CHECK(rights.status(sample, {{"Cookie", "loomlink=" + token}}) == unasked);
                CHECK(rights.status(sample, {{"Cookie", "loomlink=" + token}, {"X-CSRF-Token", other}}) ==
                      unasked);
                CHECK(rights.status(sample, {{"Cookie", "loomlink=" + token}, {"X-CSRF-Token", ""}}) ==
                      unasked);
                CHECK(rights.status(sample, {{"Cookie", "loomlink=expired; loomlink=" + token},
                                             {"X-CSRF-Token", csrf}}) == away(401));
                if (!reads)
                    CHECK(rights.status(sample, {{"Authorization", "Bearer " + token},
                                                 {"Origin", "https://elsewhere.example"}}) == 403);
            }
            const bool signed_in_is_enough = is_open || who == "all";
            CHECK(rights.status(sample, {{"Authorization", "Bearer token-nothing"}}) ==
                  (signed_in_is_enough ? done : away(403)));
        }
    }
    CHECK(operations == expected.size());
}

TEST_CASE("a watcher is let in, or told why not, like anybody who asks") {
    Rights rights;
    const auto try_to_watch = [&](const net::Headers& headers) {
        return net::WebSocketClient::connect(rights.service.client_options(), "/api/v1/looms/x/watch",
                                             headers);
    };
    for (const auto& [letter, role] : roles) {
        const std::string token = std::string("token-") + letter;
        const bool allowed = is_allowed(expected.at("GET /looms/{loom}/watch"), letter);
        CHECK(bool(try_to_watch({{"Authorization", "Bearer " + token}})) == allowed);
        CHECK(bool(try_to_watch({{"Cookie", "loomlink=" + token}})) == allowed);
    }
    for (const auto& outcome : {try_to_watch({}), try_to_watch({{"Authorization", "Bearer forged"}})}) {
        REQUIRE_FALSE(outcome);
        CHECK_THAT(outcome.error().text(), Catch::Contains("401"));
    }
}

TEST_CASE("watchers hear of their own loom, and are sent away once they may no longer watch") {
    Rights rights;
    auto watch = [&](const std::string& loom) {
        auto client =
            net::WebSocketClient::connect(rights.service.client_options(), "/api/v1/looms/" + loom + "/watch",
                                          {{"Authorization", "Bearer token-o"}});
        REQUIRE(client);
        return *std::move(client);
    };
    auto seven = watch("seven"), eight = watch("eight");
    const auto hears = [&](net::WebSocketClient& client, const std::string& loom) {
        for (int tries = 0; tries < 200; ++tries) {  // until the service has taken it on
            rights.service.watchers.tell(loom);
            const auto message = client.receive(std::chrono::milliseconds(50));
            if (message && *message) return parse_json((*message)->bytes).value();
        }
        return Json();
    };
    CHECK(hears(seven, "seven") == Json{{"loom", "seven"}, {"changed", "index"}});
    CHECK(hears(eight, "eight") == Json{{"loom", "eight"}, {"changed", "index"}});
    rights.service.may_watch = false;
    rights.service.watchers.tell_all();
    while (const auto message = seven.receive(std::chrono::seconds(20)))
        REQUIRE(*message);  // what was still on its way
    REQUIRE(seven.end());
    CHECK(seven.end()->code == 1008);
}

TEST_CASE("the table of routes and what is expected of it name the same routes") {
    std::vector<std::string> lines;
    for (const ApiRoute& line : api_table()) lines.push_back(line.method + " " + line.path);
    for (const auto& [line, who] : expected) CHECK(std::count(lines.begin(), lines.end(), line) == 1);
    CHECK(lines.size() == expected.size());
}

TEST_CASE("a refusal has one word in the log: the one of the deed, whoever refuses it") {
    const auto page = read_file(std::filesystem::path(WEAVE_SOURCE_DIR) / "loomlink/web/views/log.js");
    REQUIRE(page);
    for (const ApiRoute& route : api_table()) {
        const std::string deed = deed_of_route(route.name);
        INFO(route.name << " is logged as " << deed);
        CHECK(page->find("'" + deed + "': ") != std::string::npos);
    }
}

TEST_CASE("whom the gate sends away is told of with what was asked for, and who is not signed in is not") {
    Rights rights;
    const auto send = [&](const std::string& token, const std::string& method, const std::string& target,
                          const std::string& body = {}) {
        net::Headers headers{{"Authorization", "Bearer " + token}};
        if (!body.empty()) headers.set("Content-Type", "application/json");
        return ask(*rights.client, method, api_root + target, headers, body).status;
    };
    const auto told = [&] {
        const auto all = rights.service.take_refusals();
        REQUIRE(all.size() == 1);
        return all[0];
    };
    CHECK(send("token-d", "POST", "/designs/shoe/revisions/3/approve",
               R"({"request":"request-1","reason":"good","password":"a pass phrase"})") == 403);
    ToldRefusal refusal = told();
    CHECK(refusal.login == "d");
    CHECK(refusal.request == "request-1");
    CHECK(sorted(refusal_record(refusal.attempt, refusal.error).data) ==
          sorted(Json{{"what", "revision.approved"}, {"revision", 3}}));
    CHECK(refusal.attempt.subject == "shoe");
    CHECK(refusal.error.code == ErrorCode::refused);

    CHECK(send("token-e", "GET", "/looms/EP%201/releases/2/files/a.jc5?x=1") == 400);
    refusal = told();
    CHECK(sorted(refusal_record(refusal.attempt, refusal.error).data) ==
          sorted(Json{{"what", "release.pulled"}, {"loom", "EP 1"}, {"release", 2}, {"file", "a.jc5"}}));
    CHECK(send("token-d", "POST", "/releases",
               R"({"request":"request-2","design":"shoe","revision":4,"loom":"EP 1","feeders":[1]})") == 403);
    refusal = told();
    CHECK(refusal.attempt.subject == "shoe");
    CHECK(sorted(refusal_record(refusal.attempt, refusal.error).data) ==
          sorted(Json{{"what", "release.made"}, {"revision", 4}, {"loom", "EP 1"}, {"feeders", {1}}}));
    CHECK(send("token-d", "GET", "/designs/shoe/revisions/first") == 400);
    CHECK(refusal_record(told().attempt, {}).data.at("revision") == "first");
    CHECK(send("token-m", "POST", "/people/mary/disable", "{") == 400);
    CHECK(told().attempt.subject == "mary");
    CHECK(send("token-nothing", "GET", "/designs/shoe") == 403);
    CHECK(told().login == "n");
    CHECK(ask(*rights.client, "POST", "/api/v1/logout",
              {{"Cookie", "loomlink=token-d"}, {"Content-Type", "application/json"}},
              R"({"request":"request-3"})")
              .status == 403);
    CHECK(told().attempt.kind == "person.signed_out");

    CHECK(send("forged", "POST", "/releases", R"({"request":"request-4"})") == 401);
    CHECK(send("token-d", "POST", "/login", R"({"request":7})") == 400);
    CHECK(ask(*rights.client, "GET", "/api/v1/people").status == 401);
    CHECK(rights.service.take_refusals().empty());
}

#include "api_case.hpp"

#include <weave/core/sha256.hpp>
#include <weave/design/document.hpp>
#include <weave/net/websocket_client.hpp>
#include <weave/samples/samples.hpp>

#include <sys/stat.h>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;
using weave::testing::TemporaryFolder;

namespace {

std::string sample_document(const char* name) {
    return write_document(find_sample(name)->make());
}

bool is_png(const net::Response& response) {
    return response.status == 200 && response.headers.get("Content-Type") == "image/png" &&
           response.body->starts_with("\x89PNG");
}

}  // namespace

TEST_CASE("an empty folder becomes a site with one invitation, and opens again as the same") {
    ApiMill mill;
    for (const char* file : {stores_are_on_server() ? "store.url" : "loomlink.db", "log.key", "stamp.key", "access.key", "tls.key"}) {
        struct stat facts {};
        REQUIRE(::stat((mill.folder.path / "site" / file).c_str(), &facts) == 0);
        CHECK((facts.st_mode & 077) == 0);
    }
    CHECK_THAT(mill.introduction.at("invitation").get<std::string>(), Catch::Contains("/join#"));
    const auto second = RunningSite::start({mill.folder.path / "site"}, {});
    REQUIRE_FALSE(second);
    CHECK_THAT(second.error().text(), Catch::Contains("another loomlink"));
    mill.join(mill.first_code(), "mary");
    CHECK(mill.done("mary", "GET", "/me").at("person").at("roles") == Json::array({"admin"}));
    const std::string fingerprint = mill.introduction.at("certificate_sha256").get<std::string>();
    mill.site.reset();
    mill.start();
    CHECK(mill.introduction.at("certificate_sha256") == fingerprint);
    CHECK_FALSE(mill.introduction.contains("invitation"));
    CHECK(mill.done("mary", "GET", "/me").at("person").at("name") == "mary");
}

TEST_CASE("a folder that holds other things is refused and left as it is") {
    TemporaryFolder folder;
    REQUIRE(write_file(folder.path / "letter.txt", "dear"));
    const auto started = RunningSite::start({folder.path}, {});
    REQUIRE_FALSE(started);
    CHECK(started.error().code == ErrorCode::refused);
    CHECK(read_file(folder.path / "letter.txt").value() == "dear");
    CHECK(folder.entries() == 1);
}

TEST_CASE("the cookie keeps the page signed in, with its own token, until it signs out") {
    ApiMill mill;
    mill.join(mill.first_code(), "mary");
    const net::Headers typed{{"Content-Type", "application/json"}};
    const auto answer =
        ask(*mill.client, "POST", "/api/v1/login", typed,
            Json{{"request", "12345678"}, {"name", "mary"}, {"password", api_password}}.dump());
    REQUIRE(answer.status == 200);
    const std::string cookie(answer.headers.get("Set-Cookie"));
    for (const char* part : {"loomlink=", "; HttpOnly", "; SameSite=Strict", "; Secure", "; Path=/"})
        CHECK_THAT(cookie, Catch::Contains(part));
    net::Headers page{{"Content-Type", "application/json"}, {"Cookie", cookie.substr(0, cookie.find(';'))}};
    const Json me = json_of(ask(*mill.client, "GET", "/api/v1/me", page));
    CHECK(me.at("csrf") == json_of(answer).at("csrf"));
    const std::string leave = Json{{"request", "87654321"}}.dump();
    CHECK(ask(*mill.client, "POST", "/api/v1/logout", page, leave).status == 403);
    page.set("X-CSRF-Token", me.at("csrf").get<std::string>());
    const auto left = ask(*mill.client, "POST", "/api/v1/logout", page, leave);
    CHECK(left.status == 200);
    CHECK_THAT(std::string(left.headers.get("Set-Cookie")), Catch::Contains("Max-Age=0"));
    CHECK(ask(*mill.client, "GET", "/api/v1/me", page).status == 401);
    CHECK(ask(*mill.client, "POST", "/api/v1/login", typed,
              Json{{"request", "12345679"}, {"name", "mary"}, {"password", "wrong"}}.dump())
              .status == 401);
}

TEST_CASE("who is disabled is signed out, and tokens of one person do not serve another") {
    ApiMill mill;
    mill.join(mill.first_code(), "mary");
    mill.invite("dora", {"designer"});
    CHECK(mill.status("dora", "GET", "/designs") == 200);
    CHECK(mill.status("dora", "GET", "/people") == 403);
    CHECK(mill.status("mary", "GET", "/designs") == 403);
    mill.done("mary", "POST", "/people/dora/disable");
    CHECK(mill.status("dora", "GET", "/designs") == 401);
    mill.done("mary", "POST", "/people/dora/enable");
    CHECK(mill.status("mary", "POST", "/people/nobody/disable") == 404);
    const Json policy = mill.done("mary", "GET", "/policy");
    Json wish = policy;
    wish["approvals"] = 2;
    mill.done("mary", "PUT", "/policy", wish);
    CHECK(mill.done("dora", "POST", "/login", {{"name", "dora"}, {"password", api_password}})
              .contains("token"));
}

TEST_CASE("a design goes its way from a first revision to the loom and back, over HTTP") {
    ApiMill mill;
    mill.people_and_a_loom();
    mill.invite("olga", {"operator"});
    mill.done("mary", "POST", "/looms",
              {{"name", "eight"}, {"profile", read_file(WEAVE_SOURCE_DIR "/db/looms/tc2.json").value()}});
    mill.done("mary", "PUT", "/looms/eight/operators", {{"operators", {"olga"}}});

    mill.done("dora", "POST", "/designs", {{"name", "cloth"}});
    const Json wish{{"request", "save-cloth-1"},
                    {"document", sample_document("twill-2-2")},
                    {"branch", "main"},
                    {"message", "First"}};
    const Json saved = mill.done("dora", "POST", "/designs/cloth/revisions", wish);
    CHECK(saved.at("number") == 1);
    CHECK(mill.done("dora", "POST", "/designs/cloth/revisions", wish) == saved);
    const Json stale{{"document", sample_document("plain")}, {"branch", "main"}, {"message", "Late"}};
    CHECK(mill.status("dora", "POST", "/designs/cloth/revisions", stale) == 409);
    CHECK(mill.status("dora", "POST", "/designs/cloth/revisions",
                      {{"document", "{}"}, {"branch", "main"}, {"message", "No"}, {"expected", 1}}) == 400);
    Json second = stale;
    second["expected"] = 1;
    CHECK(mill.done("dora", "POST", "/designs/cloth/revisions", second).at("number") == 2);

    const std::string path = "/designs/cloth/revisions/1";
    CHECK(is_png(mill.call("emil", "GET", path + "/picture?view=face")));
    CHECK(is_png(mill.call("emil", "GET", path + "/card?x=0&y=0&w=2&h=2")));
    CHECK(mill.status("emil", "GET", path + "/card?x=0&y=0&w=9999&h=1") == 400);
    CHECK(is_png(mill.call("emil", "GET", "/designs/cloth/diff.png?from=1&to=2")));
    CHECK(mill.done("emil", "GET", "/designs/cloth/diff?from=1&to=2").at("equal") == false);
    const auto document = mill.call("emil", "GET", path + "/document");
    CHECK(*document.body == sample_document("twill-2-2"));
    CHECK(document.headers.get("Content-Disposition") == "attachment; filename=\"cloth-1.weave\"");
    CHECK(mill.status("emil", "GET", "/designs/cloth/revisions/3") == 404);
    CHECK(mill.status("emil", "GET", "/designs/cloth/revisions/01") == 400);
    CHECK(mill.done("emil", "GET", path + "/check?loom=seven").at("errors") == 0);

    const Json why{{"reason", "It is good"}, {"password", api_password}};
    CHECK(mill.status("dora", "POST", path + "/submit",
                      {{"reason", "x"}, {"password", "not the password"}}) == 403);
    CHECK(mill.done("dora", "POST", path + "/submit", why).at("state") == "submitted");
    CHECK(mill.status("dora", "POST", path + "/submit", why) == 409);
    CHECK(mill.status("dora", "POST", path + "/approve", why) == 403);
    mill.done("emil", "GET", path);
    CHECK(mill.done("abel", "GET", "/me/waiting").at("items").size() == 1);
    CHECK(mill.done("abel", "POST", path + "/approve", why).at("state") == "approved");

    auto watch = net::WebSocketClient::connect(mill.options(), "/api/v1/looms/seven/watch",
                                               {{"Authorization", "Bearer " + mill.tokens["otto"]}});
    REQUIRE(watch);
    CHECK_FALSE(net::WebSocketClient::connect(mill.options(), "/api/v1/looms/seven/watch",
                                              {{"Authorization", "Bearer " + mill.tokens["olga"]}}));
    const Json release = mill.done("abel", "POST", "/releases",
                                   {{"design", "cloth"},
                                    {"revision", 1},
                                    {"loom", "seven"},
                                    {"feeders", {1}},
                                    {"reason", "Weave it"},
                                    {"password", api_password}});
    CHECK(release.at("state") == "released");
    const auto told = watch->receive(std::chrono::seconds(20));
    REQUIRE((told && *told));
    CHECK(parse_json((*told)->bytes).value().at("loom") == "seven");

    const std::string root = "/looms/seven/releases/1";
    const Json content = mill.done("otto", "GET", root);
    for (const auto& file : content.at("files")) {
        const auto pulled = mill.call("otto", "GET", root + "/files/" + file.at("name").get<std::string>());
        CHECK(pulled.status == 200);
        CHECK(sha256_hex(*pulled.body) == file.at("sha256").get<std::string>());
        CHECK_THAT(std::string(pulled.headers.get("Content-Disposition")), Catch::StartsWith("attachment"));
        CHECK(mill.status("olga", "GET", root + "/files/" + file.at("name").get<std::string>()) == 404);
        CHECK(mill.status("mary", "GET", root + "/files/" + file.at("name").get<std::string>()) == 403);
    }
    CHECK(mill.status("otto", "GET", root + "/files/other") == 404);
    CHECK(mill.call("otto", "GET", root + "/manifest").status == 200);
    CHECK(is_png(mill.call("otto", "GET", root + "/card?x=0&y=0&w=2&h=2")));
    CHECK(mill.done("otto", "GET", root + "/picks?from=1&count=2").at("picks").size() == 2);
    CHECK(mill.done("otto", "GET", "/looms/seven/index").contains("index"));
    mill.done("otto", "PUT", "/looms/seven/place", {{"release", 1}, {"pick", 2}});
    mill.done("otto", "POST", "/looms/seven/loaded", {{"release", 1}});
    mill.done("otto", "POST", "/looms/seven/faults", {{"release", 1}, {"pick", 2}, {"text", "It floats"}});
    CHECK(mill.done("dora", "GET", "/looms/seven/faults").at("faults").size() == 1);
    CHECK(mill.status("olga", "POST", "/looms/seven/loaded", {{"release", 1}}) == 403);

    mill.done("emil", "POST", root + "/withdraw", why);
    CHECK(mill.status("otto", "GET", root + "/manifest") == 409);

    const Json head = mill.done("emil", "GET", "/audit/head");
    CHECK(mill.done("emil", "GET", "/events?from=0&limit=5").at("events").size() == 5);
    CHECK(mill.done("emil", "GET", "/audit/inclusion?seq=0&size=" + head.at("size").dump()).contains("path"));
    CHECK(mill.done("emil", "GET", "/audit/consistency?from=1&size=" + head.at("size").dump())
              .contains("path"));
    CHECK(mill.call("emil", "GET", "/audit/bundle").status == 200);
    CHECK(mill.call("emil", "GET", path + "/bundle").status == 200);
}

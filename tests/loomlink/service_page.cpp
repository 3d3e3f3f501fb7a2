#include "service_case.hpp"

#include <fstream>
#include <loomlink/service/answering.hpp>
#include <loomlink/service/page.hpp>
#include <set>
#include <sstream>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;

namespace {

constexpr const char* policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
    "form-action "
    "'self'; base-uri 'none'; frame-ancestors 'none'";

}  // namespace

TEST_CASE("the page is served from the program, byte by byte, and loads nothing from elsewhere") {
    StubService service;
    service.start();
    net::HttpClient client(service.client_options());
    std::set<std::string> types;
    for (const PageFile& file : page_files()) {
        INFO(file.path);
        std::ifstream source(std::string(WEAVE_SOURCE_DIR "/loomlink/web/") + std::string(file.path));
        std::stringstream text;
        text << source.rdbuf();
        const auto answer = ask(client, "GET", "/" + std::string(file.path));
        CHECK(answer.status == 200);
        CHECK(*answer.body == text.str());
        CHECK(answer.headers.get("Content-Security-Policy") == policy);
        CHECK(answer.headers.get("X-Content-Type-Options") == "nosniff");
        types.emplace(answer.headers.get("Content-Type"));
        const auto again = ask(client, "GET", "/" + std::string(file.path),
                               {{"If-None-Match", std::string(answer.headers.get("ETag"))}});
        CHECK(again.status == 304);
    }
    CHECK(types == std::set<std::string>{"image/svg+xml", "text/css; charset=utf-8",
                                         "text/html; charset=utf-8", "text/javascript; charset=utf-8"});
}

TEST_CASE("every path of the page shows its index, and no path of the API does") {
    StubService service;
    service.start();
    net::HttpClient client(service.client_options());
    const std::string index = *ask(client, "GET", "/index.html").body;
    for (const char* path :
         {"/", "/join", "/designs", "/designs/shoe/3", "/looms/loom%207/12", "/a/b/c/d/e/f/g/h"}) {
        INFO(path);
        const auto answer = ask(client, "GET", path);
        CHECK(answer.status == 200);
        CHECK(*answer.body == index);
        CHECK(answer.headers.get("Content-Security-Policy") == policy);
    }
    for (const char* path : {"/api", "/api/v1", "/api/v1/nothing", "/api/v2/designs/shoe"}) {
        INFO(path);
        const auto answer = ask(client, "GET", path);
        CHECK(answer.status == 404);
        CHECK(json_of(answer).at("error").at("message") == "there is nothing here");
    }
    CHECK(ask(client, "GET", "/parts/../../CMakeLists.txt").status == 400);
    CHECK(ask(client, "GET", "/parts/%2e%2e%2fapp.js").status == 400);
    CHECK(ask(client, "POST", "/").status == 405);
}

TEST_CASE("the page sends files as large as the server takes them, and no larger") {
    std::string page;
    for (const PageFile& file : page_files())
        if (file.path == "parts/files.js") page = file.text;
    const auto takes = [&](const char* kind, std::size_t bytes) {
        INFO(kind << ": " << bytes);
        const std::size_t line = page.find(std::string(kind) + ": { what: ");
        REQUIRE(line != std::string::npos);
        const std::string most = "most: " + std::to_string(bytes >> 20) + " * 2 ** 20 }";
        CHECK_THAT(page.substr(line, page.find('\n', line) - line), Catch::Contains(most));
    };
    const auto table = api_table();
    const auto route = [&](const char* name) {
        return *std::find_if(table.begin(), table.end(), [&](const ApiRoute& one) { return one.name == name; });
    };
    const auto field = [&](const char* name, const char* member) {
        const Fields body = route(name).body;
        const auto found = std::find_if(body.begin(), body.end(), [&](const Field& one) { return one.name == member; });
        REQUIRE(found != body.end());
        return static_cast<std::size_t>(found->high);
    };
    takes("design", field("revision.save", "document"));
    takes("profile", field("loom.make", "profile"));
    takes("evidence", route("revision.evidence").body_bytes());
}

TEST_CASE("files are saved under their names, whatever stands in them") {
    CHECK(disposition_of("shoe-12.jc5") == "attachment; filename=\"shoe-12.jc5\"");
    CHECK(disposition_of("a b\"; x=\r\n") == "attachment; filename*=UTF-8''a%20b%22%3B%20x%3D%0D%0A");
    CHECK(disposition_of("schuh-größe") == "attachment; filename*=UTF-8''schuh-gr%C3%B6%C3%9Fe");
}

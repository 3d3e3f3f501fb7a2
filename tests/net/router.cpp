#include <weave/net/router.hpp>

#include <catch2/catch.hpp>

#include <support/random.hpp>

using namespace weave;
using namespace weave::net;

namespace {

Route route(const std::string& method, const std::string& pattern) {
    return {method + " " + pattern,
            method,
            pattern,
            "Does something",
            0,
            [](const Request&) { return Response{204, {}, nullptr}; },
            {}};
}

std::string taken(const Router& router, const std::string& method, const std::string& path) {
    const RouteMatch match = router.match(method, path);
    return match.route == nullptr ? "" : match.route->pattern;
}

}  // namespace

TEST_CASE("routes are found by method and path, the literal before the place") {
    Router router;
    for (const char* pattern : {"/", "/designs", "/designs/{design}", "/designs/new",
                                "/designs/{design}/files/{file}", "/{any}/new/files/x"})
        REQUIRE(router.add(route("GET", pattern)));
    REQUIRE(router.add(route("PUT", "/designs/{id}")));
    REQUIRE(taken(router, "GET", "/") == "/");
    REQUIRE(taken(router, "GET", "/designs") == "/designs");
    REQUIRE(taken(router, "GET", "/designs/new") == "/designs/new");
    REQUIRE(taken(router, "GET", "/designs/old") == "/designs/{design}");
    REQUIRE(taken(router, "HEAD", "/designs/old") == "/designs/{design}");
    REQUIRE(taken(router, "PUT", "/designs/new") == "/designs/{id}");
    REQUIRE(taken(router, "GET", "/designs/new/files/x") == "/designs/{design}/files/{file}");
    REQUIRE(taken(router, "GET", "/other/new/files/x") == "/{any}/new/files/x");
    REQUIRE(router.match("GET", "/designs/a b/files/7").places ==
            Parameters{{"design", "a b"}, {"file", "7"}});
}

TEST_CASE("what has no route says which methods it knows") {
    Router router;
    REQUIRE(router.add(route("GET", "/a")));
    REQUIRE(router.add(route("DELETE", "/{x}")));
    REQUIRE(router.match("POST", "/a").allowed == std::vector<std::string>{"DELETE", "GET", "HEAD"});
    REQUIRE(router.match("get", "/a").allowed.size() == 3);
    REQUIRE(router.match("GET", "/b").allowed == std::vector<std::string>{"DELETE"});
    const RouteMatch none = router.match("GET", "/a/b");
    REQUIRE(none.route == nullptr);
    REQUIRE(none.allowed.empty());
}

TEST_CASE("a route that is wrong in itself, or says what another does, is refused") {
    Router router;
    REQUIRE(router.add(route("GET", "/a/{x}")));
    for (const char* pattern :
         {"", "a", "/a/", "//", "/{}", "/a{x}", "/{x", "/{x}/{x}", "/a?b", "/{a/b}", "/%41"}) {
        INFO(pattern);
        REQUIRE_FALSE(router.add(route("GET", pattern)));
    }
    REQUIRE_FALSE(router.add(route("GET", "/a/{y}")));
    REQUIRE_FALSE(router.add(route("HEAD", "/h")));
    REQUIRE_FALSE(router.add(route("get", "/h")));
    Route named = route("GET", "/b");
    named.name = "GET /a/{x}";
    REQUIRE_FALSE(router.add(named));
    Route idle = route("GET", "/c");
    idle.handler = nullptr;
    REQUIRE_FALSE(router.add(idle));
    REQUIRE(router.routes().size() == 1);
}

TEST_CASE("no order of adding routes changes which one is taken") {
    weave::testing::for_all(
        [](weave::testing::Random& random) {
            std::vector<std::string> patterns{"/a/b/c",   "/a/b/{z}",     "/a/{y}/c",
                                              "/{x}/b/c", "/{x}/{y}/{z}", "/a/{y}/{z}"};
            Router router;
            random.shuffle(patterns);
            for (const std::string& pattern : patterns) REQUIRE(router.add(route("GET", pattern)));
            REQUIRE(taken(router, "GET", "/a/b/c") == "/a/b/c");
            REQUIRE(taken(router, "GET", "/a/b/q") == "/a/b/{z}");
            REQUIRE(taken(router, "GET", "/a/q/c") == "/a/{y}/c");
            REQUIRE(taken(router, "GET", "/a/q/q") == "/a/{y}/{z}");
            REQUIRE(taken(router, "GET", "/q/b/c") == "/{x}/b/c");
            REQUIRE(taken(router, "GET", "/q/b/q") == "/{x}/{y}/{z}");
        },
        100);
}

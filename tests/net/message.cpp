#include <weave/core/log.hpp>
#include <weave/net/health.hpp>
#include <weave/net/message.hpp>
#include <weave/net/target.hpp>

#include <catch2/catch.hpp>

#include <support/random.hpp>

using namespace weave;
using namespace weave::net;

TEST_CASE("a target is taken apart, decoded once") {
    const auto target = parse_target("/a%20b/c%2541?x=1+2&y=%2B&x=3&&z");
    REQUIRE(target);
    REQUIRE(target->path == "/a b/c%41");
    REQUIRE(target->query == Parameters{{"x", "1 2"}, {"y", "+"}, {"x", "3"}, {"z", ""}});
    REQUIRE(parse_target("/").value().path == "/");
    REQUIRE(parse_target("/caf%C3%A9").value().path == "/caf\xc3\xa9");
}

TEST_CASE("a target that two programs could read differently is refused") {
    for (const char* bad : {"",     "hello",  "*",       "http://a/b", "//",     "/a//b",    "/a/",
                            "/.",   "/..",    "/a/../b", "/%2e%2e/b",  "/a%2fb", "/a%5Cb",   "/a\\b",
                            "/%00", "/a%0Ab", "/%",      "/%4",        "/%zz",   "/%+1",     "/a b",
                            "/a#b", "/\xff",  "/%ff",    "/%C0%AF",    "/x?a=%", "/x?a=%00", "/x?\x01"}) {
        INFO(bad);
        const auto target = parse_target(bad);
        REQUIRE_FALSE(target);
        REQUIRE(target.error().code == ErrorCode::bad_input);
    }
    std::string many = "/x?a";
    for (int k = 0; k < 64; ++k) many += "&a";
    REQUIRE_FALSE(parse_target(many));
}

TEST_CASE("what is percent-encoded comes back, whatever it is") {
    weave::testing::for_all(
        [](weave::testing::Random& random) {
            std::string text;
            for (std::size_t k = random.between(0, 12); k > 0; --k)
                text += static_cast<char>(random.between(0x20, 0x7e));
            REQUIRE(percent_decoded(percent_encoded(text)).value() == text);
        },
        1000);
}

TEST_CASE("headers are found without regard to case") {
    Headers headers{{"Content-Type", "a"}, {"x", "1"}, {"X", "2"}};
    REQUIRE(headers.get("content-type") == "a");
    REQUIRE(headers.find("missing") == nullptr);
    headers.set("X", "3");
    REQUIRE(headers.get("x") == "3");
    REQUIRE(std::distance(headers.begin(), headers.end()) == 2);
    REQUIRE(is_sendable("X-A", "tab\tand \xc3\xa9"));
    for (const char* value : {"a\rb", "a\nb", "a\x7f", "\x01"}) REQUIRE_FALSE(is_sendable("X", value));
    REQUIRE_FALSE(is_sendable("X", std::string_view("a\0b", 3)));
    for (const char* name : {"", "a b", "a:", "a\r", "\xc3\xa9"}) REQUIRE_FALSE(is_sendable(name, "v"));
}

TEST_CASE("cookies are read, and one that contradicts itself is none") {
    Request request;
    request.headers = {{"Cookie", "a=1; session=x=y ;b=2"}, {"cookie", "a=1"}};
    REQUIRE(request.cookie("session") == "x=y");
    REQUIRE(request.cookie("a") == "1");
    REQUIRE_FALSE(request.cookie("c"));
    request.headers.add("Cookie", "a=2");
    REQUIRE_FALSE(request.cookie("a"));
}

TEST_CASE("cookies are written so that scripts and other sites do not get them") {
    REQUIRE(set_cookie("session", "abc-_", {true, 60}).value() ==
            "session=abc-_; Path=/; HttpOnly; SameSite=Strict; Secure; Max-Age=60");
    REQUIRE(set_cookie("s", "v", {false, {}}).value() == "s=v; Path=/; HttpOnly; SameSite=Strict");
    for (const char* value : {"a;b", "a b", "a\r\nSet-Cookie: x", "a\"", "a,b"})
        REQUIRE_FALSE(set_cookie("s", value, {}));
    for (const char* name : {"", "a b", "a=", "a;"}) REQUIRE_FALSE(set_cookie(name, "v", {}));
}

TEST_CASE("entity tags are compared weakly, and none is held of what has none") {
    Request request;
    request.headers = {{"If-None-Match", "\"a\", W/\"b\""}};
    REQUIRE(holds_already(request, etag_of("a")));
    REQUIRE(holds_already(request, etag_of("b")));
    REQUIRE_FALSE(holds_already(request, etag_of("c")));
    REQUIRE_FALSE(holds_already(request, ""));
    request.headers = {{"If-None-Match", "*"}};
    REQUIRE(holds_already(request, etag_of("c")));
}

TEST_CASE("an error becomes JSON with its status, and a fault of ours tells the log alone what it was") {
    const auto parsed = [](const Response& response) { return parse_json(*response.body).value()["error"]; };
    const Response invalid = error_answer(weave::invalid("two yarns cross", "stacks[3]"));
    REQUIRE(invalid.status == 422);
    REQUIRE(parsed(invalid) ==
            Json{{"kind", "invalid"}, {"where", "stacks[3]"}, {"message", "two yarns cross"}});
    REQUIRE(error_answer(bad_input("x")).status == 400);
    REQUIRE(error_answer({ErrorCode::usage, "x", {}}).status == 400);
    REQUIRE(error_answer({ErrorCode::refused, "x", {}}).status == 403);
    REQUIRE(error_answer({ErrorCode::refused, "x", {}}, 409).status == 409);

    std::string told;
    set_log_sink([&](LogLevel, std::string_view message) { told += message; });
    const Response fault = error_answer(system_fault("disk I/O error", "/var/lib/store.db"));
    set_log_sink({});
    REQUIRE(fault.status == 500);
    REQUIRE(fault.body->find("disk") == std::string::npos);
    REQUIRE(fault.body->find("/var") == std::string::npos);
    REQUIRE(told.find("/var/lib/store.db: disk I/O error") != std::string::npos);
    REQUIRE(parsed(error_answer(bad_input("\xff"))).is_object());  // what is no UTF-8 does not stop it
}

TEST_CASE("a request from another site's page is told from one of ours") {
    Request request;
    request.headers = {{"Host", "loom:8443"}};
    request.secure = true;
    REQUIRE(from_own_pages(request));
    request.headers.set("Origin", "https://loom:8443");
    REQUIRE(from_own_pages(request));
    for (const char* origin : {"http://loom:8443", "https://loom", "https://evil:8443", "null", ""}) {
        request.headers.set("Origin", origin);
        INFO(origin);
        REQUIRE_FALSE(from_own_pages(request));
    }
    request.headers.set("Origin", "https://loom:8443");
    request.headers.set("Sec-Fetch-Site", "same-origin");
    REQUIRE(from_own_pages(request));
    for (const char* site : {"cross-site", "same-site"}) {
        request.headers.set("Sec-Fetch-Site", site);
        REQUIRE_FALSE(from_own_pages(request));
    }
}

TEST_CASE("health names the check that fails and keeps why to itself") {
    const HealthCheck good{"store", [] { return Status(); }};
    const HealthCheck bad{"disk", [] { return Status(system_fault("full", "/srv")); }};
    REQUIRE(health_answer({good}).status == 200);
    const Response sick = health_answer({good, bad});
    REQUIRE(sick.status == 503);
    REQUIRE(*sick.body == R"({"healthy":false,"checks":{"store":true,"disk":false}})");
}

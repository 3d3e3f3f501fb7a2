#include <weave/net/heads.hpp>

#include <catch2/catch.hpp>

#include <support/random.hpp>

using namespace weave;
using namespace weave::net;

TEST_CASE("a plain head passes, and every way to write it loosely does not") {
    REQUIRE(check_head("GET /a?b HTTP/1.1\r\nHost: x\r\nX-Empty:\r\nX: \t v\r\n\r\n"));
    REQUIRE(check_head("M-SEARCH / HTTP/1.0\r\n\r\n"));
    using namespace std::string_literals;
    for (const std::string& bad : {
             ""s,
             "\r\n"s,
             "\r\nGET / HTTP/1.1\r\n\r\n"s,       // an empty line in front
             "GET / HTTP/1.1\r\nHost: x\r\n"s,    // no end
             "GET / HTTP/1.1\nHost: x\r\n\r\n"s,  // a bare LF
             "GET / HTTP/1.1\r\nA: b\nC: d\r\n\r\n"s,
             "GET / HTTP/1.1\r\nA: b\rC: d\r\n\r\n"s,  // a bare CR
             "GET / HTTP/1.1\r\nA: b\r\n c\r\n\r\n"s,  // a folded line
             "GET / HTTP/1.1\r\n A: b\r\n\r\n"s,
             "GET / HTTP/1.1\r\nA : b\r\n\r\n"s,  // a space before the colon
             "GET / HTTP/1.1\r\n: b\r\n\r\n"s,    // no name
             "GET / HTTP/1.1\r\nA\r\n\r\n"s,      // no colon
             "GET / HTTP/1.1\r\nA: b\0c\r\n\r\n"s,
             "GET / HTTP/1.1\r\nA\0: b\r\n\r\n"s,
             "GET  / HTTP/1.1\r\n\r\n"s,
             " GET / HTTP/1.1\r\n\r\n"s,
             "GET /\r\n\r\n"s,
             "GET / HTTP/2.0\r\n\r\n"s,
             "GET / HTTP/1.1 \r\n\r\n"s,
             "GET / a HTTP/1.1\r\n\r\n"s,
             "G\tT / HTTP/1.1\r\n\r\n"s,
             "GET / HTTP/1.1\r\n\r\nmore"s,
         }) {
        INFO(bad);
        REQUIRE_FALSE(check_head(bad));
    }
}

TEST_CASE("the length of a body is told once and plainly") {
    const auto framing = [](Headers headers, bool old = false) { return framing_of(headers, old); };
    REQUIRE_FALSE(framing({}).value().has_body());
    REQUIRE(framing({{"content-length", "12"}}).value().length == 12);
    REQUIRE(framing({{"Transfer-Encoding", "Chunked"}}).value().chunked);
    for (const char* bad :
         {"", "+1", "-1", "1,1", "0x1", "1 ", "1 1", "1234567890123456789", "\xef\xbc\x91"}) {
        INFO(bad);
        REQUIRE_FALSE(framing({{"Content-Length", bad}}));
    }
    for (const char* bad :
         {"", "gzip", "gzip, chunked", "chunked, chunked", "chunked;x", "identity", "xchunked"}) {
        INFO(bad);
        REQUIRE_FALSE(framing({{"Transfer-Encoding", bad}}));
    }
    REQUIRE_FALSE(framing({{"Content-Length", "1"}, {"Content-Length", "1"}}));
    REQUIRE_FALSE(framing({{"Content-Length", "1"}, {"Transfer-Encoding", "chunked"}}));
    REQUIRE_FALSE(framing({{"Transfer-Encoding", "chunked"}, {"transfer-encoding", "chunked"}}));
    REQUIRE_FALSE(framing({{"Transfer-Encoding", "chunked"}}, true));
}

TEST_CASE("there is one host, and it looks like one") {
    const auto host = [](const char* value) { return host_of({{"Host", value}}, false); };
    REQUIRE(host("Loom.Example:8443").value() == "loom.example");
    REQUIRE(host("127.0.0.1").value() == "127.0.0.1");
    REQUIRE(host("[::1]:80").value() == "[::1]");
    REQUIRE(host("[FE80::1]").value() == "[fe80::1]");
    for (const char* bad : {"", ":80", "a:", "a:b", "a:123456", "a b", "a/b", "a@b", "a,b", "[::1", "::1",
                            "[]", "[x]", "a?b", "a#b"}) {
        INFO(bad);
        REQUIRE_FALSE(host(bad));
    }
    REQUIRE_FALSE(host_of({}, false));
    REQUIRE(host_of({}, true));
    REQUIRE_FALSE(host_of({{"Host", "a"}, {"host", "a"}}, true));
}

TEST_CASE("an answer carries the security headers, unless its route says otherwise") {
    Response response = answer(200, "text/html", make_bytes("hello"));
    const std::string head = written_head(response, {true, true, "DATE"});
    REQUIRE(head ==
            "HTTP/1.1 200 OK\r\nContent-Type: text/html\r\n"
            "Content-Security-Policy: default-src 'none'; frame-ancestors 'none'; base-uri 'none'; "
            "form-action 'none'\r\n"
            "X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nCache-Control: no-store\r\n"
            "Strict-Transport-Security: max-age=31536000\r\nDate: DATE\r\nContent-Length: 5\r\n\r\n");
    response.headers.add("content-security-policy", "default-src 'self'");
    response.headers.add("Content-Length", "7");
    response.headers.add("Transfer-Encoding", "chunked");
    const std::string own = written_head(response, {false, false, "DATE"});
    REQUIRE(own.find("default-src 'none'") == std::string::npos);
    REQUIRE(own.find("default-src 'self'") != std::string::npos);
    REQUIRE(own.find("Content-Length: 7") == std::string::npos);
    REQUIRE(own.find("Transfer-Encoding") == std::string::npos);
    REQUIRE(own.find("Strict-Transport") == std::string::npos);
    REQUIRE(own.find("Connection: close\r\n") != std::string::npos);
    REQUIRE(written_head({204, {}, nullptr}, {}).find("Content-Length") == std::string::npos);
    REQUIRE(http_date(784111777) == "Sun, 06 Nov 1994 08:49:37 GMT");
}

TEST_CASE("a header that would start another answer is never sent") {
    for (const char* value : {"a\r\nSet-Cookie: x=y", "a\nb", "a\r", "\x01"}) {
        Response response = answer(200, "text/plain", make_bytes("secret"));
        response.headers.add("X-Name", value);
        REQUIRE(sendable(response).status == 500);
        REQUIRE(sendable(response).body->find("secret") == std::string::npos);
    }
    REQUIRE(sendable(answer(200, "text/plain", nullptr)).status == 200);
}

TEST_CASE("what passes the check has one reading: its lines split at CRLF and at the first colon") {
    const std::string good = "GET / HTTP/1.1\r\nHost: x\r\nContent-Length: 3\r\n\r\n";
    weave::testing::for_all(
        [&](weave::testing::Random& random) {
            constexpr std::string_view marks("\r\n\0 \t:;,\x7f\x0b", 10);
            std::string head = good;
            for (std::size_t k = random.between(1, 3); k > 0; --k)
                head[random.between(0, head.size() - 1)] = marks[random.between(0, marks.size() - 1)];
            if (!check_head(head)) return;
            INFO(head);
            REQUIRE(head.ends_with("\r\n\r\n"));
            for (std::size_t k = 0; k < head.size(); ++k) {
                const char c = head[k];
                REQUIRE((c == '\r' || c == '\n' || c == '\t' || (c >= 0x20 && c < 0x7f)));
                if (c == '\r') REQUIRE((k + 1 < head.size() && head[k + 1] == '\n'));
                if (c == '\n') REQUIRE((k > 0 && head[k - 1] == '\r'));
                if (c == '\n' && k + 1 < head.size()) REQUIRE((head[k + 1] != ' ' && head[k + 1] != '\t'));
            }
        },
        5000);
}

#include "service.hpp"

#include <support/random.hpp>

using namespace weave;
using namespace weave::net;
using namespace weave::net::testing;
using weave::testing::Random;

namespace {

std::string valid_request(Random& random) {
    switch (random.between(0, 3)) {
        case 0:
            return "GET /hello?x=%20 HTTP/1.1\r\nHost: x\r\nCookie: a=b\r\n\r\n";
        case 1:
            return "POST /echo HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\n\r\nhello";
        case 2:
            return "POST /echo HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: "
                   "chunked\r\n\r\n3;a=b\r\nabc\r\n0\r\nT: v\r\n\r\n";
        default:
            return "GET /hello HTTP/1.1\r\nHost: x\r\nIf-None-Match: \"a\"\r\nExpect: 100-continue\r\n\r\n";
    }
}

void mutate(Random& random, std::string& bytes) {
    constexpr std::string_view marks("\r\n\0 :;,%/0fF\xff\x80{}\t", 17);
    for (std::size_t k = random.between(1, 4); k > 0 && !bytes.empty(); --k) {
        const std::size_t at = random.between(0, bytes.size() - 1);
        switch (random.between(0, 4)) {
            case 0:
                bytes[at] = static_cast<char>(random.between(0, 255));
                break;
            case 1:
                bytes[at] = marks[random.between(0, marks.size() - 1)];
                break;
            case 2:
                bytes.erase(at, random.between(1, 8));
                break;
            case 3:
                bytes.insert(at, bytes.substr(random.between(0, bytes.size() - 1), random.between(1, 40)));
                break;
            default:
                bytes.insert(at, random.between(1, 300), marks[random.between(0, marks.size() - 1)]);
        }
    }
}

std::string random_bytes(Random& random) {
    std::string bytes;
    for (std::size_t k = random.between(0, 400); k > 0; --k)
        bytes += static_cast<char>(random.between(0, 255));
    return bytes;
}

/// Every answer in the bytes starts where the one before ended.
void check_answers(std::string_view reply) {
    while (!reply.empty()) {
        if (reply.starts_with("HTTP/1.1 100 Continue\r\n\r\n")) {
            reply.remove_prefix(25);
            continue;
        }
        REQUIRE(reply.starts_with("HTTP/1.1 "));
        const std::size_t end = reply.find("\r\n\r\n");
        REQUIRE(end != std::string_view::npos);
        const std::string_view head = reply.substr(0, end);
        const int status = std::atoi(std::string(head.substr(9, 3)).c_str());
        REQUIRE((status == 200 || (status >= 304 && status < 500) || status == 505));
        const std::size_t length = head.find("Content-Length: ");
        const std::size_t size =
            length == std::string_view::npos
                ? 0
                : static_cast<std::size_t>(std::atoi(std::string(head.substr(length + 16)).c_str()));
        REQUIRE(reply.size() >= end + 4 + size);
        reply.remove_prefix(end + 4 + size);
    }
}

}  // namespace

TEST_CASE("a server goes on serving whatever bytes come") {
    ServerOptions options;
    options.limits.header_time = 5s;
    const Server server = started(usual_routes(), options);
    weave::testing::for_all(
        [&](Random& random) {
            std::string bytes = random.between(0, 4) == 0 ? random_bytes(random) : valid_request(random);
            if (random.coin()) bytes += valid_request(random);
            mutate(random, bytes);
            INFO(bytes);
            RawSocket socket(server.port());
            REQUIRE(socket.connected());
            socket.send(bytes);
            socket.end_sending();
            const std::string reply = socket.read_all();
            REQUIRE(socket.closed());
            check_answers(reply);
        },
        std::max<std::size_t>(weave::testing::property_cases() / 10, 1));
    REQUIRE(reply_to(server.port(), "GET /hello HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")
                .ends_with("hello"));
}

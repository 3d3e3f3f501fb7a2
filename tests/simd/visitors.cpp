// Who is let in, to every route, and for how long.

#include "people.hpp"

#include <weave/keys/access_token.hpp>
#include <weave/keys/hex.hpp>
#include <weave/net/websocket_client.hpp>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

using namespace weave;
using namespace weave::simd::testing;

namespace {

std::string token_for(const KeyPair& key, const std::string& site, const std::string& person, std::chrono::seconds begin, std::chrono::seconds end) {
    const Instant now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
    return sign_access_token(key, {site, person, now + begin, now + end}).value();
}

/// A daemon that counts for the tokens of a mill's loomlink.
struct Mill {
    KeyPair key = KeyPair::generate(), foreign = KeyPair::generate();
    People people{Json{{"site", "mill"}, {"access_keys", {to_hex(key.public_key())}}}};

    [[nodiscard]] std::string token(const std::string& person, std::chrono::seconds end = 1h) const { return token_for(key, "mill", person, -10s, end); }

    /// The whole answer to a GET from an address of this machine, 127.0.0.`last`.
    [[nodiscard]] std::string get(const std::string& target, const std::vector<std::string>& authorizations, int last = 1) const {
        const int number = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_in source{}, place{};
        source.sin_family = place.sin_family = AF_INET;
        source.sin_addr.s_addr = htonl(INADDR_LOOPBACK - 1 + static_cast<std::uint32_t>(last));
        place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        place.sin_port = htons(people.place().options.port);
        REQUIRE(::bind(number, reinterpret_cast<const sockaddr*>(&source), sizeof source) == 0);
        REQUIRE(::connect(number, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0);
        const bool upgrades = target == "/api/v1/wire";
        std::string head = "GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1\r\n";
        for (const std::string& value : authorizations) head += "Authorization: " + value + "\r\n";
        head += upgrades ? "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
                         : "Connection: close\r\n\r\n";
        REQUIRE(::send(number, head.data(), head.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(head.size()));
        if (upgrades) ::shutdown(number, SHUT_WR);
        std::string answer(1 << 20, '\0');
        std::size_t size = 0;
        for (ssize_t got = 1; got > 0; size += static_cast<std::size_t>(std::max<ssize_t>(0, got))) got = ::recv(number, answer.data() + size, answer.size() - size, 0);
        ::close(number);
        answer.resize(size);
        return answer;
    }
    [[nodiscard]] int status(const std::string& target, const std::vector<std::string>& authorizations, int last = 1) const {
        const std::string answer = get(target, authorizations, last);
        REQUIRE(answer.starts_with("HTTP/1.1 "));
        return std::stoi(answer.substr(9, 3));
    }
};

std::string body_of(const std::string& answer) {
    return answer.substr(std::min(answer.size(), answer.find("\r\n\r\n") + 4));
}

const std::vector<std::string> for_visitors{"/api/v1/wire", "/api/v1/status", "/api/v1/sessions/1/yarns", "/api/v1/jobs/1/yarns", "/api/v1/jobs/1/evidence"};

/// The code with which a connection that says hello ends.
int end_of(const wire::ServerPlace& place, std::chrono::milliseconds patience, const std::function<void()>& meanwhile = {}) {
    net::Headers headers;
    headers.set("Authorization", "Bearer " + place.token);
    auto socket = net::WebSocketClient::connect(place.options, "/api/v1/wire", headers);
    REQUIRE(socket);
    REQUIRE(socket->send(R"({"client":"test","type":"hello","versions":[1]})"));
    REQUIRE(socket->receive(10s));
    if (meanwhile) meanwhile();
    const auto late = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < late && socket->receive(100ms)) {}
    return socket->end() ? socket->end()->code : 0;
}

}  // namespace

TEST_CASE("every route for visitors is closed to whoever shows no token that counts, in the same words whatever is wrong with it") {
    const Mill mill;
    const std::string good = mill.token("dora"), local = simd::add_local_token(mill.people.tokens(), "abel").value();
    std::string forged = good;
    forged[10] = forged[10] == 'A' ? 'B' : 'A';
    const std::vector<std::vector<std::string>> silent{{}, {""}, {"Bearer"}, {good}, {"Basic " + good}, {"Bearer " + good, "Bearer " + good},
                                                       {"Bearer " + good, "Bearer wrong"}, {"Bearer " + std::string(5000, 'x')}};
    const std::vector<std::vector<std::string>> wrong{{"Bearer wrong"},
                                                      {"Bearer " + forged},
                                                      {"Bearer " + good + "x"},
                                                      {"Bearer " + good + ", Bearer " + good},
                                                      {"Bearer " + token_for(mill.foreign, "mill", "dora", -10s, 1h)},
                                                      {"Bearer " + token_for(mill.key, "other", "dora", -10s, 1h)},
                                                      {"Bearer " + token_for(mill.key, "mill", "dora", -100s, -1s)},
                                                      {"Bearer " + token_for(mill.key, "mill", "dora", 1h, 2h)},
                                                      {"Bearer " + token_for(mill.key, "mill", "local", -10s, 1h)},
                                                      {"Bearer local"},
                                                      {"Bearer " + local.substr(1)}};
    int address = 10;  // another one each time, so that nothing is throttled
    for (const std::string& route : for_visitors) {
        std::set<std::string> words;
        for (const auto& authorizations : silent) {
            INFO(route << " with " << (authorizations.empty() ? "nothing" : authorizations.front()));
            const int status = mill.status(route, authorizations, address);
            CHECK((status == 401 || (status == 400 && authorizations.size() > 1)));
        }
        for (const auto& authorizations : wrong) {
            INFO(route << " with " << authorizations.front());
            const std::string answer = mill.get(route, authorizations, ++address);
            CHECK(answer.starts_with("HTTP/1.1 401 "));
            CHECK(answer.find("WWW-Authenticate: Bearer\r\n") != std::string::npos);
            words.insert(body_of(answer));
        }
        CHECK(words.size() == 1);
        for (const std::string& token : {good, local}) {
            const int status = mill.status(route, {"Bearer " + token}, ++address);
            INFO(route << " with a token that counts: " << status);
            CHECK(status == (route == "/api/v1/wire" ? 101 : route == "/api/v1/status" ? 200 : 404));
        }
        CHECK(mill.status(route, {"bearer " + good}, ++address) != 401);
    }
    for (const char* route : {"/", "/healthz", "/metrics"}) {
        const std::string answer = mill.get(route, {});
        CHECK(answer.starts_with("HTTP/1.1 200 "));
        CHECK(answer.find("dora") == std::string::npos);
        CHECK(mill.status(route, {"Bearer wrong"}) == 200);
    }
    for (const char* route : {"/api/v1/sessions", "/api", "/api/v1/wire/", "/api/v1/../v1/status", "/tokens", "/simd.db"})
        CHECK(mill.status(route, {"Bearer " + good}) >= 400);
}

TEST_CASE("names and titles are for the machine's owner alone") {
    const Mill mill;
    Followed session(mill.people.follower("dora"), document_of("plain"), at(sim::Fidelity::draft));
    for (const std::string& text : {mill.get("/api/v1/status", {"Bearer " + mill.token("abel")}), mill.get("/", {}), mill.get("/metrics", {}), mill.get("/healthz", {})}) {
        CHECK(text.find("dora") == std::string::npos);
        CHECK(text.find("\"worker\"") == std::string::npos);
        CHECK(text.find("\"title\"") == std::string::npos);
    }
    const Json told = mill.people.box().status();
    CHECK(told.at("sessions").at(0).at("person") == "dora");
}

TEST_CASE("wrong tokens are throttled by their address, and a right one comes in from there all the same") {
    const Mill mill;
    const std::string good = mill.token("dora");
    int wrong = 0;
    while (wrong < 100 && mill.get("/api/v1/status", {"Bearer wrong"}, 1).find("too many tokens") == std::string::npos) ++wrong;
    CHECK(wrong >= 20);
    CHECK(wrong < 100);
    CHECK(mill.get("/api/v1/status", {"Bearer wrong"}, 2).find("too many tokens") == std::string::npos);
    for (const int address : {1, 2}) {
        CHECK(mill.status("/api/v1/status", {"Bearer " + good}, address) == 200);
        CHECK(mill.status("/api/v1/wire", {"Bearer " + good}, address) == 101);
    }
    CHECK(mill.people.box().status().at("sessions").empty());  // nor is the machine's owner kept out
    bool again = false;
    for (int k = 0; k < 120 && !again; ++k) {
        std::this_thread::sleep_for(500ms);
        again = mill.get("/api/v1/status", {"Bearer wrong"}, 1).find("too many tokens") == std::string::npos;
    }
    CHECK(again);
}

TEST_CASE("a connection ends with its token, and not before") {
    const Mill mill;
    const auto begin = std::chrono::system_clock::now();
    CHECK(end_of(mill.people.place_with(mill.token("dora", 3s)), 30s) == 1008);
    CHECK(std::chrono::system_clock::now() - begin >= 2s);
    CHECK(end_of(mill.people.place_with(mill.token("dora")), 3s) == 0);
}

TEST_CASE("local tokens count from when they are written until they are taken away") {
    const Mill mill;
    const auto file = mill.people.tokens();
    const auto status = [&](const std::string& token) { return mill.status("/api/v1/status", {"Bearer " + token}); };
    const std::string first = simd::add_local_token(file, "abel").value();
    CHECK(status(first) == 200);
    const std::string second = simd::add_local_token(file, "abel").value();
    CHECK(status(first) == 401);
    CHECK(status(second) == 200);
    SECTION("taken away: an open connection ends as well") {
        CHECK(end_of(mill.people.place_with(second), 30s, [&] { REQUIRE(simd::remove_local_token(file, "abel")); }) == 1008);
        CHECK(status(second) == 401);
    }
    SECTION("a file that others may read, or that is none, lets nobody in, and is told") {
        std::filesystem::permissions(file, std::filesystem::perms(0644));
        std::filesystem::last_write_time(file, std::filesystem::last_write_time(file) + 1s);
        CHECK(status(second) == 401);
        std::filesystem::permissions(file, std::filesystem::perms(0600));
        std::ofstream(file, std::ios::app) << "garbage\n";
        CHECK(status(second) == 401);
        CHECK(status(mill.token("dora")) == 200);
        CHECK(mill.people.box().told().find("tokens") != std::string::npos);
    }
    SECTION("gone") {
        std::filesystem::remove(file);
        CHECK(status(second) == 401);
    }
}

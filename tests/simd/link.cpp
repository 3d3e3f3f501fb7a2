// What daemon and worker say to one another, where one end lies, is gone or does not read.

#include <catch2/catch.hpp>

#include <array>
#include <chrono>
#include <simd/link/link.hpp>
#include <string>
#include <sys/socket.h>
#include <sys/time.h>
#include <thread>
#include <utility>

using namespace weave;
using namespace weave::simd;
using namespace std::chrono_literals;

namespace {

struct Ends {
    Ends() : Ends(Link::pair().value()) {}
    explicit Ends(std::pair<Descriptor, Descriptor> both) : raw(both.second.number()), raw_one(both.first.number()), one(std::move(both.first)), other(std::move(both.second)) {}

    /// Bytes to `one` that no Link writes.
    void put(const std::string& bytes) const { REQUIRE(::send(raw, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size())); }

    int raw, raw_one;
    Link one, other;
};

std::string head(std::uint32_t size, char kind) {
    std::string bytes;
    for (int k = 0; k < 4; ++k) bytes += static_cast<char>(size >> (8 * k) & 0xffU);
    return bytes + kind;
}

}  // namespace

TEST_CASE("messages and frames come as they were sent, in order, empty ones too") {
    Ends ends;
    const std::string large(5 << 20, 'x');
    int sent = 0;  // Catch's assertions are for one thread
    std::thread sender([&] {
        sent += ends.one.send(Json{{"text", large}}) ? 1 : 0;
        sent += ends.one.send_frame(large) ? 1 : 0;
        sent += ends.one.send_frame("") ? 1 : 0;
        sent += ends.one.post(Json::object()) ? 1 : 0;
    });
    const auto next = [&] {
        auto received = ends.other.receive();
        REQUIRE(received);
        REQUIRE(*received);
        return std::move(**received);
    };
    const LinkMessage first = next(), second = next(), third = next(), fourth = next();
    sender.join();
    CHECK(sent == 4);
    CHECK_FALSE(first.is_frame);
    CHECK(Json::parse(first.bytes).at("text") == large);
    CHECK(second.is_frame);
    CHECK(second.bytes == large);
    CHECK(third.is_frame);
    CHECK(third.bytes.empty());
    CHECK(fourth.bytes == "{}");
}

TEST_CASE("lengths and kinds that lie are refused before anything is kept for them") {
    for (const std::string& bytes : {head(0xffffffff, 'c'), head(static_cast<std::uint32_t>(most_link_bytes) + 1, 'f'), head(2, 'x') + "{}", head(2, '\0') + "{}"}) {
        Ends ends;
        ends.put(bytes);
        CHECK_FALSE(ends.one.receive());
    }
    Ends ends;  // and one that is as long as may be, but does not come
    ends.put(head(1000, 'c') + "{}");
    ends.other.cut();
    const auto nothing = ends.one.receive();
    REQUIRE(nothing);
    CHECK_FALSE(*nothing);
}

TEST_CASE("an end that is gone is found out, wherever in a message that happens") {
    for (std::size_t whole = 0; whole < 7; ++whole) {
        Ends ends;
        ends.put((head(2, 'c') + "{}").substr(0, whole));
        ends.other.cut();
        const auto received = ends.one.receive();
        REQUIRE(received);
        CHECK_FALSE(*received);
        CHECK_FALSE(ends.one.send(Json::object()));
        CHECK_FALSE(ends.one.post(Json::object()));
    }
}

TEST_CASE("who does not read is given up by a post at once, and by a send within its time") {
    const std::string piece(1 << 20, 'x');
    Ends posting;
    const auto begin = std::chrono::steady_clock::now();
    while (posting.one.post(Json{{"text", piece}})) {}
    CHECK(std::chrono::steady_clock::now() - begin < link_patience);
    CHECK_FALSE(posting.one.post(Json::object()));  // half a message was sent: nothing may follow it
    while (true) {
        const auto received = posting.other.receive();  // what was whole arrives, then the end
        REQUIRE(received);
        if (!*received) break;
        CHECK(Json::parse((*received)->bytes).at("text") == piece);
    }

    Ends sending;
    timeval patience{};
    socklen_t size = sizeof patience;
    REQUIRE(::getsockopt(sending.raw_one, SOL_SOCKET, SO_SNDTIMEO, &patience, &size) == 0);
    CHECK(patience.tv_sec == link_patience.count());
    patience = {1, 0};  // which is enough here
    REQUIRE(::setsockopt(sending.raw_one, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience) == 0);
    while (sending.one.send_frame(piece)) {}  // else the test would never end
    CHECK_FALSE(sending.one.send_frame(""));
}

TEST_CASE("a link that is cut, or receives no more, keeps nobody waiting") {
    Ends cut, half;
    bool ended = false;
    std::thread waiting([&] {
        const auto received = cut.one.receive();
        ended = received && !*received;
    });
    std::this_thread::sleep_for(50ms);
    cut.one.cut();
    waiting.join();
    CHECK(ended);
    half.one.stop_receiving();
    const auto received = half.one.receive();
    CHECK((received && !*received));
    CHECK(half.one.send(Json{{"say", "done"}}));
    CHECK(half.other.receive());
}

TEST_CASE("several threads may send: no message is torn") {
    Ends ends;
    std::array<std::thread, 4> senders;
    std::array<int, 4> sent{};
    for (std::size_t k = 0; k < senders.size(); ++k) {
        senders[k] = std::thread([&ends, k, &sent = sent[k]] {
            for (int m = 0; m < 200; ++m) sent += ends.one.send(Json{{"from", k}, {"text", std::string(1000 * k + 10, 'x')}}) ? 1 : 0;
        });
    }
    for (int m = 0; m < 800; ++m) {
        const auto received = ends.other.receive();
        REQUIRE(received);
        REQUIRE(*received);
        const Json json = Json::parse((*received)->bytes);
        CHECK(json.at("text").get<std::string>().size() == 1000 * json.at("from").get<std::size_t>() + 10);
    }
    for (std::thread& sender : senders) sender.join();
    CHECK(sent == std::array<int, 4>{200, 200, 200, 200});
}

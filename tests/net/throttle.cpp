#include <weave/net/throttle.hpp>

#include <catch2/catch.hpp>

#include <support/random.hpp>

using namespace weave::net;
using namespace std::chrono_literals;

namespace {
constexpr Throttle::Clock::time_point start{1000s};
}

TEST_CASE("a key has its burst, then its pace, and says how long to wait") {
    Throttle throttle({3, 0.5, 10});
    for (int k = 0; k < 3; ++k) REQUIRE(throttle.take("anna", start));
    REQUIRE_FALSE(throttle.take("anna", start));
    REQUIRE(throttle.wait("anna", start) == 2s);
    REQUIRE(throttle.take("bert", start));
    REQUIRE_FALSE(throttle.take("anna", start + 1900ms));
    REQUIRE(throttle.take("anna", start + 2s));
    REQUIRE_FALSE(throttle.take("anna", start + 2s));
    REQUIRE(throttle.wait("bert", start) == 0s);
    throttle.forgive("anna");
    for (int k = 0; k < 3; ++k) REQUIRE(throttle.take("anna", start + 2s));
    for (int k = 0; k < 3; ++k)
        REQUIRE(throttle.take("anna", start + 1000s));  // no more than the burst is saved up
    REQUIRE_FALSE(throttle.take("anna", start + 1000s));
}

TEST_CASE("a flood of keys neither frees a throttled one nor fills the memory") {
    Throttle throttle({2, 0.1, 100});
    while (throttle.take("victim", start)) continue;
    int passed = 0;
    for (int k = 0; k < 10000; ++k) passed += throttle.take("flood" + std::to_string(k), start + 1ms) ? 1 : 0;
    REQUIRE(throttle.keys() == 100);
    REQUIRE_FALSE(throttle.take("victim", start + 2ms));
    REQUIRE(passed == 99 + 2);  // those that found room, and the bucket that the rest share
    REQUIRE(throttle.take("later", start + 60s));  // the quiet ones are forgotten
    REQUIRE(throttle.keys() < 100);
}

TEST_CASE("no key is let through more often than its rate allows") {
    weave::testing::for_all(
        [](weave::testing::Random& random) {
            const ThrottleRate rate{static_cast<double>(random.between(1, 5)), 2.0, random.between(1, 8)};
            Throttle throttle(rate);
            auto now = start;
            std::vector<int> passed(6);
            for (int k = 0; k < 200; ++k) {
                now += std::chrono::milliseconds(random.between(0, 200));
                const std::size_t key = random.between(0, 5);
                passed[key] += throttle.take(std::to_string(key), now) ? 1 : 0;
                REQUIRE(throttle.keys() <= rate.most_keys);
            }
            const double seconds = std::chrono::duration<double>(now - start).count();
            const double buckets =
                rate.most_keys >= passed.size() ? 1 : 2;  // its own, and the one that is shared
            for (const int count : passed)
                REQUIRE(count <= buckets * (rate.burst + seconds * rate.per_second) + 1e-6);
        },
        500);
}

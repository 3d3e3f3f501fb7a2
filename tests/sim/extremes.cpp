// The catalogue of extremes: every quick case ends as it must.

#include <weave/sim/extremes.hpp>

#include <catch2/catch.hpp>

#include <cstdio>
#include <set>

using namespace weave::sim;

namespace {

void check_extremes(bool is_long, const ExtremeLimits& limits) {
    for (const Extreme& extreme : extremes()) {
        if (extreme.is_long != is_long) continue;
        const ExtremeEnd end = extreme.run(limits);
        std::string why;
        const bool good = is_good(extreme, end, limits, why);
        INFO(extreme.name << ": " << end.report << " (" << why << ")");
        CHECK(good);
    }
}

}  // namespace

TEST_CASE("every extreme ends at rest, or with a report of what and where") {
    check_extremes(false, {.most_seconds = 1e30});  // steps, not time, so that a slow machine changes nothing
}

TEST_CASE("the long extremes end at rest, or with a report of what and where", "[.][long]") {
    check_extremes(true, {.most_iterations = 2000, .most_seconds = 600, .threads = 0});
}

TEST_CASE("extremes have names of their own, and a bad end is told from a good one") {
    std::set<std::string> names;
    for (const Extreme& extreme : extremes()) CHECK(names.insert(extreme.name).second);
    CHECK(names.size() >= 30);

    ExtremeEnd rest;
    rest.converged = true;
    rest.report = "at rest";
    std::string why;
    const auto good = [&](Expected expected, const ExtremeEnd& end) {
        return is_good({"", "", expected, false, {}}, end, {}, why);
    };
    CHECK(good(Expected::rest, rest));
    CHECK(good(Expected::told, rest));
    CHECK_FALSE(good(Expected::no_rest, rest));
    CHECK_FALSE(good(Expected::refused, rest));
    ExtremeEnd other = rest;
    other.finite = false;
    CHECK_FALSE(good(Expected::told, other));
    other = rest;
    other.passed_through = true;
    CHECK_FALSE(good(Expected::told, other));
    CHECK(why == "a yarn passed through another");
    other.report += ", yarns 1 and 2 passed through one another";
    CHECK_FALSE(good(Expected::told, other));
    CHECK_FALSE(good(Expected::rest, other));
    other = rest;
    other.converged = false;
    CHECK_FALSE(good(Expected::rest, other));
    CHECK_FALSE(good(Expected::told, other));
    CHECK(why == "it does not say where it is not at rest");
    other.where = "yarn 1, point 2";
    CHECK_FALSE(good(Expected::told, other));  // the report has to say it
    other.report = "stuck, greatest force at yarn 1, point 2";
    CHECK_FALSE(good(Expected::rest, other));
    CHECK(good(Expected::told, other));
    other.iterations = 10;
    other.seconds = ExtremeLimits().most_seconds + 1;
    CHECK(good(Expected::told, other));  // of 3 s a step
    other.iterations = 1000;
    CHECK_FALSE(good(Expected::told, other));
    CHECK(why == "it went on beyond its steps or its time");
    other.seconds = 1;
    other.iterations = 100'000;
    CHECK_FALSE(good(Expected::told, other));
    other.report.clear();
    CHECK_FALSE(good(Expected::told, other));
}

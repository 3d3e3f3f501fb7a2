// The status page: what a person sees of a machine without scripts, on a screen of any width.

#include <catch2/catch.hpp>

#include <simd/service/page.hpp>
#include <vector>

using namespace weave;

namespace {

Json busy_machine() {
    Json status{{"up_s", 3661}, {"threads", 16}, {"turns_waiting", 3}, {"clients", 12}, {"memory", {{"bytes", 1ULL << 34}, {"promised_bytes", 1ULL << 33}}}};
    status["sessions"].push_back({{"session", 12}, {"phase", "running"}, {"step", 1234}, {"steps_per_second", 56.7}, {"residual", 1.2e-4}, {"points", 4567}, {"memory_bytes", 1 << 20}, {"computed_s", 61}, {"clients", 2}});
    status["jobs"].push_back({{"job", 7}, {"phase", "waiting"}, {"step", 0}, {"steps_per_second", 0.0}, {"residual", nullptr}, {"points", 0}, {"memory_bytes", 0}, {"computed_s", 0}, {"left_s", nullptr}});
    return status;
}

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

}  // namespace

TEST_CASE("every cell of the status page says what it is, since a narrow screen shows no row of heads") {
    const std::string page = simd::status_page(busy_machine(), "7.1");
    const std::vector<std::string> of_both{"State", "Steps", "Steps a second", "Residual", "Points", "Memory", "Computed"}, of_one{"Session", "Watched by", "Job", "Still takes"};
    for (const auto& [heads, tables] : {std::pair(of_both, 2U), {of_one, 1U}}) {
        for (const std::string& head : heads) {
            INFO(head);
            CHECK(count_of(page, "<th>" + head + "</th>") == tables);
            CHECK(count_of(page, "<td data-head=\"" + head + "\">") == tables);
        }
    }
    CHECK(count_of(page, "<td") == 18);
    for (const char* shown : {"\"Session\">12<", "\"Steps a second\">57<", "\"Residual\">1.2e-04<", "\"Watched by\">2<", "\"Computed\">1 min 01 s<", "\"Still takes\">–<", "width:50.0%", "simd 7.1"})
        CHECK(count_of(page, shown) == 1);
}

TEST_CASE("what computes is told first, then what waits, then what rests") {
    Json status = busy_machine();
    const Json first = status["sessions"][0];
    for (const char* phase : {"at_rest", "paused", "waiting", "running"}) {
        status["sessions"].push_back(first);
        status["sessions"].back()["phase"] = phase;
        status["sessions"].back()["session"] = 13;
    }
    std::vector<std::string> phases;
    for (const Json& session : simd::busiest_first(status["sessions"])) phases.push_back(session.at("phase"));
    CHECK(phases == std::vector<std::string>{"running", "running", "waiting", "paused", "at_rest"});
    CHECK(simd::busiest_first(status["sessions"])[0].at("session") == 12);
    const std::string page = simd::status_page(status, "7.1");
    CHECK(page.find(">running<") < page.find(">waiting<"));
    CHECK(page.find(">paused<") < page.find(">at rest<"));
    CHECK(count_of(page, "Sessions (5)") == 1);
}

TEST_CASE("the status page lays rows out anew on a narrow screen, and an idle machine has no table") {
    Json idle = busy_machine();
    idle["sessions"] = idle["jobs"] = Json::array();
    const std::string page = simd::status_page(idle, "7.1");
    CHECK(count_of(page, "<table") == 0);
    CHECK(count_of(page, "No session is open.") == 1);
    CHECK(count_of(page, "No job waits or runs.") == 1);
    CHECK(count_of(page, "@media (max-width:60rem)") == 1);
    CHECK(count_of(page, "content:attr(data-head)") == 1);
    CHECK(count_of(page, "<script") == 0);
}

// Two programs that serve one store decide on the same thing at the same moment: one of them was first, and both say the same.

#include "flow_case.hpp"

#include <barrier>
#include <functional>
#include <thread>

namespace weave::loomlink::testing {

namespace {

using Try = std::function<Result<Json>()>;

/// Both at once, as nearly as two threads can.
std::pair<Result<Json>, Result<Json>> together(const Try& one, const Try& other) {
    std::barrier start(2);
    std::optional<Result<Json>> first, second;
    std::thread thread([&] {
        start.arrive_and_wait();
        first = one();
    });
    start.arrive_and_wait();
    second = other();
    thread.join();
    return {*std::move(first), *std::move(second)};
}

/// Which of two that cannot both be was done; a failed test where both or none were.
bool first_won(const std::pair<Result<Json>, Result<Json>>& outcome) {
    const auto& [one, other] = outcome;
    INFO((one ? "done" : one.error().text()) << " / " << (other ? "done" : other.error().text()));
    REQUIRE(static_cast<bool>(one) != static_cast<bool>(other));
    CHECK(denied(one ? other : one) == Denial::conflict);
    return static_cast<bool>(one);
}

struct TwoPrograms : FlowSite {
    std::unique_ptr<Workflow> second;
    TwoPrograms() {
        set_policy();
        set_up_loom();
        got(flow->designs().add(people.at("dora"), ask(), "shoe"));
        second = another(path);
    }
    std::int64_t submitted(std::optional<std::int64_t> before) {
        const std::int64_t number = save("dora", before, "twill " + std::to_string(before.value_or(0)));
        got(flow->steps().submit(people.at("dora"), ask("dora"), {"shoe", number, "ready"}, {}));
        return number;
    }
    std::int64_t count(const std::string& kind) {
        const auto all = kinds(0);
        return std::count(all.begin(), all.end(), kind);
    }
};

}  // namespace

TEST_CASE("of two decisions at once by two programs on one revision one counts") {
    TwoPrograms site;
    std::optional<std::int64_t> last;
    for (int round = 0; round < 8; ++round) {
        const std::int64_t number = site.submitted(last);
        last = number;
        const Ask approve = site.ask("abe"), refuse = site.ask("eve");
        const bool approved = first_won(together(
            [&] { return site.flow->steps().approve(site.people.at("abe"), approve, {"shoe", number, "good"}); },
            [&] { return site.second->steps().request_changes(site.people.at("eve"), refuse, {"shoe", number, "no"}); }));
        CHECK(site.state(number) == (approved ? "approved" : "changes_requested"));
    }
    CHECK(site.count("revision.approved") + site.count("revision.changes_requested") == 8);
}

TEST_CASE("what two programs release or withdraw at once is released or withdrawn once") {
    TwoPrograms site;
    std::optional<std::int64_t> last;
    for (std::int64_t round = 1; round <= 4; ++round) {
        const std::int64_t number = site.submitted(last);
        last = number;
        got(site.flow->steps().approve(site.people.at("abe"), site.ask("abe"), {"shoe", number, "good"}));
        const auto release = [&](Workflow& flow, const std::string& who) {
            return [&flow, &site, who, number, ask = site.ask(who)] {
                return flow.releases().release(site.people.at(who), ask, {"shoe", number, "EP 1", {1}, {}, "go"});
            };
        };
        first_won(together(release(*site.flow, "abe"), release(*site.second, "eve")));
        const auto withdraw = [&](Workflow& flow, const std::string& who) {
            return [&flow, &site, who, round, ask = site.ask(who)] {
                return flow.releases().withdraw(site.people.at(who), ask, "EP 1", round, "wrong yarn");
            };
        };
        first_won(together(withdraw(*site.flow, "abe"), withdraw(*site.second, "eve")));
        CHECK(site.count("release.made") == round);
        CHECK(site.count("release.withdrawn") == round);
    }
}

TEST_CASE("a request that comes to two programs at once is done once and answered the same") {
    TwoPrograms site;
    for (int round = 0; round < 8; ++round) {
        const Ask ask = site.ask();
        const std::string name = "cloth-" + std::to_string(round);
        const auto [one, other] = together([&] { return site.flow->designs().add(site.people.at("dora"), ask, name); },
                                           [&] { return site.second->designs().add(site.people.at("dora"), ask, name); });
        CHECK(got(one) == got(other));
    }
    CHECK(site.count("design.added") == 9);
}

TEST_CASE("what is decided on by one program is seen by the other at once") {
    TwoPrograms site;
    const std::int64_t number = site.submitted({});
    got(site.second->steps().approve(site.people.at("abe"), site.ask("abe"), {"shoe", number, "good"}));
    CHECK(site.state(number) == "approved");
    got(site.second->accounts().set_active(site.people.at("ada"), site.ask(), "abe", false));
    CHECK(denied(site.flow->steps().comment(site.people.at("abe"), site.ask(), {"shoe", number, "hm"}, 1, {})) == Denial::who);
}

}  // namespace weave::loomlink::testing

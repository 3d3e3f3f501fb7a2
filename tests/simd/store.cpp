#include "store_case.hpp"

#include <weave/sql/migrations.hpp>

#include <set>
#include <thread>

using namespace weave;
using namespace weave::simd;
using namespace weave::simd::testing;

namespace {

std::string plain(Number made) {
    return "{\"number\":" + std::to_string(made) + "}";
}

NewSession a_session(const std::string& person, const std::string& request) {
    return {person, request, "shoe", "{document}", "{simulation}"};
}

NewJob a_job(const std::string& person, const std::string& request) {
    return {person, request, "shoe", "{document}", "{simulation}"};
}

Number session_of(Store& store, const std::string& request = "request-1") {
    return store.add_session(a_session("dora", request), plain).value().number;
}

Number job_of(Store& store, const std::string& request = "request-1") {
    return store.add_job(a_job("dora", request), plain).value().number;
}

std::vector<Number> numbers(const std::vector<Event>& events) {
    std::vector<Number> all;
    for (const Event& event : events) all.push_back(event.seq);
    return all;
}

ErrorCode code_of(const Status& status) {
    REQUIRE_FALSE(status);
    return status.error().code;
}

}  // namespace

TEST_CASE("numbers begin at 1 and are never given twice, whatever is forgotten") {
    const Folder folder;
    for (Number k = 1; k <= 3; ++k) {
        const auto store = opened(folder / "s.db");
        const std::string request = "request-" + std::to_string(k);
        REQUIRE(session_of(*store, request) == k);
        REQUIRE(job_of(*store, "job-" + request) == k);
        REQUIRE(store->forget_session(k));
        REQUIRE(store->end_job(k, {JobPhase::cancelled, {}, "{}", {}, {}}));
        REQUIRE(store->forget_job(k));
        REQUIRE(store->sessions().value().empty());
        REQUIRE(store->jobs().value().empty());
        REQUIRE(code_of(store->task_of_session(k).error()) == ErrorCode::usage);
    }
}

TEST_CASE("a request that was answered before is not done again, after a new start neither") {
    const Folder folder;
    auto store = opened(folder / "s.db");
    const Made made = store->add_session(a_session("dora", "request-1"), plain).value();
    REQUIRE(made.answer == plain(1));
    REQUIRE(made.anew);
    const Made change = store->add_change(1, "request-2", "{}", plain).value();
    REQUIRE(store->remember("dora", "request-3", "refused"));
    store.reset();
    store = opened(folder / "s.db");

    const Made again = store->add_session(a_session("dora", "request-1"), plain).value();
    REQUIRE_FALSE(again.anew);
    REQUIRE(again.number == 1);
    REQUIRE(again.answer == made.answer);
    REQUIRE(store->add_job(a_job("dora", "request-1"), plain).value().answer == made.answer);
    REQUIRE(store->add_change(1, "request-2", "{}", plain).value().answer == change.answer);
    REQUIRE(store->changes(1).value().size() == 1);
    REQUIRE(store->remember("dora", "request-3", "accepted"));
    REQUIRE(store->answer_of("dora", "request-3").value() == "refused");
    REQUIRE(store->add_session(a_session("abel", "request-1"), plain).value().number == 2);
    REQUIRE_FALSE(store->answer_of("abel", "request-3").value());
}

TEST_CASE("of each person's answers the newest 1,000 are kept") {
    const Folder folder;
    const auto store = opened(folder / "s.db");
    REQUIRE(store->remember("abel", "request-0", "his"));
    for (int k = 0; k < 1003; ++k) REQUIRE(store->remember("dora", "request-" + std::to_string(k), "hers"));
    REQUIRE_FALSE(store->answer_of("dora", "request-2").value());
    REQUIRE(store->answer_of("dora", "request-3").value());
    REQUIRE(store->answer_of("dora", "request-1002").value());
    REQUIRE(store->answer_of("abel", "request-0").value());
}

TEST_CASE("nothing is made where the answer fails") {
    const Folder folder;
    const auto store = opened(folder / "s.db");
    const AnswerOf fails = [](Number) -> std::string { throw std::runtime_error("no words"); };
    REQUIRE(code_of(store->add_session(a_session("dora", "request-1"), fails).error()) == ErrorCode::system);
    REQUIRE(store->sessions().value().empty());
    REQUIRE(session_of(*store) == 1);
}

TEST_CASE("events follow one another, and a batch that does not is refused whole") {
    const Folder folder;
    const auto store = opened(folder / "s.db");
    const Number session = session_of(*store);
    const Event first{1, EventKind::layout, "layout 1"}, second{2, EventKind::phase, "running"};
    REQUIRE(store->add_events(session, {first, second}, {}));
    REQUIRE(code_of(store->add_events(session, {{3, EventKind::other, "a"}, {5, EventKind::other, "b"}},
                                      {})) == ErrorCode::usage);
    REQUIRE(store->events_after(session, 0, 10).value() == std::vector<Event>{first, second});
    REQUIRE(store->add_events(session, {second, {3, EventKind::ended, "c"}}, {}));  // told once more
    REQUIRE(code_of(store->add_events(session, {{2, EventKind::phase, "paused"}}, {})) == ErrorCode::usage);
    REQUIRE(code_of(store->add_events(session, {{4, EventKind::other, "d"}}, {})) == ErrorCode::usage);
    REQUIRE(code_of(store->add_events(9, {first}, {})) == ErrorCode::usage);
    REQUIRE(numbers(store->events_after(session, 1, 10).value()) == std::vector<Number>{2, 3});
    REQUIRE(numbers(store->events_after(session, 0, 2).value()) == std::vector<Number>{1, 2});
    REQUIRE(store->sessions().value().front().ended);
}

TEST_CASE("what is acknowledged goes, but for the newest layout, the newest phase and the end") {
    const Folder folder;
    const auto store = opened(folder / "s.db");
    const Number session = session_of(*store);
    REQUIRE(store->add_events(session,
                              {{1, EventKind::layout, "a"},
                               {2, EventKind::phase, "b"},
                               {3, EventKind::other, "c"},
                               {4, EventKind::layout, "d"},
                               {5, EventKind::phase, "e"},
                               {6, EventKind::other, "f"}},
                              {}));
    REQUIRE(store->acknowledge(session, 5));
    REQUIRE(store->sessions().value().front().acknowledged == 5);
    REQUIRE(numbers(store->events_after(session, 0, 10).value()) == std::vector<Number>{4, 5, 6});
    REQUIRE(store->acknowledge(session, 2));  // late; says nothing new
    REQUIRE(store->sessions().value().front().acknowledged == 5);
    REQUIRE(code_of(store->acknowledge(session, 7)) == ErrorCode::usage);
    REQUIRE(store->add_events(session, {{7, EventKind::layout, "g"}, {8, EventKind::ended, "h"}}, {}));
    REQUIRE(numbers(store->events_after(session, 0, 10).value()) == std::vector<Number>{5, 6, 7, 8});
    REQUIRE(store->acknowledge(session, 8));
    REQUIRE(numbers(store->events_after(session, 0, 10).value()) == std::vector<Number>{5, 7, 8});
    REQUIRE(store->sessions().value().front().acknowledged == 8);
}

TEST_CASE("changes are numbered within their session and keep the step at which they took effect") {
    const Folder folder;
    auto store = opened(folder / "s.db");
    const Number one = session_of(*store, "request-1"), two = session_of(*store, "request-2");
    REQUIRE(store->add_change(one, "change-1", "first", plain).value().number == 1);
    REQUIRE(store->add_change(one, "change-2", "second", plain).value().number == 2);
    REQUIRE(store->add_change(two, "change-3", "third", plain).value().number == 1);
    REQUIRE(store->add_events(one, {{1, EventKind::other, "applied"}}, {{1, 40}}));
    REQUIRE(store->add_events(one, {}, {{1, 40}}));
    REQUIRE(code_of(store->add_events(one, {{2, EventKind::other, "x"}}, {{1, 41}})) == ErrorCode::usage);
    REQUIRE(code_of(store->add_events(one, {}, {{3, 41}})) == ErrorCode::usage);
    store.reset();
    store = opened(folder / "s.db");
    REQUIRE(store->changes(one).value() ==
            std::vector<KeptChange>{{1, "change-1", "first", 40}, {2, "change-2", "second", {}}});
    REQUIRE(numbers(store->events_after(one, 0, 10).value()) == std::vector<Number>{1});
    REQUIRE(store->forget_session(one));
    REQUIRE(store->changes(one).value().empty());
    REQUIRE(store->changes(two).value().size() == 1);
}

TEST_CASE("a session's state comes back as it was") {
    const Folder folder;
    const SessionState state{"running", 1200, 1500, 300, 3, 1180};
    auto store = opened(folder / "s.db");
    const Number session = session_of(*store);
    REQUIRE(store->change_session(session, state));
    store.reset();
    store = opened(folder / "s.db");
    const KeptSession kept = store->sessions().value().front();
    REQUIRE(kept.state == state);
    REQUIRE(kept.person == "dora");
    REQUIRE(kept.title == "shoe");
    REQUIRE(store->task_of_session(session).value().document == "{document}");
    REQUIRE(code_of(store->change_session(9, state)) == ErrorCode::usage);
}

TEST_CASE("a job that ran when the daemon died waits again, and its attempts are counted") {
    const Folder folder;
    for (Number attempt = 1; attempt <= 3; ++attempt) {
        const auto store = opened(folder / "s.db");
        if (attempt == 1) REQUIRE(job_of(*store) == 1);
        const auto waiting = jobs_in(*store, JobPhase::waiting);
        REQUIRE(waiting.size() == 1);
        REQUIRE(waiting.front().attempts == attempt - 1);
        REQUIRE_FALSE(waiting.front().residual);
        REQUIRE(store->start_job(1));
        REQUIRE(store->start_job(1));
        store->job_progress(1, 840, 0.02);
        REQUIRE(jobs_in(*store, JobPhase::waiting).empty());
        const KeptJob running = store->jobs().value().front();
        REQUIRE(running.phase == JobPhase::running);
        REQUIRE(running.attempts == attempt);
        REQUIRE(running.step == 840);
        REQUIRE(running.residual == 0.02);
        REQUIRE(jobs_in(*store, JobPhase::running).size() == 1);
    }
}

TEST_CASE("a job ends once, with all that is told of it") {
    const Folder folder;
    auto store = opened(folder / "s.db");
    const Number job = job_of(*store);
    const JobEnd end{JobPhase::done, {}, "{report}", "{evidence}", "job-1.yarns"};
    REQUIRE(code_of(store->forget_job(job)) == ErrorCode::usage);
    REQUIRE(code_of(store->end_job(job, {JobPhase::waiting, {}, {}, {}, {}})) == ErrorCode::usage);
    REQUIRE(store->start_job(job));
    store->job_progress(job, 1200, 1e-9);
    REQUIRE(store->end_job(job, end));
    REQUIRE(store->end_job(job, end));
    REQUIRE(code_of(store->end_job(job, {JobPhase::cancelled, {}, "{}", {}, {}})) == ErrorCode::usage);
    REQUIRE(code_of(store->start_job(job)) == ErrorCode::usage);
    store->job_progress(job, 5, 1.0);
    REQUIRE(store->jobs().value().front().step == 1200);
    store.reset();
    store = opened(folder / "s.db");
    KeptJob kept = store->jobs().value().front();
    REQUIRE(kept.end == end);
    REQUIRE(kept.step == 1200);
    REQUIRE(kept.residual == 1e-9);
    REQUIRE(jobs_in(*store, JobPhase::waiting).empty());
    REQUIRE(store->forget_job(job));
    REQUIRE(store->forget_job(job));
    REQUIRE(code_of(store->task_of_job(job).error()) == ErrorCode::usage);
}

TEST_CASE("jobs wait in the order in which they came") {
    const Folder folder;
    auto store = opened(folder / "s.db");
    for (int k = 1; k <= 4; ++k) job_of(*store, "request-" + std::to_string(k));
    REQUIRE(store->start_job(2));
    REQUIRE(store->end_job(3, {JobPhase::failed, "{error}", "{}", {}, {}}));
    const auto waiting = [&] {
        std::vector<Number> all;
        const auto jobs = jobs_in(*store, JobPhase::waiting);
        for (const KeptJob& job : jobs) all.push_back(job.number);
        return all;
    };
    REQUIRE(waiting() == std::vector<Number>{1, 4});
    store.reset();
    store = opened(folder / "s.db");
    REQUIRE(waiting() == std::vector<Number>{1, 2, 4});
}

TEST_CASE("texts and numbers may be anything") {
    const Folder folder;
    const auto store = opened(folder / "s.db");
    const std::string odd = std::string("'; DROP TABLE job; --\0\xff\x01", 25);
    const std::string large(5'000'000, 'a');
    REQUIRE(store->add_job({odd, odd, odd, large, odd}, [&](Number) { return odd; }).value().answer ==
            odd);
    REQUIRE(store->jobs().value().front().title == odd);
    REQUIRE(store->task_of_job(1).value().document == large);
    REQUIRE(store->answer_of(odd, odd).value() == odd);
    const Number session = session_of(*store);
    const Number huge = UINT64_MAX;
    REQUIRE(code_of(store->change_session(session, {"running", huge, {}, 0, 0, 0})) == ErrorCode::refused);
    REQUIRE(code_of(store->change_session(huge, {})) == ErrorCode::usage);
    REQUIRE(code_of(store->add_events(session, {{huge, EventKind::other, "a"}}, {})) == ErrorCode::usage);
    REQUIRE(code_of(store->acknowledge(session, huge)) == ErrorCode::usage);
    REQUIRE(code_of(store->start_job(huge)) == ErrorCode::usage);
    store->job_progress(huge, huge, {});
    REQUIRE(store->sessions().value().front().state == SessionState());
}

TEST_CASE("a store that somebody has open, or that is none, is refused") {
    const Folder folder;
    {
        const auto store = opened(folder / "s.db");
        REQUIRE(store->start_job(job_of(*store)));
        const auto second = Store::open(folder / "s.db");
        REQUIRE_FALSE(second);
        REQUIRE(second.error().code == ErrorCode::system);
        REQUIRE_THAT(second.error().message, Catch::Contains("in use"));
        REQUIRE(store->jobs().value().front().phase == JobPhase::running);
    }
    {
        auto other = sql::Connection::open((folder / "other.db").string(), sql::Access::create).value();
        REQUIRE(other->script("CREATE TABLE thread (id INTEGER)"));
    }
    const auto foreign = Store::open(folder / "other.db");
    REQUIRE(code_of(foreign.error()) == ErrorCode::refused);
    REQUIRE(foreign.error().where == (folder / "other.db").string());
    REQUIRE(code_of(Store::open(folder / "none" / "s.db").error()) == ErrorCode::system);
}

TEST_CASE("many threads share a store") {
    const Folder folder;
    const auto store = opened(folder / "s.db");
    std::vector<std::thread> threads;
    std::array<std::string, 4> troubles;
    for (std::size_t k = 0; k < troubles.size(); ++k)
        threads.emplace_back([&, k] {
            const std::string own = "request-" + std::to_string(k);
            const auto both = store->add_session(a_session("dora", "request-of-all"), plain);
            const auto made = store->add_session(a_session("dora", own), plain);
            if (!both || !made) troubles[k] = "made nothing";
            for (Number seq = 1; troubles[k].empty() && seq <= 40; ++seq) {
                const Status added = store->add_events(made->number, {{seq, EventKind::other, own}}, {});
                const Status acknowledged = store->acknowledge(made->number, seq / 2);
                if (!added || !acknowledged) troubles[k] = (added ? acknowledged : added).error().text();
            }
        });
    for (std::thread& thread : threads) thread.join();
    for (const std::string& trouble : troubles) REQUIRE(trouble.empty());
    const auto sessions = store->sessions().value();
    REQUIRE(sessions.size() == 5);
    for (const KeptSession& session : sessions) {
        if (session.request == "request-of-all") continue;
        REQUIRE(session.last_seq == 40);
        const auto events = store->events_after(session.number, 0, 100).value();
        for (const Event& event : events) REQUIRE(event.text == session.request);
    }
}

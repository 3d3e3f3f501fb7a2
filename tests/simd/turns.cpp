// Who computes when, with a clock of the test's own.

#include <catch2/catch.hpp>

#include <map>
#include <simd/daemon/room.hpp>
#include <simd/daemon/turns.hpp>
#include <string>
#include <vector>

using namespace weave::simd;
using namespace std::chrono_literals;

namespace {

/// Workers that want to compute for ever, on a machine whose time passes step by step.
class Machine {
  public:
    explicit Machine(std::size_t threads) : threads_in_all(threads) {}

    Turns::Id add(const std::string& person, bool is_job = false, bool is_stuck = false) {
        const Turns::Id id = ++m_last;
        turns.add(id, person, is_job);
        stuck[id] = is_stuck;
        turns.want(id, now);
        return id;
    }
    void pass(std::chrono::milliseconds time) {
        for (const auto end = now + time; now < end; now += 5ms) {
            for (const auto& [id, threads] : computing) had[id] += 5.0 * static_cast<double>(threads);
            turns.tick(now);
            for (const Turns::Id id : std::exchange(asked, {})) {
                if (stuck[id]) continue;
                computing.erase(id);
                turns.again(id, now);
            }
            std::size_t in_use = 0;
            for (const auto& [id, threads] : computing) in_use += stuck[id] ? 0 : threads;
            CHECK(in_use <= threads_in_all);
        }
    }
    double share(Turns::Id id) const {
        double all = 0;
        for (const auto& [one, time] : had) all += time;
        return had.at(id) / all;
    }

    const std::size_t threads_in_all;
    std::map<Turns::Id, std::size_t> computing;
    std::map<Turns::Id, double> had;
    std::map<Turns::Id, bool> stuck;
    std::vector<Turns::Id> asked;
    Turns::Clock::time_point now{};
    Turns turns{{threads_in_all, 50ms, 1000ms},
                {[this](Turns::Id id, std::size_t threads) { computing[id] = threads; }, [this](Turns::Id id) { asked.push_back(id); }}};

  private:
    Turns::Id m_last = 0;
};

}  // namespace

TEST_CASE("people share the machine evenly, however many sessions each has") {
    for (const std::size_t threads : {1U, 2U, 8U}) {
        Machine machine(threads);
        std::vector<Turns::Id> many;
        for (int k = 0; k < 9; ++k) many.push_back(machine.add("dora"));
        const Turns::Id one = machine.add("abel");
        machine.pass(60s);
        double dora = 0;
        for (const Turns::Id id : many) dora += machine.share(id);
        CHECK(machine.share(one) <= 0.55);
        if (threads == 1) CHECK(machine.share(one) == Approx(0.5).margin(0.02));
        for (const Turns::Id id : many) CHECK(machine.share(id) == Approx(dora / 9).epsilon(0.15));
    }
}

TEST_CASE("of one person's own work sessions have four fifths, and a job is not forgotten") {
    Machine machine(1);
    const Turns::Id session = machine.add("dora"), job = machine.add("dora", true);
    machine.pass(60s);
    CHECK(machine.share(session) == Approx(0.8).margin(0.03));
    CHECK(machine.share(job) == Approx(0.2).margin(0.03));
}

TEST_CASE("who is alone has all threads, and gives some back when others come") {
    Machine machine(4);
    const Turns::Id first = machine.add("dora");
    CHECK(machine.computing.at(first) == 4);
    const Turns::Id second = machine.add("abel");
    machine.pass(1s);
    CHECK(machine.computing.at(first) == 2);
    CHECK(machine.computing.at(second) == 2);
}

TEST_CASE("nobody saves up for later by having been away") {
    Machine machine(1);
    const Turns::Id dora = machine.add("dora");
    machine.pass(30s);
    const Turns::Id abel = machine.add("abel");
    machine.had.clear();
    machine.pass(10s);
    CHECK(machine.share(dora) == Approx(0.5).margin(0.05));
    CHECK(machine.share(abel) == Approx(0.5).margin(0.05));
}

TEST_CASE("a worker that keeps its turn keeps others waiting for a second only") {
    Machine machine(1);
    const Turns::Id stuck = machine.add("dora", false, true), other = machine.add("abel");
    machine.pass(10s);
    CHECK(machine.had[other] > 8000);
    const auto kept = machine.turns.kept_since_asked(stuck, machine.now);
    REQUIRE(kept);
    CHECK(*kept > 9s);
    machine.turns.remove(stuck, machine.now);
    CHECK_FALSE(machine.turns.kept_since_asked(stuck, machine.now));
}

TEST_CASE("what is promised of the memory is never more than there is") {
    Room room(1000);
    CHECK(room.take(1, 600));
    CHECK_FALSE(room.take(2, 500));
    CHECK(room.take(2, 400));
    CHECK(room.left() == 0);
    CHECK(room.take(1, 500));  // in place of what it had
    CHECK(room.left() == 100);
    CHECK_FALSE(room.take(2, 501));
    room.give_back(1);
    CHECK(room.left() == 600);
    CHECK(memory_text(3ULL << 30) == "3.0 GiB");
    CHECK(memory_text(90ULL << 20) == "90 MiB");
}
